#!/usr/bin/env python3
"""trax-eval's folder of results: what an import read decides about its scene, what is damaged is made anew, what was
killed leaves nothing.

    tests/evaluation/folder_test.py --bin build/bin"""

import json
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import time

from scripts import Inside, check, main
from png_files import png_of

QUAD = ("mtllib quad.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl a\n"
        "f 1/1 2/2 3/3 4/4\n")
VIEW = ("eye = [0.0, 0.0, 3.0];\nlook_at = [0.0, 0.0, 0.0];\nup = [0.0, 1.0, 0.0];\nfov = 45.0;\n"
        "light = [1.0, 1.0, 4.0];\n")
SWEEP = {
    "name": "quad", "scenes": [{"name": "quad", "meshes": ["../quad.obj"], "view": "../quad.view"}],
    "programs": ["ours"], "chips": ["1x32"], "size": "8x8", "series": 500
}


def grey(path, value):
    """A picture of 4x4 pixels."""
    path.write_bytes(png_of(4 * [bytes([value] * 12)]))


class Folder:
    """A sweep of one quad with a texture, and its results."""
    def __init__(self, inside, scratch):
        self.inside, self.programs, self.path, self.out = inside, inside.folder, scratch, scratch / "out"
        for name in ("textures", "asked"):  # nothing changes beside the mesh
            (scratch / name).mkdir(parents=True)
        (scratch / "quad.obj").write_text(QUAD)
        (scratch / "quad.view").write_text(VIEW)
        (scratch / "quad.mtl").write_text("newmtl a\nKd 1 1 1\n")
        grey(scratch / "textures/t.png", 128)

    def command(self, sweep, *words):
        (self.path / "asked/sweep.json").write_text(json.dumps(sweep))
        return [str(self.programs / "trax-eval"), "asked/sweep.json", ".", "-o", str(self.out), "--jobs", "2", *words]

    def __call__(self, sweep=SWEEP, *words):
        run = self.inside(*self.command(sweep, "-q", *words)[1:], cwd=self.path)
        check(run.returncode == 0, f"exit status {run.returncode}: {run.stderr}")
        return run

    def runs(self):
        return json.loads((self.out / "results.json").read_text())["runs"]

    def imports(self):
        """Returns when the scene files were made."""
        return {path: (path.stat().st_mtime_ns, path.stat().st_ino) for path in (self.out / "scenes").glob("*.trax")}


def test_read(folder):
    """A scene is imported again if, and only if, a file that the import read or looked for has changed."""
    (folder.path / "quad.mtl").write_text("newmtl a\nKd 1 1 1\nmap_Kd textures/t.png\n")
    folder()
    key, before = folder.runs()[0]["key"], folder.imports()

    def change(what, anew, other):
        nonlocal key, before
        folder()
        now, imports = folder.runs()[0]["key"], folder.imports()
        check((imports != before) == anew, f"{what}: the scene was {'not ' if anew else ''}imported anew")
        check((now != key) == other, f"{what}: the run has {'the same' if other else 'another'} key")
        key, before = now, imports

    change("nothing", False, False)
    grey(folder.path / "textures/t.png", 8)
    change("a texture in a sub-folder", True, True)
    (folder.path / "unrelated.txt").write_text("x")
    os.utime(folder.path / "quad.obj")
    os.utime(folder.path / "textures/t.png")
    change("another file beside the mesh, and dates", False, False)
    (folder.path / "quad.mtl").write_text("newmtl a\nKd 0.5 0.5 0.5\nmap_Kd textures/n\xe9.png\n", encoding="latin-1")
    change("the material file", True, True)
    grey(folder.path / "textures/n\udce9.png", 200)
    change("a texture that was not there, with a name of no encoding", True, True)
    (folder.path / "quad.obj").write_text(QUAD.replace("1 1 0", "1 0.5 0"))
    change("the mesh", True, True)
    check("(new)" not in folder(SWEEP, "--dry-run").stdout, "--dry-run does not know the scene")
    grey(folder.path / "textures/n\udce9.png", 100)
    check("(new)" in folder(SWEEP, "--dry-run").stdout and folder.imports() == before, "--dry-run takes a stale scene")


