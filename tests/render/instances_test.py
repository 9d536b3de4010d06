#!/usr/bin/env python3
"""instances_test.py BIN: pictures of instances are those of the flattened meshes, in every bit where the transforms are
exact, and triangles have the same numbers; nested groups, glTF's nodes, materials, all kinds of shading against
Embree's instances; bad files of instances."""
import functools
import json
import os
import pathlib
import re
import struct
import sys
import time
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check, equal  # noqa: E402
from report.explore_page import unpack  # noqa: E402

BIN = pathlib.Path(sys.argv[1]).resolve()
call = functools.partial(checking.call, BIN)

# A solid without symmetry, and a floor.
SOLID = ("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.25 1\nf 4 3 2 1\nusemtl side\nf 1 2 5\nf 2 3 5\n"
         "usemtl other\nf 3 4 5\nf 4 1 5\n")
FLOOR = "v -4 -4 -2\nv 4 -4 -2\nv 4 4 -2\nv -4 4 -2\nf 1 2 3 4\n"
LOOK = ["--eye=1,-7,4", "--look-at=0,1,0", "--up=0,0,1", "--light=3,-3,9", "--size", "40x24", "-q"]
HEAD = "mesh solid solid.obj\nmesh floor floor.obj\nmaterial red 0.8,0.1,0.1\nplace floor\n"

# Rotations by right angles, times a power of two: nothing is rounded, and the same is computed.
EXACT = ["1 0 0 0  0 1 0 0  0 0 1 0", "0 -2 0 0  2 0 0 0  0 0 2 0 material red", "0 0 -1 0  0 -1 0 0  -1 0 0 0",
         "-0.5 0 0 0  0 0 0.5 0  0 0.5 0 0"]
MOVED = ["1 0 0 0.3  0 1 0 0.7  0 0 1 0", "0.6 -0.8 0 -2.1  0.8 0.6 0 0.4  0 0 1.7 0 material red",
         "-0.7 0 0 2  0 0.9 0.3 -1  0.2 0 1 0.1"]


def write(name, *lines):
    pathlib.Path(name).write_text("".join(lines))


def render(name, *words):
    call("trax-render", *words, *LOOK, "-o", f"{name}.png")
    return pathlib.Path(f"{name}.png").read_bytes()


def check_exact():
    """Pictures, shadows and layers are the same in every bit. The emulated chip draws the twin's picture."""
    write("exact.instances", HEAD, "material blue 0.1,0.1,0.8\n", *(f"place solid {rows}\n" for rows in EXACT),
          *(f"place solid material {name}\nplace solid\n" for name in ("blue", "red", "blue")))  # at one place
    for options in ([], ["--paths", "3", "--one-sided"]):
        kept = render("kept", "exact.instances", "--engine", "native", *options)
        flat = render("flat", "exact.instances", "--flatten", "--engine", "native", *options)
        check(kept == flat, "exact transforms", options)
    check(render("emulated", "exact.instances") == render("kept", "exact.instances", "--engine", "native"), "emulated")
    layers = []
    for flatten in ([], ["--flatten"]):
        call("trax-render", "exact.instances", *flatten, *LOOK, "--engine", "native", "--layers", "-o", "layers.exr")
        layers.append(pathlib.Path("layers.exr").read_bytes())
    check(layers[0] == layers[1], "layers")


def check_shading():
    """Against Embree's instances, twin against chip, hits against exact arithmetic."""
    write("moved.instances", HEAD, *(f"place solid {rows}\n" for rows in MOVED))
    for options in (["--smooth", "--samples", "2"], ["--paths", "3", "--samples", "2", "--material", "side=mirror"],
                    ["--occlusion", "2", "--one-sided"], ["--material", "other=glass"]):
        done = call("trax-render", "moved.instances", *LOOK, "-o", "x.png", "--compare", *options)
        check("identical in every bit" in done.stdout and " 0 beyond it" in done.stdout, options, done.stdout)
    render("kept", "moved.instances", "--engine", "native")
    render("flat", "moved.instances", "--flatten", "--engine", "native")
    call("trax-compare", "kept.png", "flat.png", "--within", "2", "--at-least", "99.5")


