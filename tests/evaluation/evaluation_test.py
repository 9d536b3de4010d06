#!/usr/bin/env python3
"""trax-eval: sweeps are expanded and refused as documented, a killed command loses nothing, single jobs give the same
bytes.

    tests/evaluation/evaluation_test.py --bin build/bin [--only NAME] [--kills N]"""

import argparse
import fnmatch
import importlib
import json
import math
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import unittest.mock

from scripts import Inside, check, main

BUNNY = "/usr/share/glmark2/models/bunny.obj"
BOX = str(pathlib.Path(__file__).resolve().parents[1] / "render/box.obj")
SMALL = {
    "name": "small", "scenes": [{"name": "ball", "meshes": [], "view": "bunny"}], "programs": "ours",
    "chips": ["1x32", "2x48"], "set": {"memory.bandwidth_gbps": [4, 8]}, "size": "40x24", "series": 2000
}
RUNS = 4
ROWS = 60


def write_ball(path):
    """A ball with bumps where the view looks that comes with the bunny; its import takes a fifth of the bunny's."""
    lines = []
    for row in range(ROWS + 1):
        for column in range(ROWS):
            up, around = math.pi * row / ROWS, 2 * math.pi * column / ROWS
            radius = 0.7 + 0.1 * math.sin(7 * up) * math.sin(5 * around)
            x, z = math.sin(up) * math.cos(around), math.sin(up) * math.sin(around)
            lines.append(f"v {radius * x:.6f} {radius * math.cos(up):.6f} {radius * z:.6f}")
    for row in range(ROWS):
        for column in range(ROWS):
            a, b = row * ROWS + column + 1, row * ROWS + (column + 1) % ROWS + 1
            lines.append(f"f {a} {b} {b + ROWS} {a + ROWS}")
    path.write_text("\n".join(lines) + "\n")


class Evaluation:
    def __init__(self, folder, scratch):
        self.program, self.scratch, self.inside = str(folder / "trax-eval"), scratch, Inside(folder)

    def file(self, sweep):
        path = self.scratch / "sweep.json"
        path.write_text(sweep if isinstance(sweep, str) else json.dumps(sweep))
        return str(path)

    def command(self, sweep, out, *options):
        return [self.program, self.file(sweep), str(self.scratch), "-o", str(self.scratch / out), *options]

    def run(self, sweep, out, *options):
        """The finished command, in this process. A new folder begins with the scene that test_sweep has imported."""
        imported, scenes = self.scratch / "undisturbed/scenes", self.scratch / out / "scenes"
        if imported.exists() and not scenes.exists() and "--dry-run" not in options:
            shutil.copytree(imported, scenes)
        return self.inside(*self.command(sweep, out, *options)[1:])

    def results(self, out):
        """The results, whose figures are all known to sweeps."""
        from trax_eval.names import own_figures
        found, known = json.loads((self.scratch / out / "results.json").read_text()), own_figures()
        names = {f"values.{name}" for run in found["runs"] for name in run.get("values") or ()}
        unknown = [name for name in names if not any(fnmatch.fnmatchcase(name, pattern) for pattern in known)]
        check(not unknown, f"{out}: a sweep cannot name", *unknown)
        return found


def same_bytes(scratch, one, other):
    """Everything that does not say what it took on the host."""
    def files(out):
        root = scratch / out
        return {
            str(path.relative_to(root)): path.read_bytes() for folder in ("jobs", "runs", "pictures", "sweeps")
            for path in (root / folder).rglob("*") if not path.name.endswith(".host.json")
        }

    left, right = files(one), files(other)
    check(left.keys() == right.keys(), f"{one} and {other} have other files: {sorted(left.keys() ^ right.keys())[:5]}")
    for name in left.keys() & right.keys():
        check(left[name] == right[name], f"{name} differs between {one} and {other}")
    check(not list((scratch / other / "scratch").glob("*")), f"{other}: unfinished files are left")


# --- expansion and results


def test_sweep(evaluation, scratch):
    run = evaluation.run(SMALL, "undisturbed", "--jobs", "2")
    check(run.returncode == 0, f"exit status {run.returncode}: {run.stderr}")
    shown = set(re.findall(r"^\|[^|]*\| +([\d.]+) +\|", run.stdout, re.MULTILINE))
    check(shown == {"4", "8"}, f"the values of memory.bandwidth_gbps in the table: {shown}: {run.stdout}")
    results = evaluation.results("undisturbed")
    runs = results["runs"]
    expected = {(chip, bandwidth) for chip in ("1x32", "2x48") for bandwidth in (4, 8)}
    check({(one["config"], one["set"].get("memory.bandwidth_gbps", 8)) for one in runs} == expected, "the combinations")
    check(not any(one["set"].get("memory.bandwidth_gbps") == 8 for one in runs),
          "what the chip has anyway is no change")
    check(len(runs) == RUNS and all(one["status"] == "done" for one in runs), "not all runs are done")
    for one in runs:
        configuration = one["stats"]["configuration"]
        check(configuration["memory"]["bandwidth_gbps"] == one["machine"]["memory.bandwidth_gbps"],
              "a run has not its configuration")
        check(one["stats"]["items"] == 40 * 24, "pixels")
        check(not {"tms", "channels", "instructions_by_operation", "identity"} & one["stats"].keys(),
              "what is left out")
        full = json.loads((scratch / "undisturbed" / one["json"]).read_text())
        check(full["statistics"]["identity"]["holds"] is True, "issued and lost cycles are not all thread-cycles")
        check("host_seconds" not in full["statistics"] and one["host_seconds"] > 0, "the host's time is kept apart")
    check(len({one["picture"] for one in runs}) == 1, "the picture depends on the machine")
    check(
        subprocess.run([
            evaluation.program.replace("trax-eval", "trax-render"), *SMALL["scenes"][0]["meshes"], "--view", "bunny",
            "--size", "40x24", "--engine", "native", "-q", "-o", scratch / "native.png"
        ]).returncode == 0, "the native picture")
    check(
        subprocess.run([
            evaluation.program.replace("trax-eval", "trax-compare"), "-q", scratch / "native.png",
            scratch / "undisturbed" / runs[0]["picture"]
        ]).returncode == 0, "the picture is not that of the native twin")
    check(len(results["series"]) == RUNS, "time series")
    for series, one in zip(results["series"], runs):
        check(all(share is None or 0 <= share <= 1 for row in series["rows"] for share in row[1:]),
              "shares of a time series")
        check(series["rows"][-1][0] == one["stats"]["cycles"], "the time series ends with the run")


