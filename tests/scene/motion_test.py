#!/usr/bin/env python3
"""motion_test.py BIN: scenes at a moment. Refitted trees against built ones and against the TPs', glTF's animations
against closed forms."""
import base64
import csv
import functools
import json
import math
import pathlib
import signal
import struct
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402

BIN = pathlib.Path(sys.argv[1]).resolve()
REFIT = pathlib.Path(__file__).resolve().parents[2] / "raytracer" / "examples" / "refit.py"
call = functools.partial(checking.call, BIN)


def refused(expected, *words):
    run = call(*words, status=1)
    check(expected in run.stderr, f"expected \"{expected}\"", run.stderr)


# --- a sheet that waves, a file a frame ---

SIDE = 24


def wave(frame, flat=()):
    """flat: these rows of the grid lie on the row before them, so that the triangles between have no area."""
    phase, rows = frame / 8, []
    for i in range(SIDE + 1):
        for j in range(SIDE + 1):
            x, z = 4 * max(k for k in range(i + 1) if k not in flat) / SIDE - 2, 4 * j / SIDE - 2
            y = 0.6 * math.sin(2 * x + phase) * math.cos(1.5 * z - phase)
            rows.append(f"v {x + 0.3 * math.sin(phase):.6f} {y:.6f} {z:.6f}")
    for i in range(SIDE):
        for j in range(SIDE):
            a = i * (SIDE + 1) + j + 1
            rows += [f"f {a} {a + 1} {a + SIDE + 2}", f"f {a} {a + SIDE + 2} {a + SIDE + 1}"]
    return "\n".join(rows) + "\n"


def write_waves():
    for frame in (0, 5, 20):
        pathlib.Path(f"wave-{frame:02d}.obj").write_text(wave(frame))
    pathlib.Path("wave-40.obj").write_text(wave(40, flat=range(1, SIDE, 2)))
    pathlib.Path("wave-41.obj").write_text(wave(41, flat=range(1, SIDE - 2)))  # little is left on one side of the root


def picture(scene, name):
    call("trax-render", scene, "--engine", "native", "--size", "48x27", "--quiet", "-o", name, "--eye", "3,3,4",
         "--look-at", "0,0,0")
    return pathlib.Path(name).read_bytes()


def test_refit():
    call("trax-scene", "wave-00.obj", "--splits=1", "-q", "-o", "base.trax")
    call("trax-scene", "wave-00.obj", "--refit", "base.trax", "-q", "-o", "same.trax")
    check(pathlib.Path("same.trax").read_bytes() == pathlib.Path("base.trax").read_bytes(), "refitted to itself")
    for frame in ("5", "20", "40", "41"):
        call("trax-scene", "wave-%02d.obj", "--at", frame, "-q", "-o", "built.trax")
        call("trax-scene", "wave-%02d.obj", "--at", frame, "--refit-from", "0", "-q", "-o", "refitted.trax")
        call("trax-scene", f"wave-{int(frame):02d}.obj", "--refit", "base.trax", "-q", "-o", "again.trax")
        check(pathlib.Path("refitted.trax").read_bytes() == pathlib.Path("again.trax").read_bytes(),
              "--refit-from and --refit", frame)
        call("trax-scene", "--check", "refitted.trax")  # every box is exact
        check(picture("built.trax", "built.png") == picture("refitted.trax", "refitted.png"), "picture", frame)
        check(pathlib.Path("built.trax").read_bytes() != pathlib.Path("refitted.trax").read_bytes(), "not built anew")


def test_lost_half():
    """A triangle stands for the nodes of its side of the root, which gives way."""
    far = "v 90 0 0\nv 91 0 0\nv 90 1 0\nv 91 1 1\nv 92 0 1\nf 1 2 3\nf 2 4 3\nf 2 5 4\n" \
          "v 94 0 0\nv 95 0 0\nv 94 1 0\nf 6 7 8\n"
    pathlib.Path("far.obj").write_text(far)
    pathlib.Path("lost-0.obj").write_text(wave(0))
    pathlib.Path("lost-1.obj").write_text("v 0 0 0\n" * (SIDE + 1)**2 + "f 1 2 3\n" * 2 * SIDE**2)
    call("trax-scene", "lost-%d.obj", "far.obj", "--at", "1", "--refit-from", "0", "--leaf=1", "-q", "-o", "lost.trax")
    call("trax-scene", "--check", "lost.trax")
    scene = pathlib.Path("lost.trax").read_bytes()
    root, nodes = struct.unpack_from("<I", scene, 16) + struct.unpack_from("<I", scene, 64)
    check(root == nodes, "the root is the first node", root, nodes)