def test_own_tree(folder):
    """Arrays of another builder's tree are files that an import reads, too."""
    own = SWEEP | {
        "programs": ["era"], "series": 0, "set": {
            "trax-scene --tree": "asked/nodes.npy", "trax-scene --tree-triangles": "asked/order.npy",
            "trax-scene --splits": False, "trax-scene --passes": False
        }
    }

    def array(name, shape, values):
        header = f"{{'descr': '<u4', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
        begin = b"\x93NUMPY\1\0" + struct.pack("<H", 118) + header.encode()
        (folder.path / "asked" / name).write_bytes(begin + struct.pack(f"<{len(values)}I", *values))

    array("nodes.npy", "(3, 3)", [1, 2, 0, 0, 0, 1, 1, 0, 1])
    array("order.npy", "(2,)", [0, 1])
    folder(own)
    before = folder.imports()
    array("order.npy", "(2,)", [1, 0])
    folder(own)
    check(folder.imports() != before, "another order of triangles")


def test_scene_file(folder):
    """A scene file in the folder of scenes takes no mesh's place: it may be of another mesh, or of other options."""
    both = SWEEP | {"programs": ["ours", "era"]}
    folder(both)
    cycles = {one["program"]: one["stats"]["cycles"] for one in folder.runs()}
    (folder.path / "other.obj").write_text(QUAD.replace("mtllib quad.mtl\n", "").replace("-1 -1 0", "-3 -3 0"))
    command = [folder.programs / "trax-scene", "-q", "other.obj", "--splits=4", "-o", "quad.trax"]
    subprocess.run(command, cwd=folder.path, check=True)
    shutil.rmtree(folder.out)
    folder(both)
    check({one["program"]: one["stats"]["cycles"] for one in folder.runs()} == cycles,
          "quad.trax in the folder of scenes was taken for quad.obj")


def test_damage(folder):
    """The same command makes any damaged file again, says so, and has the same results."""
    sweep = SWEEP | {"programs": ["ours", "era"]}
    folder(sweep)

    def files():
        """Hosts' times differ. Files of the same bytes may be one file."""
        return {
            path.relative_to(folder.out): path.read_bytes() for path in sorted(folder.out.rglob("*"))
            if path.is_file() and not path.name.endswith(".host.json") and path.parent != folder.out
        }

    good = files()
    kinds = {}
    for path in good:
        kinds.setdefault((path.parts[0], path.suffix or len(path.parts)), path)  # one of each kind
    kinds["host"] = next((folder.out / "runs").glob("*.host.json")).relative_to(folder.out)
    known = {"scenes", "inputs", "jobs", "runs", "pictures", "sweeps"}
    check({path.parts[0] for path in kinds.values()} == known, f"kinds of files: {kinds}")
    for number, path in enumerate(kinds.values()):
        data = (folder.out / path).read_bytes()
        figure = data.index(b'"cycles": ') + 10 if b'"cycles": ' in data else len(data) // 2
        changed = data[:figure] + bytes([data[figure] ^ 1]) + data[figure + 1:]
        damages = [("empty", b""), ("changed", changed), ("cut", data[:-1])]
        for name, damage in damages[:3 if path.parts[0] == "runs" and path.suffix == ".json" else 1 + number % 2]:
            (folder.out / path).write_bytes(damage)
            if path.parts[0] == "runs" and name == "changed":
                said = folder(sweep, "--dry-run").stdout
                check("1 of 2 runs are missing" in said, f"{path}, {name}: --dry-run says {said}")
            run = folder(sweep)
            noted = "note: " in run.stderr and "damaged" in run.stderr
            check(path.parts[0] == "sweeps" or noted, f"{path}, {name}: no note: {run.stderr}")
            now = files()
            differ = [str(name) for name in now.keys() | good.keys() if now.get(name) != good.get(name)]
            check(not differ, f"{path}, {name}: {differ} differ")
            check([one["status"] for one in folder.runs()] == ["done", "done"],
                  f"{path}, {name}: not all runs are done")
    # Runs of another sweep's command, which this one cannot make, are reported.
    folder(SWEEP | {"name": "other", "chips": ["1x48"]})
    others = [one for one in folder.runs() if one["experiments"] == ["other"]]
    victim = folder.out / others[0]["json"]
    victim.write_bytes(victim.read_bytes().replace(b'"cycles": ', b'"cycles": 1', 1))
    folder(sweep)
    others = [one["status"] for one in folder.runs() if one["experiments"] == ["other"]]
    check(others == ["failed"], "a changed run of another sweep")
    (folder.out / "sweeps/other.json").write_text('{"name": ')
    check("other.json" in folder(sweep).stderr and len(folder.runs()) == 2, "a damaged request of another sweep")