def test_again(evaluation, scratch):
    """A second call makes nothing; --dry-run says so, of every combination of two keys."""
    before = {path: path.stat().st_mtime_ns for path in (scratch / "undisturbed/runs").iterdir()}
    run = evaluation.run(SMALL, "undisturbed")
    check(before == {path: path.stat().st_mtime_ns for path in (scratch / "undisturbed/runs").iterdir()},
          "finished runs were made again")
    both = dict(SMALL, set={"icache.banks": [1, 16], "memory.bandwidth_gbps": [4, 8]})
    run = evaluation.run(both, "dry", "--dry-run", "--size", "41x24")
    named = [f"ball {chip} icache.banks={banks} memory.bandwidth_gbps={bandwidth} ours 41x24"
             for chip in SMALL["chips"] for banks in (1, 16) for bandwidth in (4, 8)]
    check("8 of 8 runs are missing" in run.stdout and all(run.stdout.count(name) == 1 for name in named),
          f"--dry-run: {run.stdout}")


def test_quick(evaluation, scratch):
    """Quick runs stand beside the exact ones of the same sweep, with rays that were counted and no picture of the
    machine's."""
    sweep = dict(SMALL, series=0, set={}, chips="2x48")
    for mode in (["--mode", "exact"], ["--quick"]):
        run = evaluation.run(sweep, "quick", "--size", "256x144", *mode)
        check(run.returncode == 0, f"{mode}: {run.stderr}")
    found = {}
    for one in evaluation.results("quick")["runs"]:
        found.setdefault((one["program"], one["scene"], one["config"]), {})[one["mode"]] = one
    for pair in found.values():
        exact, quick = pair["exact"], pair["quick"]
        check(quick["picture"] is None and quick["experiments"] == exact["experiments"], "a quick run")
        low, rate, high = quick["values"]["mrps_low"], quick["stats"]["mrps"], quick["values"]["mrps_high"]
        counted = [(one["stats"]["items"], one["stats"]["rays"]) for one in pair.values()]
        check(counted[0] == counted[1], f"what a quick run has counted: {counted}")
        slow, fast = 1 / low - 1 / rate, 1 / rate - 1 / high  # in cycles: the fast end allows for a late end of the run
        check(0 < slow < fast * (1 + 1e-6) and fast < 1.3 * slow,
              f"a quick run's interval, whose fast end is the wider one in cycles: {low}, {rate}, {high}")
        check(high / low < 1.2 and low <= exact["stats"]["mrps"] <= high,
              f"the interval {low} to {high} has not the exact {exact['stats']['mrps']}")
        check(quick["stats"]["sampled"]["detailed_slots"] < 256 * 144 and "--sampled" in quick["command"],
              "a quick run is sampled")
    run = evaluation.run(sweep, "quick", "--size", "256x144", "--quick", "--dry-run")
    check(found and run.stdout.startswith("0 of"), "quick runs are kept")


def test_small(evaluation, scratch):
    """A picture that is small by the sweep gets smaller instead, and stands beside the larger one."""
    for mode in ([], ["--quick"]):
        run = evaluation.run(dict(SMALL, series=0, set={}, size="96x54", chips="1x32"), "smaller", *mode)
        check(run.returncode == 0, f"a small picture, {mode}")
    sizes = sorted({(*one["size"], one["mode"]) for one in evaluation.results("smaller")["runs"]})
    check(sizes == [(80, 45, "exact"), (96, 54, "exact")], f"sizes of small pictures: {sizes}")


def test_caches(evaluation, scratch):
    """The program and the order of nodes are those for the caches of each machine."""
    sizes = {"icache.bytes": [1024, 4096], "dcache.bytes": [2048, 16384]}
    check(evaluation.run(dict(SMALL, chips="1x32", series=0, set=sizes), "caches").returncode == 0, "caches")
    made = {}
    for one in evaluation.results("caches")["runs"]:
        inputs = json.loads((scratch / "caches/jobs" / f"{one['key']}.json").read_text())["inputs"]
        made[one["machine"]["icache.bytes"],
             one["machine"]["dcache.bytes"]] = inputs["program"]["xxh128"], inputs["buffers"][0]["xxh128"]
    check(made[1024, 16384][0] != made[4096, 16384][0] == made[4096, 2048][0],
          "the program is not the instruction cache's")
    check(made[4096, 2048][1] != made[4096, 16384][1], "the order of nodes is not the data cache's")


def test_damaged_job(evaluation, scratch):
    """trax-eval job trusts no file. What its caller makes of damage is in folder_test.py."""
    shutil.copytree(scratch / "undisturbed", scratch / "damaged", symlinks=True)
    for key in [path.stem for path in (scratch / "damaged/jobs").glob("*.json")][:2]:
        (scratch / "damaged/runs" / f"{key}.json").unlink()
    victim, other = sorted((scratch / "damaged/jobs").glob("*.json"), key=lambda path:
                           (scratch / "damaged/runs" / path.name).exists())[:2]
    job = json.loads(victim.read_text())
    victim.write_text(json.dumps(job | {"series": job["series"] + 1}))
    run = evaluation.inside("job", scratch / "damaged", victim.stem)
    check(run.returncode == 1 and "its name is not its hash" in run.stderr, f"a damaged job: {run.stderr}")
    for words, said in ((["../../escaped"], "is no key of a job"), ([32 * "0"], "has no job"),
                        ([other.stem, "--threads", "0"], "expected a number from 1 to 4096")):
        before = sorted(scratch.rglob("*"))
        run = evaluation.inside("job", scratch / "damaged", *words)
        check(run.returncode == 1 and said in run.stderr and sorted(scratch.rglob("*")) == before,
              f"job {words}: {run.stderr}")
    for path in (scratch / "damaged/inputs").glob("*/program.elf"):
        path.write_bytes(path.read_bytes()[:-1])
    run = evaluation.inside("job", scratch / "damaged", other.stem)
    check(run.returncode == 1 and "program.elf: " in run.stderr and "bytes, but" in run.stderr,
          f"damaged inputs: {run.stderr}")
    check("bytes, but" in (scratch / "damaged/runs" / f"{other.stem}.error").read_text(), "its reason is kept")