def test_instances():
    """Meshes of a file of instances have their own moments; those that bend, and refitting, are refused."""
    pathlib.Path("placed.instances").write_text("mesh moves wave-%02d.obj\nmesh stands wave-00.obj\n"
                                                "place moves\nplace stands 1 0 0 9  0 1 0 0  0 0 1 0\n")
    call("trax-scene", "placed.instances", "--at", "20", "--flatten", "--splits=1", "-q", "-o", "flat.trax")
    pathlib.Path("stands.obj").write_text(pathlib.Path("wave-00.obj").read_text())
    pathlib.Path("both.instances").write_text("mesh moves wave-20.obj\nmesh stands stands.obj\n"
                                              "place moves\nplace stands 1 0 0 9  0 1 0 0  0 0 1 0\n")
    call("trax-scene", "both.instances", "--flatten", "--splits=1", "-q", "-o", "same.trax")
    check(pathlib.Path("flat.trax").read_bytes() == pathlib.Path("same.trax").read_bytes(), "instances at a moment")
    refused("instances move without it", "trax-scene", "placed.instances", "--at", "5", "--refit-from", "0", "-o",
            "x.trax")
    animated("bends.gltf")
    refused("mesh 1 bends", "trax-scene", "bends.gltf", "--at", "0.5", "--instances", "-o", "x.trax")


def test_on_the_tps():
    for chip in ("1x32", "4x32"):
        command = [sys.executable, REFIT, "--bin", BIN, "wave-%02d.obj", "--at", "20", "--config", chip]
        run = subprocess.run(command, capture_output=True, text=True)
        check(run.returncode == 0 and "those of trax-scene\n" in run.stdout, "on the TPs", run.stdout + run.stderr)


def test_refusals():
    call("trax-scene", "generate:forest", "--splits=2", "-q", "-o", "split.trax")
    for expected_text, *words in (
            ("cannot be refitted", "wave-00.obj", "wave-05.obj", "--refit", "base.trax"),
            ("is in several leaves", "generate:forest", "--refit", "split.trax"),
            ("keeps its layout", "wave-00.obj", "--refit", "base.trax", "--nodes=binary"),
            ("not a scene file", "wave-00.obj", "--refit", "wave-00.obj"),
            ("--refit keeps a tree", "wave-00.obj", "--refit", "base.trax", "--leaf=1"),
            ("no frame 2.5", "wave-%02d.obj", "--at", "2.5"),
            ("wave-06.obj: cannot be read", "wave-%02d.obj", "--at", "6"),
            ("wave-%02d.obj: there is no such file; --at 12 takes that of frame 12", "wave-%02d.obj"),
            ("nothing moves", "wave-00.obj", "--at", "6"),
            ("is neither a time", "wave-%02d.obj", "--at", "nan")):
        refused(expected_text, "trax-scene", *words, "-q", "-o", "x.trax")
    refused("is an input and the output", "trax-scene", "base.trax", "--refit", "base.trax", "-q", "-o", "base.trax")
    check(not pathlib.Path("x.trax").exists(), "nothing is written")


# --- glTF ---


class File:
    """A glTF file with its accessors in one buffer."""
    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def add(self, kind, values, letter="f"):
        data = struct.pack(f"<{len(values)}{letter}", *values)
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data
        count = len(values) // {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
        self.accessors.append({"bufferView": len(self.views) - 1, "count": count, "type": kind,
                               "componentType": {"f": 5126, "H": 5123, "B": 5121}[letter]})
        return len(self.accessors) - 1

    def write(self, path, **parts):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
        pathlib.Path(path).write_text(json.dumps({
            "asset": {"version": "2.0"}, "accessors": self.accessors, "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.bytes), "uri": uri}], **parts
        }))


CORNER = [1, 0, 0, 2, 0, 0, 1, 1, 0]  # a triangle
HALF = math.sqrt(0.5)