def looking(scale):
    """The view, scaled."""
    def place(x, y, z):
        return ",".join(repr(scale * a) for a in (x, y, z))
    return [f"--eye={place(1, -7, 4)}", f"--look-at={place(0, 1, 0)}", f"--light={place(3, -3, 9)}", "--up=0,0,1",
            "--size", "40x24", "-q", "--engine", "native"]


def check_view():
    """Instances are in the picture without a view, too, where they are placed: boxes as flattened boxes."""
    write("box.obj", *(f"v {i & 1} {i >> 1 & 1} {i >> 2}\n" for i in range(8)),
          "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n")
    write("away.instances", "mesh box box.obj\n", "place box 1 0 0 64  0 1 0 32  0 0 1 0\n",
          "place box 0 -2 0 70  2 0 0 30  0 0 2 -8\n")
    pictures = []
    for words in ([], ["--flatten"]):
        call("trax-render", "away.instances", *words, "--engine", "native", "--size", "40x24", "-q", "-o", "away.png")
        pictures.append(pathlib.Path("away.png").read_bytes())
    check(pictures[0] == pictures[1], "the view of all")


def scaled_mesh(text, scale):
    return "".join(" ".join([word, *(repr(scale * float(x)) if word == "v" else x for x in rest)]) + "\n"
                   for word, *rest in map(str.split, text.splitlines()))


def scaled_rows(rows, scale):
    numbers, *rest = rows.split(" material ")
    words = [float(word) for word in numbers.split()]
    words[3::4] = [scale * word for word in words[3::4]]
    return " material ".join([" ".join(map(repr, words)), *rest])


def check_scales():
    """A scene that is scaled by a power of two shows the same in every bit."""
    for scale in 1, 2.0**-60, 2.0**40:
        write("scaled-solid.obj", scaled_mesh(SOLID, scale))
        write("scaled-floor.obj", scaled_mesh(FLOOR, scale))
        write("scaled.instances", re.sub(r"(\w+)\.obj", r"scaled-\1.obj", HEAD),
              *(f"place solid {scaled_rows(rows, scale)}\n" for rows in MOVED))
        call("trax-render", "scaled.instances", *looking(scale), "-o", f"{scale}.png")
        check(pathlib.Path(f"{scale}.png").read_bytes() == pathlib.Path("1.png").read_bytes(), scale)


def check_shadows():
    """A convex solid does not shadow itself, however far away its own origin is."""
    points = [[float(x) for x in line.split()[1:]] for line in SOLID.splitlines() if line[0] == "v"]
    faces = "".join(line + "\n" for line in SOLID.splitlines() if line[0] == "f")
    for away in 0, 1e5, 1e6:
        write("away.obj", *("v %r %r %r\n" % tuple(64 * x + away for x in point) for point in points), faces)
        middle = 0.6 * away - 0.8 * away, 0.8 * away + 0.6 * away, away
        write("away.instances", "mesh away away.obj\nplace away 0.6 -0.8 0 %r  0.8 0.6 0 %r  0 0 1 %r\n"
              % tuple(-x for x in middle))
        pictures = [call("trax-render", "away.instances", *looking(32), "-o", f"{i}.png", *words) and
                    pathlib.Path(f"{i}.png").read_bytes() for i, words in enumerate(([], ["--no-shadows"]))]
        check(pictures[0] == pictures[1], "shadows of itself", away)