def test_rays(evaluation, scratch):
    """Workloads, of ours and of a file beside the sweep, and what the rays of each kind took."""
    (scratch / "two.json").write_text('{"name": "two", "render": ["--occlusion", "2"]}')
    sweep = {
        "name": "rays", "scenes": SMALL["scenes"], "chips": ["1x32"],
        "workloads": ["primary-shadow", "two.json", "glass"], "ray_kinds": True, "size": "40x24"
    }
    run = evaluation.run(sweep, "rays", "--jobs", "2")
    check(run.returncode == 0, f"exit status {run.returncode}: {run.stderr}")
    found = {one["workload"]: one for one in evaluation.results("rays")["runs"]}
    kinds = {
        "primary-shadow": {"primary", "shadow"}, "two": {"primary", "shadow", "occlusion"},
        "glass": {"primary", "mirror", "glass"}
    }
    check(found.keys() == kinds.keys(), f"workloads {found.keys()}")
    for name, one in found.items():
        values, stats = one["values"], one["stats"]
        seen = {
            key.split(".")[1] for key, value in values.items()
            if key.startswith("rays.") and key.endswith(".count") and value
        }
        check(seen == kinds[name], f"{name}: kinds {seen}")
        check(
            all(values[f"rays.{kind}.count"] == stats["rays_by_kind"][kind] for kind in seen) and
            values["rays.primary.count"] == 40 * 24, f"{name}: counts")
        check(
            abs(sum(value
                    for key, value in values.items() if key.startswith("rays.") and key.endswith(".share")) - 1) < 1e-9,
            f"{name}: shares of the thread-cycles")
        for kind in seen:
            mine = {key.split(".", 2)[2]: value for key, value in values.items() if key.startswith(f"rays.{kind}.")}
            check(
                abs(sum(mine[part]
                        for part in ("utilisation", "fetch", "memory", "dcache", "units", "rest")) - 1) < 1e-9 and
                mine["rest"] >= 0, f"{name} {kind}: {mine}")
            check(mine["mrps"] > 0 and mine["energy_per_ray"] > 0 and mine["bytes_per_ray"] >= 0,
                  f"{name} {kind}: {mine}")
        check("--mark-rays" in one["command"], one["command"])
    check("--occlusion 2" in found["two"]["command"] and "--material glass:1.5" in found["glass"]["command"],
          "commands repeat the workload")
    check("two" in run.stdout and "occlusion" in run.stdout, f"the table: {run.stdout}")
    # The paper's tables are of the paper's workload alone.
    page = evaluation.scratch / "rays.html"
    made = evaluation.inside("report", evaluation.scratch / "rays/results.json", "-o", page)
    check(made.returncode == 0, f"report: {made.stderr}")
    text = page.read_text()
    check('id="rays-table"' in text and 'id="rays-stalls"' in text, "the report's section")


def test_options(evaluation, scratch):
    """Options of trax-scene and trax-render as keys, variants with programs of their own, and pictures beside that of a
    reference."""
    sweep = dict(
        SMALL, series=0, chips="1x32", reference="as it is",
        set=[{"name": "as it is"}, {"name": "small leaves", "trax-scene --leaf": 1},
             {"name": "other program", "program": "era"}, {"name": "by hand", "trax-render --queues": 4},
             {"name": "dim", "trax-render --ambient": 0.05, "trax-render --no-shadows": [True, False]},
             {"name": "slow", "memory.bandwidth_gbps": 4, "trax-scene --splits": False}])
    run = evaluation.run(sweep, "options", "--jobs", "2")
    check(run.returncode == 0, f"exit status {run.returncode}: {run.stderr}")
    results = evaluation.results("options")
    runs = {(one["variant"], one["set"].get("trax-render --no-shadows")): one for one in results["runs"]}
    names = ["as it is", "small leaves", "other program", "by hand", "dim", "dim", "slow"]
    check(sorted(name for name, _ in runs) == sorted(names), f"variants {list(runs)}")
    check([one["variants"] for one in results["sweeps"]] == [list(dict.fromkeys(names))] and
          results["sweeps"][0]["reference"] == "as it is", f"sweeps {results['sweeps']}")
    check([program["name"] for program in results["programs"]] == ["ours", "era"] and
          all(program["title"] for program in results["programs"]), f"programs {results['programs']}")
    check([scene["name"] for scene in results["scenes"]] == ["ball"] and results["version"] == 2, "scenes and version")
    plain = runs["as it is", None]
    differ = {key: one["values"]["picture.pixels_that_differ"] for key, one in runs.items()}
    check(all(differ[key, None] == 0 for key in ("as it is", "small leaves", "by hand", "slow")),
          f"pixels that differ: {differ}")
    check(differ["dim", True] >= 100 and differ["dim", False] >= 100 and 0 <= differ["other program", None] < 100,
          f"pixels that differ: {differ}")
    check(runs["dim", True]["stats"]["rays"] < runs["dim", False]["stats"]["rays"] == plain["stats"]["rays"],
          "rays without shadows")
    check(
        runs["small leaves", None]["stats"]["cycles"] != plain["stats"]["cycles"] !=
        runs["by hand", None]["stats"]["cycles"], "the options change nothing")
    check(
        runs["other program", None]["program"] == "era" and
        runs["other program", None]["machine"] == {"fpu.compare_units": True}, "a variant's program")
    check(
        runs["slow", None]["machine"] == {"memory.bandwidth_gbps": 4} and
        runs["slow", None]["stats"]["configuration"]["memory"]["bandwidth_gbps"] == 4 and plain["set"] == {},
        "keys of the machine")
    check(
        "trax-scene --leaf=1 MESHES -o scene.trax && trax-render scene.trax" in runs["small leaves", None]["command"]
        and "--ambient=0.05" in runs["dim", True]["command"], "commands repeat the options")
    run = evaluation.run(sweep, "options", "--variant", "dim", "--scene", "ball", "--chip", "1x32", "--dry-run")
    check(run.stdout == "0 of 3 runs are missing\n",
          f"--variant, which keeps the reference, --scene, --chip: {run.stdout}{run.stderr}")
    # trax-render's figures of a picture, also for a changed program; and seeds of samples, which an exact run does not
    # use.
    sweep = dict(SMALL, name="measured", series=0, chips="1x32", error=True, hits=True,
                 set=[{"name": "9 bits", "special.precision_bits": 9},
                      {"name": "changed", "program": "triangles/moller-trumbore"}])
    run = evaluation.run(sweep, "measured", "--jobs", "2")
    check(run.returncode == 0, f"error and hits: {run.stderr}")
    found = {one["variant"]: one["values"] for one in evaluation.results("measured")["runs"]}
    check(sorted(found) == ["9 bits", "changed"], f"variants {list(found)}")
    for variant, values in found.items():
        check(values["hits.pixels"] == values["hits.nearest"] == 40 * 24, f"hits: {values}")
        check((values["error.numerical_rmse"] > 1) == (variant == "9 bits") and values["error.numerical_rmse"] < 60 and
              values["error.total_rmse"] > 1, f"error, {variant}: {values}")
        check(
            1000 < values["code.bytes"] < 8192 and 0 < values["code.stack_bytes"] <= 512 and
            values["scene_bytes"] > 2 * ROWS * ROWS * 40, f"sizes: {values}")
    seeds = dict(SMALL, name="seeds", series=0, chips="1x32", set={"trax-render --sample-seed": [1, 2]}, mode="quick",
                 size="256x144")
    for mode, runs in (([], 2), (["--mode", "exact"], 1)):
        run = evaluation.run(seeds, "measured", *mode, "--dry-run")  # where the scene has been imported
        check(f"{runs} of {runs} runs are missing" in run.stdout, f"seeds of samples, {mode}: {run.stdout}{run.stderr}")
    run = evaluation.run(dict(seeds, size="40x24"), "seeds", "--mode", "exact", "--jobs", "2")
    found = [(one["set"], len(one["points"])) for one in evaluation.results("seeds")["runs"]]
    check(run.returncode == 0 and found == [({}, 1)],
          f"an exact run has no seed, so that tables find it: {found}, {run.stderr}")
    read_sweep = importlib.import_module("trax_eval.sweep").read_sweep
    for size, smaller in (("60x34", "60x34"), ("320x180", "80x45"), ("640x360", "640x360"), ("1280x720", "853x480")):
        points = read_sweep(evaluation.file(dict(SMALL, size=size, series=0)), mode="quick").points
        check({point.size for point in points} == {smaller}, f"--quick makes of {size} {smaller}: {points}")