def animated(path, change=lambda parts, file: None):
    """Nodes: 0 turns by 90 degrees about z in a second and carries 1, which moves along a cubic; 2 is skinned to 3 and
    4, the second of which turns so, too; 5 has a morph target; 6 jumps."""
    file = File()
    times = file.add("SCALAR", [0, 1])
    turn = file.add("VEC4", [0, 0, 0, 1, 0, 0, HALF, HALF])
    other = file.add("VEC4", [0, 0, 0, 1, 0, 0, -HALF, -HALF])  # the same turn
    cubic = file.add("VEC3", [0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0])
    weights = file.add("SCALAR", [0, 1])
    jump = file.add("VEC3", [1, 1, 1, 3, 3, 3])
    corner = file.add("VEC3", CORNER)
    target = file.add("VEC3", [0, 0, 1, 0, 0, 2, 0, 0, 4])
    joints = file.add("VEC4", [0, 1, 0, 0] * 3, "B")
    shares = file.add("VEC4", [2, 0, 0, 0, 0.5, 0.5, 0, 0, 0, 3, 0, 0])
    inverse = file.add("MAT4", [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] * 2)
    plain = {"attributes": {"POSITION": corner}}
    parts = {
        "nodes": [{"children": [1]}, {"mesh": 0}, {"mesh": 1, "skin": 0}, {}, {}, {"mesh": 2}, {"mesh": 0}],
        "skins": [{"joints": [3, 4], "inverseBindMatrices": inverse}],
        "meshes": [{"primitives": [plain]},
                   {"primitives": [{"attributes": {"POSITION": corner, "JOINTS_0": joints, "WEIGHTS_0": shares}}]},
                   {"primitives": [{**plain, "targets": [{"POSITION": target}]}]}],
        "animations": [{
            "name": "all",
            "samplers": [{"input": times, "output": turn},
                         {"input": times, "output": cubic, "interpolation": "CUBICSPLINE"},
                         {"input": times, "output": weights}, {"input": times, "output": jump, "interpolation": "STEP"},
                         {"input": times, "output": other}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}},
                         {"sampler": 1, "target": {"node": 1, "path": "translation"}},
                         {"sampler": 4, "target": {"node": 4, "path": "rotation"}},
                         {"sampler": 2, "target": {"node": 5, "path": "weights"}},
                         {"sampler": 3, "target": {"node": 6, "path": "scale"}}]
        }, {"name": "none", "samplers": [], "channels": []}]
    }
    change(parts, file)
    file.write(path, **parts)


def expected(t):
    """The corners of the four triangles at the time t, by the definitions of the standard (glTF 2.0, 3.7.3, 3.11)."""
    t = min(max(t, 0), 1)
    angle = math.pi / 2 * t
    along = (t**3 - 2 * t**2 + t) * 1 + (3 * t**2 - 2 * t**3) * 4

    def turned(x, y):
        return [x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle), 0]

    corners = [CORNER[i:i + 3] for i in (0, 3, 6)]
    a, b, c = corners
    half = [(x + y) / 2 for x, y in zip(b, turned(b[0], b[1]))]
    size = 3 if t >= 1 else 1
    return [[turned(x + along, y) for x, y, _ in corners], [a, half, turned(c[0], c[1])],
            [[x, y, t * z] for (x, y, _), z in zip(corners, (1, 2, 4))],
            [[size * x for x in corner] for corner in corners]]


def triangles(*words):
    call("trax-scene", "moves.gltf", *words, "-q", "--write-triangles", "t.npy")
    data = pathlib.Path("t.npy").read_bytes()[128:]
    values = struct.unpack(f"<{len(data) // 4}f", data)
    return [[values[i + k:i + k + 3] for k in (0, 3, 6)] for i in range(0, len(values), 9)]


def test_animation():
    animated("moves.gltf")
    for at in (-1, 0, 0.125, 0.5, 0.875, 1, 7):
        found, wanted = triangles("--at", str(at)), expected(at)
        worst = max(abs(x - y) for one, other in zip(found, wanted) for p, q in zip(one, other) for x, y in zip(p, q))
        check(len(found) == 4 and worst < 1e-6, "animation at", at, worst)
    still = triangles("--at", "0.5", "--animation", "none")
    check([[list(corner) for corner in one] for one in still] == [[CORNER[i:i + 3] for i in (0, 3, 6)]] * 4, still)
    refused("no animation \"walk\"", "trax-scene", "moves.gltf", "--at", "1", "--animation", "walk", "-o", "x.trax")


