#!/usr/bin/env python3
"""trax-eval with bad sweeps, folders and options: a message and exit status 1 or 2, never a traceback, never a hang.

    tests/evaluation/mutants_test.py --bin build/bin [--seed N] [--count N]

Sweeps, programs, scenes and workloads are mutated in this process, which calls the command's own functions; folders and
options are those of the program."""

import copy
import json
import os
import pathlib
import random
import resource
import subprocess
import sys

from scripts import Inside, check, main

GOOD = {
    "name": "x", "title": "t", "claim": "c", "x": "icache.banks", "y": "mrps", "y_per": "area_mm2",
    "scenes": [{"name": "y", "meshes": ["generate:forest"],
                "view": "forest"}], "programs": ["ours"], "chips": ["1x32"], "set": {"icache.banks": [4, 16]},
    "size": "8x8", "mode": "exact", "series": 100, "workloads": ["occlusion"], "ray_kinds": True
}
VARIANTS = GOOD | {
    "set": [{"name": "a"}, {"name": "b", "program": "ours", "trax-scene --leaf": [1, 4]}, {
        "name": "c", "trax-render --no-shadows": True
    }], "reference": "a", "table": [{"rows": "variant", "columns": "chip", "values": ["mrps"]}],
    "error": False, "hits": False, "workloads": ["primary-shadow"], "scenes": ["forest"]
}
PROGRAM = {
    "name": "p", "title": "t", "program": "p.c", "flags": ["-O2"], "patch": ["p.patch"], "scene": ["--leaf", "2"],
    "render": ["--ambient", "0.1"], "set": {"icache.banks": 4}, "convert": ["true"], "counters": ["a",
                                                                                                  "b"], "rays": True
}
SCENE = {"name": "s", "title": "t", "meshes": ["generate:forest"], "view": "forest", "licence": "l", "paper": "fairy"}
WORKLOAD = {"name": "w", "title": "t", "render": ["--occlusion", "2"], "scene": ["--material", "mirror"]}
ODD = [
    None, True, False, 0, -1, 1.5, 1e300, 10**400, "", "x", "..", "/", "\n", "\0", "\ud800", "é" * 5000, [], [[]],
    [None], ["x"], {}, {"name": 0}, {"": [0]}, [{}], {"a": {"b": [1]}},
    list(range(300)), [[[[[[[]]]]]]]
]


def mutated(source, good):
    """The text of `good` but for one to three changes, in its values or in its bytes."""
    value = copy.deepcopy(good)
    for _ in range(source.randint(1, 3)):
        place, path = value, []
        while isinstance(place, (dict, list)) and place and (not path or source.random() < 0.5):
            key = source.choice(list(place)) if isinstance(place, dict) else source.randrange(len(place))
            path.append((place, key))
            place = place[key]
        if not path:
            continue
        holder, key = path[-1]
        action = source.random()
        if action < 0.2:
            del holder[key]
        elif action < 0.3 and isinstance(holder, dict):
            holder[str(source.choice(ODD))[:50]] = source.choice(ODD)
        else:
            holder[key] = copy.deepcopy(source.choice(ODD))
    data = bytearray(json.dumps(value, ensure_ascii=source.random() < 0.5).encode("utf-8", "surrogatepass"))
    for _ in range(source.choice((0, 0, 0, 1, 3))):
        data[source.randrange(len(data))] = source.randrange(256)
    return bytes(data[:source.randrange(len(data))] if source.random() < 0.05 else data)


def test_files(inside, scratch, seed, count):
    """Sweeps, and programs, scenes and workloads beside a sweep that is good."""
    source = random.Random(seed)
    for name in ("p.c", "p.patch", "x"):  # x: a name of ODD
        (scratch / name).write_text("")
    for kind, good in (("sweep", GOOD), ("variants", VARIANTS), ("programs", PROGRAM), ("scenes", SCENE),
                       ("workloads", WORKLOAD)):
        taken = 0
        for number in range(count):
            text, path = mutated(source, good), scratch / f"{kind}-{number}.json"
            path.write_bytes(text)
            if kind not in ("sweep", "variants"):
                path = scratch / "sweep.json"
                path.write_text(
                    json.dumps(GOOD | {"workloads": ["primary-shadow"], "set": {}, kind: [f"{kind}-{number}.json"]}))
            try:
                run = inside(path, scratch, "--dry-run", "-q", "-o", scratch / "none")
                taken += run.returncode == 0
                check(run.returncode in (0, 1) and (run.returncode == 0 or run.stderr.startswith("trax-eval: ")),
                      f"seed {seed}, {kind} {number}: {run.returncode}, {run.stderr!r}: {text[:300]}")
            except Exception as error:  # what would be a traceback
                check(False, f"seed {seed}, {kind} {number}: {error!r}: {text[:600]}")
        check(0 < taken < count, f"{taken} of {count} mutants of {kind} are taken all the same")
    check(not (scratch / "none").exists(), "--dry-run wrote something")