REFUSED = [
    ('{"name": "x", "set": {"trax-scene --leafs": 4}}',
     "set.trax-scene --leafs: unknown option --leafs; did you mean --leaf?"),
    ('{"name": "x", "set": {"trax-scene --leaf": [4, 9]}}',
     "set.trax-scene --leaf: --leaf: '9' is not a whole number from 1 to 7"),
    ('{"name": "x", "set": {"trax-render --ambient": "much"}}', "set.trax-render --ambient: --ambient: 'much'"),
    ('{"name": "x", "set": {"trax-render --smooth": "yes"}}', "--smooth takes no value"),
    ('{"name": "x", "set": {"trax-render --siz": "9x9"}}',
     "set.trax-render --siz: trax-eval sets --size itself"),
    ('{"name": "x", "set": {"trax-render --pixel": "1,1"}}',
     "set.trax-render --pixel: trax-eval sets --pixel itself"),
    ('{"name": "x", "set": {"trax-render --pre": "d"}}',
     "set.trax-render --pre: --prepare writes files, and trax-eval itself chooses them"),
    ('{"name": "x", "set": {"trax-render --views": true}}',
     "set.trax-render --views: --views ends trax-render before it does anything"),
    ('{"name": "x", "set": {"trax-sim --engine": "fast"}}',
     'set.trax-sim --engine: "trax-sim" is no program whose options can be set; "trax-scene", "trax-render" are'),
    ('{"name": "x", "set": {"trax-scene --leaf": [[1]]}}', "expected a text, a number, true (given), false (left out)"),
    ('{"name": "x", "set": [{"name": "a"}, {"name": "a", "icache.banks": 4}]}', 'set: the variant "a" is there twice'),
    ('{"name": "x", "set": [{"name": ""}]}', "set: name: expected a text of at most 100"),
    ('{"name": "x", "set": [{"name": "a", "program": "theirs"}]}',
     'set.program: "theirs" is no program; allowed are "era"'),
    ('{"name": "x", "set": [{"name": "a", "program": "paper"}]}',
     "set.program: is a set of programs; a variant has one"),
    ('{"name": "x", "set": [{"name": "a", "program": 1}]}', "set.program: expected the name"),
    ('{"name": "x", "set": [{"name": "a"}], "reference": "b"}',
     'reference: "b" is neither a variant nor a program of this sweep; "a", "ours", "era" are'),
    ('{"name": "x", "table": 1}', "table: expected an object or a list of objects"),
    ('{"name": "x", "error": 1}', "error: expected true or false"),
    ('{"name": "x", "mode": "quick", "programs": "ours", "hits": true}', "mode: series, ray_kinds"),
    ('{"name": "x", "error": true}',
     'programs: error, hits and workloads with "rays" need programs that are "specialised"'),
    ('{"name": "x", "programs": ["ours", "paper"]}', 'programs: "ours" is there twice'),
    ('{"name": "x", "chip": "4x32"}', 'unknown key "chip", did you mean "chips"'),
    ('{"name": "x", "chips": "4x33"}', "4x33"),
    ('{"name": "x", "chips": []}', "chips: expected a list of texts"),
    ('{"name": "x", "chips": ["4x32", "4x32"]}', "twice"),
    ('{"name": "x", "programs": ["theirs"]}', 'programs: "theirs" is no program; allowed are "era", '),
    ('{"name": "x", "scenes": ["cornell"]}',
     'scenes: "cornell" is no scene; allowed are "conference", "crytek-sponza"'),
    ('{"name": "x", "scenes": [{"name": "y", "mesh": "z"}]}',
     'scenes: unknown key "mesh", did you mean "meshes"? Allowed are "name", "title", "meshes", "view"'),
    ('{"name": "x", "set": {"icache.bank": 4}}', 'unknown key "icache.bank"; did you mean icache.banks'),
    ('{"name": "x", "set": {"icache.banks": [4, 0]}}', "icache.banks is 0; allowed are"),
    ('{"name": "x", "set": {"icache.banks": []}}', "set.icache.banks: expected a number"),
    ('{"name": "x", "set": {"icache.banks": "4"}}', "set.icache.banks: expected a number"),
    ('{"name": "x", "set": {"dcache.replacement": ["lru", "mru"]}}',
     'dcache.replacement is "mru"; allowed are fifo, lru'),
    ('{"name": "x", "set": {"icache.banks": 4, "icache.banks": 8}}', '"icache.banks" is there twice'),
    ('{"name": "x", "set": {"memory.bandwidth_gbps": NaN}}', "NaN is no number"),
    ('{"name": "x", "size": "0x10"}', "size: expected"),
    ('{"name": "x", "mode": "fast"}', '"fast" is unknown; allowed are "exact", "quick"'),
    ('{"name": "x", "series": -1}', "series: expected"),
    ('{"name": "x", "mode": "quick", "series": 100}',
     'mode: series, ray_kinds, error, hits, workloads with "rays" and programs that are compiled or converted need '
     '"exact"'),
    ('{"name": "x", "ray_kinds": 1}', "ray_kinds: expected true or false"),
    ('{"name": "x", "ray_kinds": true, "programs": ["ours", "era"]}',
     'programs: workloads, ray_kinds and ray_cycles need programs with "rays": true, which '),
    ('{"name": "x", "workloads": ["fog"]}',
     'workloads: "fog" is no workload; allowed are "diffuse", "diffuse-alone", "glass"'),
    ('{"name": "x", "workloads": ["../none.json"]}', '"../none.json" is no workload'),
    ('{"name": "x", "workloads": []}', "workloads: expected a list of texts"),
    ('{"name": "x", "x": "nokey"}', 'x: "nokey" is no key'),
    ('{"name": "x", "x": "icache.bank"}', "did you mean icache.banks?"),
    ('{"name": "x", "y": "mrsp"}', 'y: "mrsp" is no statistic of trax-sim --help-stats'),
    ('{"name": "x", "y_per": "area"}', 'y_per: "area" is no statistic'),
    ('{"name": "x", "y": "values.bytes_per_rey"}', "did you mean values.bytes_per_ray?"),
    ('{"name": "x", "y": "kind.mrsp"}', "did you mean kind.mrps?"),
    ('{"name": "x", "y": "values.rays.primry.mrps"}', "did you mean values.rays.primary.mrps?"),
    ('{"name": "x", "y_per": "host.seconds"}', 'y_per: "host.seconds" is no statistic'),
    ('{"name": "x", "table": {"values": "configuration.icache.bytez"}}', "did you mean configuration.icache.bytes?"),
    ('{"name": "x", "table": {"rows": "foo"}}', 'table.rows: "foo" is no axis'),
    ('{"name": "x", "table": [{}, {"columns": ["scene", "varient"]}]}',
     'table[1].columns: "varient" is no axis: neither a key of trax-sim --help-config nor one of program, scene, '
     'workload, kind, variant, chip, size, mode, threads; did you mean variant?'),
    ('{"name": "x", "table": {"where": {"varient": "a"}}}', 'table.where: "varient" is no axis'),
    ('{"name": "x", "table": {"values": "cycels"}}', "did you mean cycles?"),
    ('{"name": "x", "table": {"values": {"name": "mrps", "per": "aria_mm2"}}}', "did you mean area_mm2?"),
    ('{"name": "x", "lockstep": true}', 'unknown key "lockstep"'),
    ('{"name": "../x"}', "name: expected letters"),
    ('{"chips": "4x32"}', "name: expected letters"),
    ('{"name": "x"}', 'it is no sweep without "scenes" and "chips"'),
    ('{"name": "x", "scenes": "paper"}', 'it is no sweep without "chips"'),
    ('{"name": "x", "chips": "4x32", "title": "\\ud800"}', "no text"),
    ('{"name": "x", "chips": "4x32\\u0000"}', "no text"),
    ('{"name": "x", "chips": "4x32", "set": {"memory.bandwidth_gbps": 1e999}}', "1e999 is no number"),
    ('{"name": "x", "chips": "4x32", "set": {%s}}' % ", ".join(f'"a{i}": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]'
                                                               for i in range(20)), "more than 100000 combinations"),
    ('{"name": "x", "chips": "4x32", "title": "%s"}' % (1100000 * "x"), "more than 1048576 bytes"),
    ("[]", "expected an object"),
    ('{"name": "x",', "sweep.json:1:"),
    ("[" * 100000, "sweep.json"),
]