def test_bad_animations():
    def change(path, value):
        def apply(parts, file):
            value_now = value(file) if callable(value) else value
            *way, last = path
            functools.reduce(lambda at, key: at[key], way, parts)[last] = value_now
        return apply

    sampler, channel = ("animations", 0, "samplers"), ("animations", 0, "channels")
    cases = [
        ("do not rise", change((*sampler, 0, "input"), lambda file: file.add("SCALAR", [1, 1]))),
        ("do not rise", change((*sampler, 0, "input"), lambda file: file.add("SCALAR", [0, math.nan]))),
        ("not as many values", change((*sampler, 0, "input"), lambda file: file.add("SCALAR", [0, 1, 2]))),
        ("not of the kind", change((*sampler, 0, "output"), lambda file: file.add("VEC3", [0] * 6))),
        ("not of the kind", change((*sampler, 0, "input"), lambda file: file.add("SCALAR", []))),
        ("its sampler is not there", change((*channel, 0, "sampler"), 5)),
        ("its sampler is not there", change((*channel, 0, "sampler"), -1)),
        ("its node is not there", change((*channel, 0, "target", "node"), 7)),
        ("sets none of", change((*channel, 0, "target", "path"), "colour")),
        ("an accessor that is not there", change((*sampler, 0, "output"), 99)),
        ("a joint that is not there", change(("skins", 0, "joints"), [3, 9])),
        ("no joints", change(("skins", 0, "joints"), [])),
        ("a joint that its skin has not", change(("skins", 0, "joints"), [3])),
        ("not a matrix for each joint", change(("skins", 0, "inverseBindMatrices"),
                                               lambda file: file.add("MAT4", [0] * 16))),
        ("joints without weights",
         lambda parts, file: parts["meshes"][1]["primitives"][0]["attributes"].pop("WEIGHTS_0")),
    ]
    for text, make in cases:
        animated("bad.gltf", make)
        refused(text, "trax-scene", "bad.gltf", "--at", "0.5", "-q", "-o", "x.trax")


# --- a sequence as a sweep ---


def test_sweep():
    pathlib.Path("waves.json").write_text(json.dumps({
        "name": "waves", "scenes": [{"name": "wave", "meshes": ["wave-%02d.obj"]}], "programs": "ours",
        "chips": ["1x32"], "size": "16x9", "reference": "built", "x": "trax-scene --at", "y": "cycles",
        "set": [{"name": "built", "trax-scene --at": [0, 20]},
                {"name": "refitted", "trax-scene --at": [0, 20], "trax-scene --refit-from": 0}],
        "table": {"rows": "trax-scene --at", "columns": "variant",
                  "values": ["cycles", "values.scene.bvh.sah_nodes", "values.picture.pixels_that_differ"]}}))
    call("trax-eval", "waves.json", "-o", "out", "--jobs", "1", "--quiet")
    runs = json.loads(pathlib.Path("out/results.json").read_text())["runs"]
    found = {(run["set"]["trax-scene --at"], run["variant"]): run for run in runs}
    check(all(run["status"] == "done" and run["values"]["picture.pixels_that_differ"] == 0 for run in runs), runs)
    built, refitted = found[20, "built"], found[20, "refitted"]
    check(built["values"]["scene.bvh.sah_nodes"] < refitted["values"]["scene.bvh.sah_nodes"], "built trees are better")


# --- trax-render --frames with two moments ---


def frames(folder):
    """{(frame, tree): row of frames.csv}"""
    with open(f"{folder}/frames.csv", newline="") as file:
        return {(int(row["frame"]), row["tree"]): row for row in csv.DictReader(file)}


def test_sequence():
    """An interrupted sequence goes on; each frame's files are those of the frame alone."""
    view = ["--eye", "3,3,4", "--look-at", "0,0,0", "--size", "48x27", "--config", "1x32"]
    command = [BIN / "trax-render", "wave-%02d.obj", "--at", "0:40", "--frames", "3", "-o", "walk", "-q", *view]
    stopped = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    runs = pathlib.Path("walk/runs")
    while stopped.poll() is None and not (first := [*runs.glob("*[0-9a-f].json")] if runs.exists() else []):
        time.sleep(0.01)
    stopped.send_signal(signal.SIGINT)
    said = stopped.communicate()[1]
    check(stopped.returncode == -signal.SIGINT, "interrupted", stopped.returncode, said)
    check("trax-render: interrupted; the same command goes on" in said, said)
    check(not pathlib.Path("walk/frames.csv").exists(), "an interrupted sequence has no curve yet")
    before = [(path, path.stat().st_mtime_ns) for path in first]
    again = subprocess.run(command, capture_output=True, text=True)
    check(again.returncode == 0, "goes on", again.stdout, again.stderr)
    check(all(path.stat().st_mtime_ns == when for path, when in before), "a finished run is not made again")
    rows = frames("walk")
    check(sorted(rows) == [(i, tree) for i in (1, 2, 3) for tree in ("new trees", "refitted")], sorted(rows))
    for number, moment in ((2, 20), (3, 40)):
        call("trax-render", "wave-%02d.obj", "--at", moment, "-q", "--view", "walk/frames.view", *view[4:], "-o",
             "alone.png", "--stats", "alone.json")
        call("trax-compare", "-q", f"walk/frame-{number:04d}.png", "alone.png")
        alone, made = (json.loads(pathlib.Path(name).read_text())
                       for name in ("alone.json", f"walk/frame-{number:04d}.json"))
        check(alone["cycles"] == made["cycles"] == int(rows[number, "new trees"]["cycles"]), "cycles")
        refitted = json.loads(pathlib.Path(f"walk/frame-{number:04d}-refitted.json").read_text())
        check(refitted["cycles"] == int(rows[number, "refitted"]["cycles"]), "cycles of a refitted tree")
        check(float(rows[number, "refitted"]["sah_nodes"]) > float(rows[number, "new trees"]["sah_nodes"]), "visits")
    more = [int(rows[number, "refitted"]["cycles"]) - int(rows[number, "new trees"]["cycles"]) for number in (2, 3)]
    pays = [float(rows[number, "refitted"]["rebuild_pays_below"]) for number in (2, 3)]
    check(pays == [more[0], 2 * more[1] - more[0]], "when a new tree pays", pays, more)
    page = pathlib.Path("walk/report.html").read_text()
    for title in ("Cycles of a frame", "Rays of a frame", "Bytes of a ray", "Visits that SAH expects",
                  "When to rebuild"):
        check(title in page, "the page has", title)
    check("the paper" not in page, "the page is about the sequence alone")


