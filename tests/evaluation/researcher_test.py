#!/usr/bin/env python3
"""Another researcher's folder (researcher/: a program in C, a scene, a chip, a workload and a sweep of them), outside
the tree: one command gives a report with all of them, and nothing in the tree changes.

    tests/evaluation/researcher_test.py --bin build/bin"""

import html
import itertools
import json
import pathlib
import shutil
import subprocess
import sys

from scripts import Inside, check, main

HERE = pathlib.Path(__file__).resolve().parent
TREE = HERE.parents[1]


def state(*folders):
    """Every file below the folders, and when it was written."""
    return {
        path: (path.stat().st_size, path.stat().st_mtime_ns) for folder in folders for path in folder.rglob("*")
        if path.is_file() and ".git" not in path.parts
    }


def command(program, folder, *words):
    return subprocess.run([program, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=200)


def test_report(program, data, scratch):
    mine = scratch / "mine"
    shutil.copytree(HERE / "researcher", mine)
    check(len((mine / "rings.c").read_text().splitlines()) <= 77, "the program has at most 77 lines")
    watched = [data, data.parent / "examples", data.parent / "raytracer", TREE / "raytracer", TREE / "tests/evaluation"]
    before = state(*watched)
    run = command(program, mine, "mine.json", "--report", "-o", scratch / "out")
    check(run.returncode == 0, f"exit status {run.returncode}: {run.stderr}")
    check(state(*watched) == before, "files of the tree changed")
    results = json.loads((scratch / "out/results.json").read_text())
    runs = results["runs"]
    seen = {(one["program"], one["config"], one["workload"], one["machine"]["memory.bandwidth_gbps"]) for one in runs}
    check(
        seen == {(name, chip, workload, rate) for name in ("rings", "ours") for chip in ("small.cfg", "1x32")
                 for workload in ("primary-shadow", "dusk") for rate in (4, 8)}, f"the runs are {seen}")
    check(all(one["status"] == "done" and one["scene"] == "steps" for one in runs),
          f"not all runs are done: {[one.get('error') for one in runs]}")
    for one in runs:
        threads = 8 if one["config"] == "small.cfg" else 32
        check(
            one["stats"]["threads"] == threads and
            one["stats"]["configuration"]["dcache"]["bytes"] == (4096 if threads == 8 else 16384),
            "the chip's settings")
        check(one["stats"]["rays_by_kind"]["primary"] == 24 * 16 and one["stats"]["rays_by_kind"]["shadow"] > 0,
              "rays by kind")
        counted = {key: value for key, value in one["values"].items() if key.startswith("counters.")}
        if one["program"] == "rings":
            check(
                counted.keys() == {"counters.boxes", "counters.triangles"} and
                counted["counters.boxes"] > 5 * 24 * 16 and counted["counters.triangles"] > 24, f"counters: {counted}")
        else:
            check(not counted, "our program counts nothing")
    check(
        len({(one["values"]["counters.boxes"], one["values"]["counters.triangles"]) for one in runs
             if one["program"] == "rings"}) == 1, "what the program counts depends on the machine or on the light")
    pictures = {(one["program"], one["workload"]): one["picture"] for one in runs}
    check(
        len(set(pictures.values())) == 4 and len({one["picture"] for one in runs}) == 4,
        "a picture for each program and workload")
    # Where nothing is, both programs show the workload's background; it is where the other sees no triangle.
    sys.path.insert(0, str(data))
    sys.dont_write_bytecode = True
    from trax_eval.pictures import read_png

    empty = {}
    for (name, workload), path in pictures.items():
        background = bytes.fromhex({"primary-shadow": "98a8b8ff", "dusk": "101020ff"}[workload])
        width, height, _, pixels = read_png((scratch / "out" / path).read_bytes())
        empty[name, workload] = {at for at in range(width * height) if pixels[4 * at:4 * at + 4] == background}
    check(
        len(empty["rings", "dusk"]) > 50 and len(set(map(frozenset, empty.values()))) == 1,
        f"background: {[len(pixels) for pixels in empty.values()]}")
    page = html.unescape((scratch / "out/report.html").read_text())
    for text in ("rings", "small.cfg", "dusk", "steps", "A program, a scene, a chip and a workload of one's own",
                 "memory.bandwidth_gbps"):
        check(text in page, f"the report does not have {text!r}")
    check("rings" in run.stdout and "small.cfg" in run.stdout, f"the table: {run.stdout}")
    # A call from another folder gives the same bytes, and makes nothing again.
    shutil.copytree(mine, scratch / "elsewhere")
    run = command(program, scratch / "elsewhere", "mine.json", "-q", "-o", scratch / "again")
    check(run.returncode == 0, f"from another folder: {run.stderr}")
    for folder in ("jobs", "runs", "pictures"):
        one, other = ({
            path.name: path.read_bytes() for path in (scratch / out / folder).iterdir()
            if not path.name.endswith(".host.json")
        } for out in ("out", "again"))
        check(one == other, f"{folder} depend on where the sweep is")
    run = command(program, mine, "mine.json", "--dry-run", "-o", scratch / "out")
    check(run.stdout.endswith("0 of 16 runs are missing\n"), f"a second call: {run.stdout}{run.stderr}")
    # A command of results.json makes the run alone.
    one = next(one for one in runs if one["program"] == "rings")
    repeated = subprocess.run(one["command"].replace("trax-sim", program.replace("trax-eval", "trax-sim"), 1),
                              shell=True, cwd=scratch / "out", capture_output=True, text=True)
    check(
        repeated.returncode == 0 and json.loads(
            (scratch / "out/stats.json").read_text())["cycles"] == one["stats"]["cycles"],
        f"{one['command']}: {repeated.stderr}")
    # One's own program in the place of a sweep's that comes with trax.
    run = command(program, mine, "table2", "--program", "rings.json", "--scene", "forest", "--chip", "1x32", "--size",
                  "8x8", "--dry-run", "-o", scratch / "out")
    check("forest 1x32 rings 8x8" in run.stdout, f"--program NAME.json: {run.stdout}{run.stderr}")


def change(mine, name, members, bad):
    value = json.loads((mine / name).read_text()) | members
    (mine / bad).write_text(json.dumps({key: member for key, member in value.items() if member is not None}))


# (file, members that are changed, what the message says)
REFUSED = [
    ("rings.json", {"flag": ["-O2"]}, 'unknown key "flag", did you mean "flags"'),
    ("rings.json", {"name": "a b"}, "name: expected letters"),
    ("rings.json", {"program": "none.c"}, "program: none.c is neither in"),
    ("rings.json", {"program": "rings.py"}, 'program: expected "specialised", "FILE.elf" or "FILE.c"'),
    ("rings.json", {"program": None}, "program: expected"),
    ("rings.json", {"flags": "-O2"}, "flags: expected a list of texts"),
    ("rings.json", {"flags": ["-no-such-flag"]}, "program: "),
    ("rings.json", {"program": "steps.obj.c"}, "program: steps.obj.c is neither"),
    ("rings.json", {"patch": "none.patch"}, "patch: none.patch is neither in"),
    ("rings.json", {"patch": "steps.obj"}, "patch: steps.obj does not fit"),
    ("rings.json", {"source": "."}, 'source: is for "program": "specialised"'),
    ("rings.json", {"set": {"dcache.way": 4}}, 'unknown key "dcache.way"'),
    ("rings.json", {"set": [1]}, "set: expected an object"),
    ("rings.json", {"scene": ["--leafs", "1"]}, "scene: unknown option --leafs"),
    ("rings.json", {"scene": ["--leaf=9"]}, "scene: --leaf: '9' is not a whole number from 1 to 7"),
    ("rings.json", {"render": ["--samples", "0"]}, "render: --samples: '0' is not a whole number from 1 to 4096"),
    ("rings.json", {"counters": ["a", "a"]}, "counters: expected at most"),
    ("rings.json", {"counters": ["a b"]}, "counters: expected at most"),
    ("rings.json", {"rays": "yes"}, "rays: expected true or false"),
    ("rings.json", {"like": "none"}, 'like: "none" is no other program'),
    ("rings.json", {"like": "bad-21.json"}, 'like: "bad-21.json" is no other program'),
    ("rings.json", {"convert": ["./none"]}, "convert: ./none: No such file"),
    ("rings.json", {"convert": ["python3", "-c", "raise SystemExit('not today')"]}, "convert: not today"),
    ("rings.json", {"convert": ["rm", "manifest.json"]}, "convert: the manifest or a file of it cannot be read"),
    ("rings.json", {"rays": False}, 'workloads, ray_kinds and ray_cycles need programs with "rays": true'),
    ("steps.json", {"mesh": "a"}, 'unknown key "mesh", did you mean "meshes"'),
    ("steps.json", {"meshes": []}, "meshes: expected a list of files"),
    ("steps.json", {"meshes": ["none.obj"]}, "neither none.obj nor none.obj.xz"),
    ("steps.json", {"view": 1}, "view: expected a file"),
    ("steps.json", {"scenes": ["bad.json"]}, 'unknown key "meshes". Allowed are "name", "title", "scenes"'),
    ("dusk.json", {"render": "--ambient"}, "render: expected a list of texts"),
    ("dusk.json", {"render": ["--ambient", "2"]}, "render: --ambient: '2'"),
    ("dusk.json", {"name": ""}, "name: expected letters"),
]


def test_refusals(inside, scratch):
    """A message about a file beside a sweep has its name and key, and what is allowed."""
    mine = scratch / "refused"
    shutil.copytree(HERE / "researcher", mine)
    for number, (name, members, message) in enumerate(REFUSED, 1):
        bad = f"bad-{number}.json"
        change(mine, name, members, bad)
        sweep = json.loads((mine / "mine.json").read_text()) | {"name": "x", "chips": "small.cfg", "set": {}}
        sweep = json.loads(json.dumps(sweep).replace(f'"{name}"', f'"{bad}"'))
        (mine / "sweep.json").write_text(json.dumps(sweep))
        run = inside("sweep.json", "-q", "-o", scratch / "refused-out", cwd=mine)
        check(run.returncode == 1 and message in run.stderr,
              f"{name} {members}: exit status {run.returncode}: {run.stderr.strip()!r} has not {message!r}")
        check(bad in run.stderr or "none.obj" in message or "rays" in message,
              f"{name} {members}: the message names no file: {run.stderr.strip()!r}")


def test_example(program, data, scratch):
    """The example sweep runs unchanged but for its scene. new-sweep, which once asked for one, names it."""
    mine = scratch / "copied"
    shutil.copytree(HERE / "researcher", mine)
    (mine / "leaves.json").write_text((data / "example.json").read_text().replace('"forest"', '"steps.json"'))
    run = command(program, mine, "leaves.json", "-q", "--size", "24x16", "-o", scratch / "copied-out")
    check(run.returncode == 0, f"the example: {run.stderr}")
    results = json.loads((scratch / "copied-out/results.json").read_text())
    seen = sorted((one["variant"], one["config"]) for one in results["runs"])
    names = ["as it is", "bandwidth", "bandwidth", "small leaves", "wide nodes"]
    check(seen == sorted(itertools.product(names, ("4x32", "8x64"))), f"runs of the example: {seen}")
    run = command(program, mine, "new-sweep", "mine.json")
    check(run.returncode == 1 and str(data / "example.json") in run.stderr,
          f"new-sweep: {run.returncode}: {run.stderr}")


def tests(options, scratch):
    program, data = str(options.bin / "trax-eval"), options.bin.parent / "lib/trax/evaluation"
    return {"report": lambda: test_report(program, data, scratch),
            "example": lambda: test_example(program, data, scratch),
            "refusals": lambda: test_refusals(Inside(options.bin), scratch)}


if __name__ == "__main__":
    sys.exit(main(__doc__, tests))