REFUSED_WORDS = (
    ([], "no experiment"),
    (["table9"], '"table9" is neither an experiment'),
    (["scnes"], "nor a folder of scenes; did you mean scenes?"),
    (["--quik", "scenes"], "unrecognized arguments: --quik; did you mean --quick?"),
    (["table2", "--size", "1"], "--size 1: expected"),
    (["table2", "-o", ""], "--output: the value is empty"),
    (["table2", "--program", "x"], "--program x: allowed"),
    (["table2", "--jobs", "0"], "--jobs 0"),
    (["--nonsense"], "--nonsense"),
    (["table2", "--hosts", "a"], "--hosts is no longer there; GNU parallel"),
    (["table2", "--scene", "x"], "--scene x: the sweep has conference; crytek-sponza"),
    (["era-choices", "--variant", "x"], "--variant x: the sweep has as chosen; "),
    (["table2", "--chip", ""], "--chip: the value is empty"),
    (["table2", "--program", "none.json"], '"none.json" is no program'),
    (["new-sweep"], "copy "),
    (["table2", "--runner=slurm"], "--runner is no longer there; GNU parallel, Slurm"),
    (["no.json"], "no.json: No such"),
    (["spce", "no.json"], "did you mean space?"),
    (["--quiet", "space", "no.json"], "space is a command, and comes first: trax-eval space"),
    (["space"], "space: expected a sweep"),
    (["--all", "no.json"], "no.json: --all is the paper's experiments"),
    (["table2", "/usr", "/tmp"], "/tmp: /usr is the folder of scenes already"),
)


def test_refusals(evaluation, scratch):
    complete = {"scenes": [{"name": "bunny", "meshes": [BUNNY]}], "chips": "4x32"}
    for text, message in REFUSED:
        if text.startswith('{"name": ') and text.endswith("}") and "without" not in message:  # nothing else is wrong
            text = text[:-1] + "".join(f', "{key}": {json.dumps(value)}'
                                       for key, value in complete.items() if f'"{key}"' not in text) + "}"
        run = evaluation.inside(evaluation.file(text), scratch, "-o", scratch / "refused")
        check(run.returncode == 1, f"{text[:60]}: exit status {run.returncode}: {run.stderr[-300:]}")
        check(message in run.stderr and "sweep.json" in run.stderr,
              f"{text[:60]}: {run.stderr.strip()!r} has not {message!r}")
    for words, message in REFUSED_WORDS:
        run = evaluation.inside(*words, "-o", scratch / "refused")
        check(run.returncode == 1 and message in run.stderr, f"{words}: {run.stderr.strip()!r} has not {message!r}")
    check(not list((scratch / "refused").rglob("*.json")), "what was refused left files")
    refuse_writing(evaluation, scratch, complete)
    # Scenes that are not there: the others are run, and the status tells.
    run = evaluation.run(
        {
            "name": "x", "scenes": ["conference", {"name": "bunny", "meshes": [BUNNY]}], "chips": "4x32",
            "programs": "ours", "size": "8x8"
        }, "partly")
    check(run.returncode == 1 and "neither conference.ply nor conference.ply.xz is there" in run.stderr,
          f"a missing scene: {run.stderr}")
    check(
        sorted(one["status"] for one in evaluation.results("partly")["runs"]) == ["done", "failed"],
        "the other scene was not run")
    # A cause that keeps several inputs from being made is reported once.
    run = evaluation.run({"name": "x", "scenes": [{"name": "bunny", "meshes": [BUNNY], "view": "none"}],
                          "chips": ["1x32", "2x32"], "programs": "ours", "size": "8x8"}, "unseen")
    check(run.returncode == 1 and run.stderr.count("trax comes with no such view") == 1, f"no view: {run.stderr}")