def test_sequence_of_a_file():
    """glTF moves between its keys; --no-refit, a file's camera and other options are passed on."""
    animated("walks.gltf")
    words = ["--at", "0:0x1p0", "--frames", "3", "-q", "--size", "16x9", "--material", "mirror", "--set",
             "chip.tms=01"]
    call("trax-render", "walks.gltf", *words, "--no-refit", "--samples", "2", "-o", "turns")
    rows = frames("turns")
    check({key: row["at"] for key, row in rows.items()} ==
          {(1, "new trees"): "0", (2, "new trees"): "0.5", (3, "new trees"): "1"}, rows)
    run = next(pathlib.Path("turns/jobs").glob("*.json")).read_text()
    check('"tms": 1' in run or "tms = 1" in run, "--set", run)
    refused("--frames with --at X:Y needs -o FOLDER", "trax-render", "walks.gltf", *words)
    refused("needs --frames N", "trax-render", "walks.gltf", "--at", "0:1", "-o", "x")
    refused("not with --stats", "trax-render", "walks.gltf", *words, "-o", "x", "--stats", "x.json")
    refused("too far apart", "trax-render", "walks.gltf", *words, "-o", "x", "--at=-1e308:1e308")
    refused('error: no file and no preset "9x9"', "trax-render", "walks.gltf", *words[:4], "-o", "x", "--config", "9x9")
    refused('error: dcache.bytes is "1e999", not', "trax-render", "walks.gltf", *words, "-o", "x", "--set",
            "dcache.bytes=1e999")
    refused("--help ends trax-render before", "trax-eval", "frames", "--help")
    for some in ((), ("-o", "x"), ("--frames", "2", "-o", "x", "--at", "0"), ("--frames", "2", "--at", "0:1")):
        refused("expected trax-render's words: ", "trax-eval", "frames", "walks.gltf", *some)
    check(not pathlib.Path("x").exists(), "a refused sequence leaves nothing")
    refused("walks.gltf: is no folder", "trax-render", "walks.gltf", *words, "-o", "walks.gltf")
    call("trax-render", "walks.gltf", "--at", "1:1", "--frames", "2", "-q", "--size", "8x6", "--no-refit", "-o",
         "still")
    one, other = (pathlib.Path(f"still/frame-000{number}.png").read_bytes() for number in (1, 2))
    check(one == other and len(frames("still")) == 2, "two frames of one moment")
    refused("--no-refit is for", "trax-render", "walks.gltf", "--at", "0", "--no-refit", "-o", "x.png")
    refused("'x' is neither", "trax-render", "walks.gltf", "--at", "0:x", "-o", "x")
    refused("wave-06.obj: cannot be read", "trax-render", "wave-%02d.obj", "--at", "5:6", "--frames", "2", "-q",
            "--size", "8x6", "--no-refit", "-o", "missing")
    check(list(frames("missing")) == [(1, "new trees")], "the frames that are there")


sys.exit(checking.run(write_waves, test_refit, test_lost_half, test_instances, test_on_the_tps, test_refusals,
                      test_animation, test_bad_animations, test_sweep, test_sequence, test_sequence_of_a_file))