def check_groups():
    """A group in a group is its matrices' product; the outermost material counts."""
    write("nested.instances", HEAD, "material blue 0.1,0.1,0.8\n",
          "group inner\nplace solid 0 -1 0 1  1 0 0 0  0 0 1 0 material blue\nplace solid\nend\n",
          "group outer\nplace inner 1 0 0 0  0 0 -2 0  0 1 0 0.5 material red\nend\n",
          "place outer -1 0 0 0  0 1 0 0  0 0 1 0\n")
    write("product.instances", HEAD, "place solid 0 1 0 -1  0 0 -2 0  1 0 0 0.5 material red\n",
          "place solid -1 0 0 0  0 0 -2 0  0 1 0 0.5 material red\n")
    for name in "nested", "product":
        call("trax-scene", f"{name}.instances", "-q", "-o", f"{name}.trax")
    check(pathlib.Path("nested.trax").read_bytes() == pathlib.Path("product.trax").read_bytes(), "groups")


def check_story():
    """A pixel's story names the instance that each ray hit, by its number in the order of placing, and its material."""
    places = 4, -2, 2, 0  # the file has them in the order of the tree
    write("story.instances", "mesh solid solid.obj\nmaterial shine mirror\n",
          *(f"place solid 1 0 0 {place}  0 1 0 0  0 0 1 0{' material shine' * (place == 2)}\n" for place in places))
    for number, place in enumerate(places):
        done = call("trax-render", "story.instances", f"--eye={place + 0.5},-3,0.3", f"--look-at={place + 0.5},0,0.3",
                    "--up=0,0,1", "--light=3,-9,9", "--size", "8x8", "--config", "1x32", "--mark-rays",
                    "--pixel", "4,4", "--explore", "story.html", "-o", "story.png")
        primary = next(line for line in done.stdout.splitlines() if line.startswith("  primary"))
        equal(primary[38:46].split(), [str(number)], "the instance")
        check(("mirror" in primary) == (place == 2), "the instance's material", primary)
        ray = unpack(pathlib.Path("story.html"))[0]["rays"][4 * 8 + 4][0]
        equal(ray["instance"], number + 1, "the instance on the page")


def check_gltf():
    """Nodes that share a mesh are kept with --instances, and show the same picture."""
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2]]
    floats = b"".join(struct.pack("<3f", *point) for point in points)
    corners = bytes(sum([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], []))
    pathlib.Path("solid.bin").write_bytes(floats + corners)
    nodes = [{"mesh": 0, "rotation": [0, 0, 0.6, 0.8], "translation": [-1, 0, 0], "children": [1]},
             {"mesh": 0, "scale": [-1, 2, 1], "translation": [2, 0.5, 0]}, {"mesh": 0, "translation": [0, 2, -1]}]
    write("nodes.gltf", text := json.dumps({
        "asset": {"version": "2.0"}, "nodes": nodes, "scenes": [{"nodes": [0, 2]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"byteLength": 60, "uri": "solid.bin"}]}))
    statistics = {}
    for name, words in ("kept", ["--instances"]), ("flat", []):
        call("trax-scene", "nodes.gltf", *words, "-q", "-o", f"{name}.trax", "--stats-json", "s.json")
        statistics[name] = json.loads(pathlib.Path("s.json").read_text())
        call("trax-scene", "--check", f"{name}.trax")
        render(name, f"{name}.trax", "--engine", "native", "--one-sided")
    write("bad.gltf", text.replace('"scale": [-1, 2, 1]', '"scale": [1e-9, 2, 1]'))
    done = call("trax-scene", "bad.gltf", "--instances", "-o", "bad.trax", status=1)
    check("bad.gltf: node 1, which is instance 1 (from 0): the transform" in done.stderr, done.stderr)
    call("trax-scene", "bad.gltf", "--instances", "--flatten", "-q", "-o", "flattened.trax")
    far = '"translation": [0, 1729382256910270464, -1], "scale": [65536, 65536, 65536]'
    write("far.gltf", text.replace('"translation": [0, 2, -1]', far))
    done = call("trax-scene", "far.gltf", "--instances", "-o", "bad.trax", status=1)
    check("far.gltf: node 2, which is instance 2 (from 0): a coordinate of its box" in done.stderr, done.stderr)
    equal(statistics["kept"]["scene.instances"], 3, "instances")
    equal(statistics["kept"]["scene.triangles"], 4, "stored triangles")
    equal(statistics["flat"]["scene.triangles"], 12, "flattened triangles")
    call("trax-compare", "kept.png", "flat.png", "--within", "2", "--at-least", "99")