READING = {"trax-scene": ("tree", "tree-triangles", "tree-boxes", "refit"),
           "trax-render": ("view", "environment")}  # options with files that are not refused


def refuse_writing(evaluation, scratch, complete):
    """Before anything runs, also of --dry-run: every option with a file in sweeps, programs and workloads, but for
    those that read; the first three by every spelling in all three, the others by one of them each."""
    victim = scratch / "victim"
    for tool, key in (("trax-scene", "scene"), ("trax-render", "render")):
        listed = re.findall(
            r"^ +(?:-(\w), )?--([\w-]+) \S*(?:FILE|DIR|SCENE)",
            subprocess.run([evaluation.program.replace("trax-eval", tool), "--help"], capture_output=True,
                           text=True).stdout, re.MULTILINE)
        check(len(listed) > 5, f"{tool} --help lists {listed}")
        for place, (letter, name) in enumerate(listed):
            good = name in READING[tool]
            spelled = [["--no-textures", f"--{name}", str(victim)], [f"--{name}={victim}"],
                       *([[f"-{letter}{victim}"], [f"-q{letter}", str(victim)]] if letter else [])]
            files = [("set", {f"{tool} --{name}": str(victim)}), *(("workloads", words) for words in spelled),
                     ("programs", spelled[0])]
            for number, (kind, value) in enumerate(files if place < 3 else [files[place % len(files)]]):
                one = f"{tool}-{name}-{number}.json"
                if kind != "set":
                    (scratch / one).write_text(
                        json.dumps({"name": "one", key: value} | ({"like": "ours"} if kind == "programs" else {})))
                sweep = {"name": "x"} | complete | {kind: value if kind == "set" else one
                                                    } | ({"programs": "ours"} if kind != "programs" else {})
                run = evaluation.inside(evaluation.file(sweep), scratch, "--dry-run", "-o", scratch / "refused")
                said = re.search(rf"--{name} writes files, and|trax-eval sets --{name} itself", run.stderr)
                check(
                    bool(said) != good and (run.returncode == 1) != good,
                    f"{kind} {value}: exit status {run.returncode}: {run.stderr.strip()[-300:]!r}")
    check(not victim.exists(), "what was refused wrote a file")


def test_folders(evaluation, scratch):
    """A folder with an experiment's name is the folder of scenes, if it is the last word of several."""
    for name in ("scenes", "rays", "table2"):
        (scratch / "named" / name).mkdir(parents=True)
        (scratch / "named" / name / "here.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (scratch / "named/mine.json").write_text(
        json.dumps(
            {"name": "mine", "scenes": [{"name": "here", "meshes": ["here.obj"]}], "programs": "ours",
             "chips": "1x32"}))
    for words, runs, note in ((["mine.json", "scenes"], 1, True), (["mine.json", "rays"], 1, True),
                              (["mine.json", "./rays"], 1, False), (["mine.json", "table2", "scenes"], None, True),
                              (["scenes", "mine.json", "rays"], None, True), (["scenes",
                                                                               "."], 5, False), (["scenes"], 5, False)):
        run = evaluation.inside(*words, "--dry-run", "--size", "8x8", "-o", scratch / "named/out",
                                cwd=scratch / "named")
        lines = run.stdout.splitlines()
        check(run.returncode == 0 and ("is taken for the folder" in run.stderr) == note,
              f"{words}: {run.returncode}: {run.stderr}")
        check(runs != 1 or lines[-1:] == ["1 of 1 runs are missing"] and "neither" not in run.stderr,
              f"{words}: {lines}: {run.stderr}")
        check(runs is not None or any("here" in line for line in lines) and len(lines) > 2,
              f"{words}: {lines}: {run.stderr}")
        check(runs != 5 or not any("here" in line for line in lines) and any("forest" in line for line in lines),
              f"{words}: {lines}: {run.stderr}")


def test_names(evaluation, scratch):
    """A run belongs to every experiment whose machine it is, whatever a sweep calls the machine: 1x32 with 48 TPs in a
    TM is 1x48."""
    folder, out = scratch / "named-scenes", scratch / "named"
    folder.mkdir()
    scenes = [f"{name}.json" for name in ("conference", "crytek-sponza", "dragon", "forest")]
    for name in scenes:
        scene = json.loads((evaluation.inside.data / "scenes" / name).read_text())
        (scratch / name).write_text(json.dumps(scene | {"meshes": [BOX]}))
    sweeps = {
        "a-sweep": {"chips": "1x32", "set": {"chip.tps_per_tm": [48, 64, 16]},
                    "x": "chip.tps_per_tm"}, "table1": {"chips": ["1x48", "1x64"]},
        "table2": {"chips": ["1x32", "1x48",
                             "1x64"]}, "table3": {"chips": "8x32", "set": {"memory.bandwidth_gbps": 16}},
        "wide": {"chips": "4x32", "set": {"chip.tms": 8, "memory.bandwidth_gbps": 16}, "x": "chip.tms"}
    }
    files = []
    for name, sweep in sweeps.items():
        files.append(scratch / f"{name}.json")
        files[-1].write_text(json.dumps({"name": name, "scenes": scenes, "programs": "ours", "size": "8x8"} | sweep))
    run = evaluation.inside(*files, folder, "-o", out)
    check(run.returncode == 0, f"machines with two names: {run.stderr}")
    results = json.loads((out / "results.json").read_text())
    found = {(one["config"], tuple(one["set"])): sorted(one["experiments"]) for one in results["runs"]}
    check(
        found == {("1x32", ()): ["table2"], ("1x48", ()): ["a-sweep", "table1", "table2"],
                  ("1x64", ()): ["a-sweep", "table1", "table2"], ("1x32", ("chip.tps_per_tm", )): ["a-sweep"],
                  ("8x32", ("memory.bandwidth_gbps", )): ["table3", "wide"]}, f"the runs are of {found}")
    for chip in ("1x48", "1x64"):
        check(
            sum(line.split()[:2] == ["|", chip] for line in run.stdout.splitlines()) == 4,
            f"Table 1, its GFLOPS by scene, Table 2 and the speed-ups have {chip}: {run.stdout}")
    title, table = run.stdout.split("a-sweep: MRPS (")[1].split("\n\n")[:2]
    rows = [line.split("|")[1].strip() for line in table.splitlines()[2:]]
    check("1x32" in title and rows == ["16", "48", "64"], f"the sweep has its own names: {title}, {rows}")
    check(evaluation.inside("report", out / "results.json", "-o", out / "report.html").returncode == 0, "the report")
    page = (out / "report.html").read_text()
    cells = {
        row.split("<td")[1].split(">")[1].split("<")[0]: row.count("not run") + row.count("missing")
        for row in page.split('id="table2-ours"')[1].split("</table>")[0].split("<tr>") if row.startswith("<td")
    }
    check([chip for chip, missing in cells.items() if not missing] == ["1x32", "1x48", "1x64"],
          f"the report's Table 2 has {cells}")


