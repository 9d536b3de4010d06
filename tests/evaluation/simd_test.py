#!/usr/bin/env python3
"""MIMD against SIMD: the machines of the sweeps `simd` and `simd-...` have the same bandwidth for
each mm2. A small sweep of that name runs its warps on the engine simt, shows the same pictures, and has a table of the
best programs.

    tests/evaluation/simd_test.py --bin build/bin"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402
from experiments_test import write_scene  # noqa: E402

BASE = "1x32"
SIZE = "24x16"


def check_bandwidth(runs):
    """Bandwidth for each mm2: 8 GB/s on the paper's 4x32, which is four of the machine BASE."""
    density = {}
    for run in runs:
        memory = run["stats"]["configuration"]["memory"]
        density[run["variant"]] = memory["bandwidth_gbps"] / run["values"]["area_units"]
    expected = 2 / next(run["values"]["area_units"] for run in runs if run["variant"] == "MIMD")
    for variant, value in density.items():
        check(abs(value / expected - 1) < 0.001, f"{variant}: {value} GB/s for each mm2, not {expected}")


def one_pixel(data, name):
    """A sweep of the installation with one small scene, one workload and a picture of one pixel."""
    sweep = json.loads((data / "sweeps" / f"{name}.json").read_text())
    for key in ("workloads", "ray_kinds", "reference", "table", "y"):
        sweep.pop(key, None)
    return sweep | {"scenes": [{"name": "waves", "meshes": ["waves.obj"]}], "size": "1x1"}


def evaluate(program, folder, *arguments):
    run = subprocess.run([program, *arguments, "-q", "-o", "out"], cwd=folder, capture_output=True, text=True,
                         check=False)
    check(run.returncode == 0, f"trax-eval {' '.join(arguments)}: {run.returncode}: {run.stderr}")
    return json.loads((folder / "out/results.json").read_text())["runs"]


def check_comparison(program, folder):
    warps = {"simt.width": 8, "fpu.tps_per_cluster": 1, "icache.tps_per_cache": 32, "icache.banks": 4}
    sweep = {
        "name": "simd", "scenes": [{"name": "waves", "meshes": ["waves.obj"]}], "programs": "ours", "chips": BASE,
        "workloads": "primary-shadow", "ray_kinds": True, "size": SIZE, "reference": "MIMD",
        "set": [{"name": "MIMD", "memory.bandwidth_gbps": 2}, {"name": "SIMD 8", **warps},
                {"name": "SIMD 8, whole boxes", "program": "simd/whole-boxes", **warps}]
    }
    (folder / "simd.json").write_text(json.dumps(sweep))
    runs = {run["variant"]: run for run in evaluate(program, folder, "simd.json") if "simd" in run["experiments"]}
    jobs = {name: json.loads((folder / "out" / run["json"]).read_text())["job"] for name, run in runs.items()}
    check({name: job["engine"] for name, job in jobs.items()} ==
          {"MIMD": "fast", "SIMD 8": "simt", "SIMD 8, whole boxes": "simt"}, "the engines")
    check(len({run["picture"] for run in runs.values()}) == 1, "other pictures")
    check(runs["MIMD"]["stats"]["simt"]["efficiency"] == 1, "MIMD wastes lanes")
    check(0.1 < runs["SIMD 8"]["stats"]["simt"]["efficiency"] < 1, "SIMD wastes no lanes")
    page = folder / "page.md"
    page.write_text("<!-- trax-eval simd-best: begin -->\n<!-- trax-eval simd-best: end -->\n"
                    "<!-- trax-eval simd-kinds: begin -->\n<!-- trax-eval simd-kinds: end -->\n")
    done = subprocess.run([program, "docs", "out/results.json", "page.md"], cwd=folder, capture_output=True, text=True,
                          check=False)
    check(done.returncode == 0, f"trax-eval docs: {done.stderr}")
    rows = [line.split("|")[1:-1] for line in page.read_text().splitlines() if "SIMD 8, own units |" in line]
    rows = [row for row in rows if row[1].strip() == "SIMD 8, own units"]
    best = max(("SIMD 8", "SIMD 8, whole boxes"), key=lambda name: runs[name]["stats"]["mrps"])
    over = runs[best]["values"]["mrps_per_mm2"] / runs["MIMD"]["values"]["mrps_per_mm2"]
    check([row[2].strip() for row in rows] == [runs[best]["program"]], f"the program that is shown: {rows}")
    check(rows and abs(float(rows[0][9]) - over) < 0.006 * over, f"{rows}: expected {over}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    folder = parser.parse_args().bin.resolve()
    program, data = folder / "trax-eval", folder.parent / "lib/trax/evaluation"
    with tempfile.TemporaryDirectory(dir=os.environ.get("TRAX_TEST_FOLDER")) as name:
        scratch = pathlib.Path(name)
        write_scene(scratch / "waves.obj")
        check_comparison(program, scratch)
        for sweep in ("simd", "simd-coherent", "simd-units", "simd-programs"):
            (scratch / "one.json").write_text(json.dumps(one_pixel(data, sweep) | {"name": f"one-{sweep}"}))
            runs = evaluate(program, scratch, "one.json")
            check_bandwidth([run for run in runs if f"one-{sweep}" in run["experiments"]])
    return 1 if checking.failures else 0


if __name__ == "__main__":
    sys.exit(main())