BAD = [
    ("place solid", "1:7: no mesh and no group has this name before here: 'solid'"),
    ("mesh a solid.obj\nplace a 1 2 3", "2:14: a transform has 12 numbers"),
    ("mesh a solid.obj\nplace a 1 0 0 0  0 1 0 0  0 0 0 0", "2:9: the transform is singular"),
    ("mesh a solid.obj\nplace a 1 0 0 0  0 1 0 0  0 0 1 nan", "2:33: not a finite number: 'nan'"),
    ("mesh a solid.obj\nplace a 1e6 0 0 0  0 1e6 0 0  0 0 1e6 0",
     "bad.instances:2: instance 0 (from 0): the transform scales"),
    ("mesh a solid.obj\nplace a 1e5 0 0 0  0 1 0 0  0 0 1 0", "instance 0 (from 0): the transform is nearly singular"),
    ("mesh a solid.obj\ngroup g\nplace a\nplace a 1e20 0 0 0  0 1e20 0 0  0 0 1e20 0\nend\ngroup h\nplace g\nend\n"
     "place g 1e-20 0 0 0  0 1e-20 0 0  0 0 1e-20 0\n", "bad.instances:3: instance 0 (from 0), in the group that is "
     "placed by line 9: the transform"),
    ("mesh a solid.obj\ngroup g\nplace a 1e200 0 0 0  0 1e200 0 0  0 0 1e200 0\nend\ngroup h\nplace g\nend\n"
     "place h 1e200 0 0 0  0 1e200 0 0  0 0 1e200 0\n", "bad.instances:3: instance 0 (from 0), in the group that is "
     "placed by line 6, 8: a number is not finite"),
    ("mesh a solid.obj\ngroup g\nplace a 131072 0 0 0  0 131072 0 0  0 0 131072 0\nend\n"
     "place g 1 0 0 0  0 1 0 1729382256910270464  0 0 1 0\n", "bad.instances:3: instance 0 (from 0), in the group that "
     "is placed by line 5: a coordinate of its box is too large"),
    ("mesh a solid.obj\nplace a material blue", "2:18: no material has this name"),
    ("mesh a solid.obj\nplace a material", "2:17: expected the material's name"),
    ("mesh a solid.obj\nmaterial red purple", "2:14: neither a kind of material nor R,G,B: 'purple'"),
    ("mesh a solid.obj\nmesh a floor.obj", "2:6: there is a mesh or a group of this name already: 'a'"),
    ("mesh a none.obj", "1:8: none.obj: "),
    ("mesh a /none/solid.obj", "1:8: /none/solid.obj: cannot be read"),
    ("mesh a bad.instances", "1:8: a mesh cannot be a file of instances"),
    ("mesh a solid.obj\ngroup g\nplace g\nend", "3:7: no mesh and no group has this name before here: 'g'"),
    ("mesh a solid.obj\ngroup g\nend", "3:1: a group without a place: 'g'"),
    ("mesh a solid.obj\ngroup g\nplace a", "3:1: the group 'g' has no end"),
    ("mesh a solid.obj\nend", "2:1: no group is open"),
    ("rotate", "1:1: expected mesh, material, group, place or end, not 'rotate'"),
    ("mesh a solid.obj", "nothing is placed"),
    ("mesh a solid.obj\nmaterial lamp emit:1,1,1\nplace a material lamp", "an instance emits light"),
]