def test_experiments(evaluation, scratch):
    """The sweeps that come with trax ask for machines that there are; without its meshes a scene is left out."""
    empty = scratch / "no-scenes"
    empty.mkdir()
    run = evaluation.inside("--all", empty, "--size", "16x16", "--dry-run", "-o", scratch / "experiments")
    check(run.returncode == 0 and "error" not in run.stderr, f"--all --dry-run: {run.stderr}")
    check(
        run.stdout.count("forest") > 100 and "conference" not in run.stdout,
        "the generated forest needs no mesh, the others do")
    check("occlusion" not in run.stdout, "--all leaves out what the paper has no figure of")
    run = evaluation.inside("rays", empty, "--size", "16x16", "--dry-run", "-o", scratch / "experiments")
    check(run.stdout.count("forest") == 6 * 15, f"rays: every chip with every workload: {run.stdout[-300:]}")
    known = evaluation.inside("--help").stdout
    check(
        all(f"  {name} " in known for name in ("table1", "table2", "table3", "fpu-sharing", "staggering", "simd")),
        "--help lists the experiments")


# --- killed


def simulators(folder, program="trax-sim"):
    """Processes of the program that write below the folder."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0") if entry.name.isdigit() else [b""]
        except OSError:
            continue
        if words[0].endswith(program.encode()) and any(str(folder).encode() in word for word in words):
            found.append(int(entry.name))
    return found


def wait_for_simulators(folder):
    """The processes that a killed command had started end by themselves."""
    deadline = time.monotonic() + 60
    while simulators(folder) and time.monotonic() < deadline:
        time.sleep(0.02)
    check(not simulators(folder), "simulators live on")


def test_kill(evaluation, scratch, kills):
    """kills moments at random; a command that is at its end before its moment comes begins again in another folder, and
    tells how long one takes."""
    generator = random.Random(7)
    begin = time.monotonic()
    evaluation.run(SMALL, "once", "--jobs", "2")
    whole = time.monotonic() - begin
    hit, folders, fresh = 0, 1, True
    while hit < kills and folders < 3 * kills:
        name, begin = f"killed-{folders}", time.monotonic()
        process = subprocess.Popen(evaluation.command(SMALL, name, "--jobs", "2"), stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, start_new_session=True)
        try:
            process.wait(timeout=generator.uniform(0, whole))
            check(process.returncode == 0, f"{name}: exit status {process.returncode} after kills")
            same_bytes(scratch, "undisturbed", name)
            whole = time.monotonic() - begin if fresh else whole
            folders, fresh = folders + 1, True
            continue
        except subprocess.TimeoutExpired:
            fresh = False
        if hit % 2:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        else:  # the command alone: what it started is to end by itself
            process.kill()
        hit += process.wait() == -signal.SIGKILL
        wait_for_simulators(scratch / name)
        for path in (scratch / name).rglob("*.json"):
            if not path.name.startswith(".") and "scratch" not in path.parts:
                json.loads(path.read_text())
    check(hit == kills, f"only {hit} of {kills} kills came before the end")
    run = evaluation.run(SMALL, name, "--jobs", "2")
    check(run.returncode == 0, f"after the kills: {run.stderr}")
    same_bytes(scratch, "undisturbed", name)
    print(f"killed {hit} times in {folders} folders, {whole:.1f} s undisturbed")


def wait_for_reader(pipe):
    """Opens it for writing, once somebody reads it; None if nobody does."""
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        try:
            return os.open(pipe, os.O_WRONLY | os.O_NONBLOCK)
        except OSError:  # ENXIO: nobody has opened it yet
            time.sleep(0.01)
    return None


def test_interrupt(evaluation, scratch):
    """Each signal ends the command, by itself, and what it has started: a simulator, an importer; and while it waits
    for a pipe."""
    os.mkfifo(scratch / "pipe.json")
    slow, large = dict(SMALL, size="1280x720"), {
        "name": "w", "chips": "4x32", "scenes": [{"name": "large", "meshes": ["generate:forest"]}]
    }
    sweeps, numbers = {"simulated": slow, "imported": large,
                       "read": None}, (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    for place, number in enumerate(numbers):
        for name in list(sweeps)[:place] + list(sweeps)[place + 1:]:  # two of the three each
            sweep = sweeps[name]
            command = evaluation.command(sweep, "interrupted", "--jobs", "2") if sweep else [
                evaluation.program, str(scratch / "pipe.json"), "-o",
                str(scratch / "interrupted")
            ]
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            wanted, deadline = {"simulated": "trax-sim", "imported": "trax-scene",
                                "read": None}[name], time.monotonic() + 60
            while wanted and not simulators(scratch / "interrupted", wanted) and time.monotonic() < deadline:
                time.sleep(0.01)
            writer = None if wanted else wait_for_reader(scratch / "pipe.json")
            time.sleep(0.1)
            process.send_signal(number)
            errors = process.communicate(timeout=60)[1]
            if writer:
                os.close(writer)
            check(process.returncode == -number and "the same command goes on" in errors and "Traceback" not in errors,
                  f"{name}, interrupted: {process.returncode}: {errors}")
            check(not wanted or not simulators(scratch / "interrupted", wanted),
                  f"{name}, interrupted: a {wanted} lives on")
            left = [
                path for folder in ("scratch", "scenes") for path in (scratch / "interrupted" / folder).glob("*")
                if path.suffix not in (".trax", ".json")
            ]
            check(not left, f"{name}, interrupted: {left} are left")
    check(not list((scratch / "interrupted/runs").glob("*.error")), "an interrupt is no failure of a run")


def test_held(evaluation, scratch):
    """An interrupt finds every process that was started, at each place where it may come: test_interrupt hits only some
    of them."""
    interrupts, runners, tools = (importlib.import_module(f"trax_eval.{name}")
                                  for name in ("interrupts", "runners", "tools"))
    begun, ended, show = [], threading.Event(), runners.Progress(2, {}, True)

    def interrupted(call, *arguments):
        """Whether it ended so, and killed all of `begun` that had not ended by themselves."""
        try:
            call(*arguments)
        except interrupts.Interrupted:
            return [process.wait() < 0 for process in begun if "sleep" in process.args] == [True]
        return False

    def job(out, tools, key, threads, on_start):
        """One that sleeps, and one that has ended, but not its thread."""
        process = subprocess.Popen(["sleep", "20"] if key == "long" else ["true"])
        on_start(process)
        begun.append(process)
        process.wait()
        if key == "short":
            while len(begun) < 2:
                time.sleep(0.001)
            ended.set()
            for other in begun:
                other.wait()

    def interrupt(*arguments):
        raise interrupts.Interrupted(signal.SIGINT)

    def second(self, *arguments):
        if begun:
            interrupt()
        handed_out = submit(self, *arguments)
        while not begun:
            time.sleep(0.001)
        return handed_out

    submit, options = runners.concurrent.futures.ThreadPoolExecutor.submit, argparse.Namespace(jobs=2)
    show.show = lambda: ended.is_set() and interrupt()
    with unittest.mock.patch.object(runners, "try_job", job):
        with unittest.mock.patch.object(runners.concurrent.futures.ThreadPoolExecutor, "submit", second):
            check(interrupted(runners.run_locally, scratch, None, ["long", "short"], options, show),
                  "interrupted while jobs are handed out")
        begun.clear()
        check(interrupted(runners.run_locally, scratch, None, ["long", "short"], options, show),
              "interrupted when a process has just ended")

    class Started(subprocess.Popen):
        def __init__(self, *words, **where):
            super().__init__(*words, **where)
            begun.append(self)
            interrupts.interrupt(signal.SIGINT, None)

    with unittest.mock.patch.object(tools.subprocess, "Popen", Started):
        for call in (lambda: tools.run_tool(["sleep", "20"]), lambda: list(tools.run_tools([["sleep", "20"]], 1))):
            begun.clear()
            check(interrupted(call), "interrupted when a process has just started")

    class Unnoticed(subprocess.Popen):
        """The interrupt comes just before the wait, and Python notices it at the wait's end."""
        def communicate(self, *words, **where):
            begun.append(self)
            try:
                return super().communicate(*words, **where)
            finally:
                interrupts.interrupt(signal.SIGINT, None)

    begun.clear()
    with unittest.mock.patch.object(tools.subprocess, "Popen", Unnoticed):
        check(interrupted(tools.run_tool, ["sleep", "20"]), "interrupted just before it waits")