def test_commands(folder, inside, scratch):
    """Folders and files that cannot be used."""
    program = str(folder / "trax-eval")
    good, deep = scratch / "good.json", scratch / "deep.json"
    (scratch / "meshes").mkdir()
    (scratch / "meshes/triangle.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    small = [{"name": "y", "meshes": [str(scratch / "meshes/triangle.obj")], "view": "forest"}]
    cheap = {key: value for key, value in GOOD.items() if key not in ("workloads", "ray_kinds", "series", "set")}
    words = {"y": "configuration.memory.model", "y_per": "status", "x": "memory.model"}
    good.write_text(json.dumps(cheap | {"scenes": small} | words))
    deep.write_text('{"name":' + "[" * 200000)
    (scratch / "binary.json").write_bytes(bytes(range(256)) * 64)
    (scratch / "zero.json").symlink_to("/dev/zero")
    (scratch / "folder.json").mkdir()
    (scratch / "loop.json").symlink_to("loop.json")
    (scratch / "file").write_text("x")
    (scratch / "mesh.ply").write_text("ply\n")
    foreign = scratch / "foreign"
    (foreign / "sweeps").mkdir(parents=True)
    (foreign / "sweeps/a.json").write_text(json.dumps(GOOD))
    for place in ("jobs", "inputs", "runs", "scratch", "scenes", "sweeps"):
        (scratch / f"blocked-{place}").mkdir()
        (scratch / f"blocked-{place}" / place).write_text("x")
    empty = scratch / "empty"
    empty.mkdir()
    results = scratch / "results.json"
    results.write_text(
        json.dumps({
            "format": "trax-eval-results", "version": 2, "runs": [{"scene": "\ud800", "points": [{}]}], "sweeps": [],
            "series": []
        }))
    refused = [[good, "-o", ""], [good, "-o", scratch / "file"], [good, "-o", scratch / "file/below"],
               [good, "-o", "/dev/null/x"], [good, "-o", "/proc/x"], [good, "-o", "x" * 300], [good, "-o", foreign],
               *([good, "-o", scratch / f"blocked-{place}"]
                 for place in ("jobs", "inputs", "runs", "scratch", "scenes", "sweeps")),
               *([scratch / f"{name}.json"] for name in ("deep", "binary", "zero", "folder", "loop", "none")),
               [good, scratch / "nowhere"], [good, scratch / "file"], [good, scratch / ("x" * 300)],
               ["table1", empty, "--size", "8x8", "--scene", "conference"], [good, empty, empty], ["--all", good],
               [good, "--jobs", "x"],
               [good, "--jobs", "99999999999999999999"], [good, "--size", "8x" + 5000 * "8"], [good, "--program", ""],
               [good, "--mode", ""], ["job"], ["job", "x", "y"], ["job", empty, "y"], ["job", empty, "y", "z"],
               ["report"], ["report", "/dev/zero"], ["report", empty],
               ["report", scratch / "binary.json"], ["report", deep], ["report", results],
               ["report", good, "-o", "/dev/null/x"]]
    os.environ["TRAX_SCENES"] = str(scratch / "nowhere")
    for words in refused:
        more = [] if "-o" in words or words[0] in ("report", "job") else ["-o", scratch / "out"]
        try:
            run = inside(*words, *more, cwd=scratch)
            check(run.returncode in (1, 2) and run.stderr,
                  f"{[str(word)[:80] for word in words]}: {run.returncode}: {run.stderr[-600:]}")
        except Exception as error:  # what would be a traceback
            check(False, f"{[str(word)[:80] for word in words]}: {error!r}")
    # A disk may be full at any place: files may have only so many bytes.
    for limit in (0, 100, 2000, 8000):
        run = subprocess.run([program, good, empty, "-o", scratch / f"full-{limit}"], capture_output=True, text=True,
                             timeout=100, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        check(run.returncode == 1 and "Traceback" not in run.stderr,
              f"files of {limit} bytes: {run.returncode}: {run.stderr[-600:]}")
    run = subprocess.run([program, good, empty, "-o", scratch / "out"], capture_output=True, text=True, timeout=100)
    check(run.returncode == 0 and "Traceback" not in run.stderr,
          f"axes that are no numbers: {run.returncode}: {run.stderr[-600:]}")
    run = subprocess.run([program, "report", scratch / "out/results.json", "-o", scratch / "page.html"],
                         capture_output=True, text=True, timeout=100)
    check(run.returncode == 0 and "Traceback" not in run.stderr,
          f"the report of it: {run.returncode}: {run.stderr[-600:]}")


def test_dry_run(folder, scratch):
    """The command imports nothing, and needs no importer, compiler or renderer where nothing has been imported."""
    bare = scratch / "bare"
    (bare / "bin").mkdir(parents=True)
    (bare / "lib").symlink_to(folder.parent / "lib")
    for name in ("trax-eval", "trax-sim"):
        (bare / "bin" / name).write_bytes((folder / name).read_bytes())
        (bare / "bin" / name).chmod(0o755)
    (bare / "scenes").mkdir()
    for name in ("conference.ply", "crytek-sponza.ply", "dragon.ply", "dragon_box.obj", "sibenik.ply"):
        (bare / "scenes" / name).write_text("no mesh")
    run = subprocess.run([bare / "bin/trax-eval", "--all", bare / "scenes", "--dry-run", "-o", bare / "out"],
                         capture_output=True, text=True, timeout=100,
                         env=os.environ | {"PATH": "/nowhere:" + str(pathlib.Path(sys.executable).parent)})
    check(run.returncode == 0 and run.stdout.count("conference") > 100 and not run.stderr,
          f"--all --dry-run: {run.returncode}: {run.stderr[-600:]}")
    check(not (bare / "out").exists(), "--dry-run wrote something")


def tests(options, scratch):
    inside = Inside(options.bin)
    return {"commands": lambda: test_commands(options.bin, inside, scratch),
            "dry run": lambda: test_dry_run(options.bin, scratch),
            "files": lambda: test_files(inside, scratch, options.seed, options.count)}


if __name__ == "__main__":
    sys.exit(main(__doc__, tests, seed=1, count=60))