def check_bad():
    for text, reason in BAD:
        write("bad.instances", text)
        done = call("trax-scene", "bad.instances", "-o", "bad.trax", status=1)
        check(reason in done.stderr and not os.path.exists("bad.trax"), text, reason, done.stderr)
    # 2^31 instances in 900 bytes are refused before there is memory for them.
    groups = ["mesh m solid.obj\ngroup g0\nplace m\nplace m\nend\n"]
    groups += [f"group g{i}\nplace g{i - 1}\nplace g{i - 1}\nend\n" for i in range(1, 31)]
    write("bomb.instances", *groups, "place g30\n")
    begun = time.monotonic()
    done = call("trax-scene", "bomb.instances", "-o", "bad.trax", status=1)
    check("too large: more instances than memory in proportion" in done.stderr, done.stderr)
    check(time.monotonic() - begun < 20, "a bomb takes long")
    call("trax-scene", "moved.instances", "-q", "-o", "moved.trax")
    for words in (["--tree", "x.npy", "--tree-triangles", "y.npy"], ["--splits=2"],
                  *(["--nodes", layout] for layout in ("quantised", "wide4", "wide4-quantised", "wide8"))):
        done = call("trax-scene", "moved.instances", "-o", "bad.trax", *words, status=1)
        check("--flatten" in done.stderr, words, done.stderr)
    done = call("trax-scene", "moved.instances", "--write-triangles", "x.npy", status=1)
    check("several places" in done.stderr and not os.path.exists("x.npy"), done.stderr)


def check_unplaced():
    """A mesh that is placed nowhere leaves nothing in the file, not even light."""
    write("lamp.mtl", "newmtl lamp\nKe 5 5 5\n")
    write("lamp.obj", "mtllib lamp.mtl\nusemtl lamp\n", FLOOR)
    for name, more in ("with", "mesh lamp lamp.obj\n"), ("without", ""):
        write(f"{name}.instances", "mesh solid solid.obj\n", more, "place solid\n")
        call("trax-scene", f"{name}.instances", "-q", "-o", f"{name}.trax")
    check(pathlib.Path("with.trax").read_bytes() == pathlib.Path("without.trax").read_bytes(), "an unplaced lamp")


def check_absolute():
    """A mesh whose name begins with / is that file, wherever the file of instances is."""
    os.makedirs("away", exist_ok=True)
    for name, mesh in ("beside", "solid.obj"), ("away/absolute", os.path.abspath("solid.obj")):
        write(f"{name}.instances", f"mesh solid {mesh}\nplace solid\n")
        call("trax-scene", f"{name}.instances", "-q", "-o", f"{name}.trax")
    same = pathlib.Path("beside.trax").read_bytes() == pathlib.Path("away/absolute.trax").read_bytes()
    check(same, "an absolute name")


def check_empty():
    """A file with an instance of a mesh that is not there, and no triangle."""
    sections = struct.pack("<4I", 256, 128, 1, 128) + struct.pack("<4I", 384, 64, 1, 64) + bytes(32)
    instance = struct.pack("<32I", *[0] * 27, 0xFFFFFF, 0, 0, 0, 0)
    data = struct.pack("<4I", 0x53585254, 3, 448, 0) + bytes(176) + sections + instance + bytes(64)
    pathlib.Path("empty.trax").write_bytes(data[:12] + struct.pack("<I", zlib.crc32(data)) + data[16:])
    for engine in "native", "embree":
        done = call("trax-render", "empty.trax", "--engine", engine, "-q", "-o", "x.png", status=1)
        check("empty.trax: instances without triangles" in done.stderr, done.stderr)


def write_meshes():
    write("solid.obj", SOLID)
    write("floor.obj", FLOOR)


sys.exit(checking.run(write_meshes, check_exact, check_shading, check_scales, check_view, check_shadows, check_groups,
                      check_story, check_gltf, check_bad, check_unplaced, check_absolute, check_empty))