# --- single jobs


def test_jobs(evaluation, scratch):
    """Another scheduler, xargs, runs the jobs that --prepare prints; the same command takes what they have made."""
    prepared = evaluation.run(SMALL, "jobs", "--prepare")
    keys = prepared.stdout.split()
    check(prepared.returncode == 0 and len(set(keys)) == RUNS and not (scratch / "jobs/results.json").exists(),
          f"--prepare: {prepared.returncode}: {prepared.stdout}{prepared.stderr}")
    subprocess.run(["xargs", "-n", "1", "-P", "2", evaluation.program, "job", scratch / "jobs"], input=prepared.stdout,
                   text=True, check=True, timeout=300)
    check(evaluation.run(SMALL, "jobs", "--prepare").stdout == "", "--prepare prints runs that are there")
    made = {path: path.stat().st_ino for path in (scratch / "jobs/runs").glob("*.json")}
    run = evaluation.run(SMALL, "jobs")
    check(run.returncode == 0 and all(path.stat().st_ino == inode for path, inode in made.items()),
          f"the jobs' results: {run.stderr}")
    same_bytes(scratch, "undisturbed", "jobs")


def test_reason(evaluation, scratch):
    """The text about a failed run names the reason."""
    runners = importlib.import_module("trax_eval.runners")
    progress = runners.Progress(1, {"a": "run a"}, False)
    with unittest.mock.patch.object(sys, "stderr") as errors:
        progress.finished(
            "a", "trax-sim: fault: abort\n  message     this program renders boxes only\n  at          0x000014c0")
    said = "".join(call.args[0] for call in errors.write.call_args_list)
    wanted = "run a: FAILED: trax-sim: fault: abort: this program renders boxes only (1 of 1)"
    check(wanted in said, f"it says {said!r}")


TESTS = (test_sweep, test_again, test_quick, test_small, test_caches, test_damaged_job, test_rays,
         test_options, test_refusals, test_folders, test_names, test_experiments, test_kill, test_interrupt, test_held,
         test_jobs, test_reason)
OF_SWEEP = {"again", "damaged_job", "kill", "jobs"}  # they need the results of test_sweep


def tests(options, scratch):
    for number in (signal.SIGINT, signal.SIGHUP):  # a shell's background and nohup ignore them: children would, too
        signal.signal(number, signal.SIG_DFL)
    evaluation = Evaluation(options.bin, scratch)
    SMALL["scenes"][0]["meshes"] = [str(scratch / "ball.obj")]
    write_ball(scratch / "ball.obj")
    if options.only in OF_SWEEP:
        evaluation.run(SMALL, "undisturbed", "--jobs", "2")
    listed = {test.__name__.removeprefix("test_"): test for test in TESTS}
    more = {"kill": (options.kills,)}
    return {name: lambda name=name, test=test: test(evaluation, scratch, *more.get(name, ()))
            for name, test in listed.items()}


if __name__ == "__main__":
    sys.exit(main(__doc__, tests, kills=10))