def test_shared_inputs(folder):
    """Machines that share inputs find them as they are."""
    runs = [folder(SWEEP | {"chips": [chip]}) for chip in ("2x32", "2x48", "2x32")]
    check(len(list((folder.out / "inputs").glob("*/manifest.json"))) == 1, "the machines have inputs of their own")
    check(not any("damaged" in run.stderr for run in runs), f"inputs of another machine: {runs[1].stderr}")


def test_killed(folder):
    """After SIGKILL no child runs on, and the next start removes what is left, in the folder for temporary files,
    too."""
    temporary = folder.path / "tmp"
    temporary.mkdir()
    large = SWEEP | {"name": "large", "scenes": [{"name": "large", "meshes": ["generate:forest"]}]}
    slow = SWEEP | {"programs": ["slow.json"], "series": 0}
    program = {"name": "slow", "like": "ours", "convert": ["sleep", "77"]}
    (folder.path / "asked/slow.json").write_text(json.dumps(program))
    environment = os.environ | {"TMPDIR": str(temporary)}
    for sweep, name, more in ((large, "trax-scene", []), (slow, "sleep", []), (slow, "sleep", ["--dry-run"])):
        if more:  # of a scene that has been imported
            folder()
        command = folder.command(sweep, "-q", *more)
        process = subprocess.Popen(command, cwd=folder.path, env=environment, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        deadline = time.monotonic() + 60
        while not (children := descendants(process.pid, name)) and time.monotonic() < deadline:
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.communicate()
        deadline = time.monotonic() + 10
        while any(map(lives, children)) and time.monotonic() < deadline:
            time.sleep(0.01)
        check(children and not any(map(lives, children)), f"{name} lives on after its command was killed")
        subprocess.run(folder.command(SWEEP, "-q", *more), cwd=folder.path, env=environment, capture_output=True)
        left = [*temporary.iterdir(), *(folder.out / "scratch").iterdir(), *(path for path in folder.out.rglob(".*"))]
        check(not left, f"{name} {more}: {left} are left")


def lives(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(") ", 1)[1][0] != "Z"
    except OSError:
        return False


def descendants(pid, name):
    """Processes of that name below it."""
    found = []
    try:
        for child in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split():
            mine = pathlib.Path(f"/proc/{child}/comm").read_text().strip() == name
            found += [int(child)] if mine else descendants(int(child), name)
    except OSError:
        pass
    return found


def test_standard_output(quad):
    """A reader that is gone is no message, and a full disk is one; also of a text that Python holds until its end."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    reader, closed = os.pipe()
    os.close(reader)
    with os.fdopen(closed, "w") as gone, open("/dev/full", "w", encoding="utf-8") as full:
        for words in (["--version"], ["--help"]):
            for out, said in ((gone, ""), (full, "trax-eval: error: No space left on device\n")):
                run = subprocess.run([quad.programs / "trax-eval", *words], stdout=out, stderr=subprocess.PIPE,
                                     text=True, env=environment)
                check((run.returncode, run.stderr) == (1, said), f"{words}: status {run.returncode}: {run.stderr}")


def tests(options, scratch):
    inside = Inside(options.bin)
    return {test.__name__: lambda test=test: test(Folder(inside, scratch / test.__name__))
            for test in (test_read, test_own_tree, test_scene_file, test_damage, test_shared_inputs, test_killed,
                         test_standard_output)}


if __name__ == "__main__":
    sys.exit(main(__doc__, tests))
