#!/usr/bin/env python3
"""rays_test.py --bin BIN: the cycles of rays in exact and sampled runs, their intervals, and the tables that show
them."""
import argparse
import csv
import json
import math
import pathlib
import random
import re
import subprocess
import sys

parser = argparse.ArgumentParser()
parser.add_argument("--bin", type=pathlib.Path, required=True)
BIN = parser.parse_args().bin.resolve()
HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [str(HERE.parent), str(BIN.parent / "lib/trax/evaluation")]
import checking  # noqa: E402
from checking import check  # noqa: E402
from report.results import Results  # noqa: E402
from report.sweeps import SweepTable, by_kind  # noqa: E402
from trax_eval.values import STALLS, half_width, student_95, values_of_rays  # noqa: E402

FIGURES = ("mrps", "share", "utilisation", "rest", *STALLS)


def student():
    """Quantiles from published tables, and no step where the expansion begins."""
    for degrees, known in ((1, 12.706), (9, 2.262), (12, 2.179), (15, 2.131), (30, 2.042), (60, 2.000), (120, 1.980)):
        check(abs(student_95(degrees) - known) < 1e-3, "Student's quantile", degrees, student_95(degrees), known)


def coverage():
    """Intervals of known populations, of totals and of quotients, hold the true value in about 95 of 100 cases."""
    chance = random.Random(34)
    held = {False: 0, True: 0}
    repeats, count = 400, 20
    for _ in range(repeats):
        draws = []
        for _ in range(count):
            size = chance.uniform(1, 5)
            draws.append((size * chance.gauss(0.3, 0.05) / count, size / count))
        for quotient in held:
            whole, other = (sum(draw[side] for draw in draws) for side in (0, 1))
            estimate = whole / other if quotient else whole
            half = half_width(draws, whole, other if quotient else None)
            held[quotient] += abs(estimate - (0.3 if quotient else 0.3 * 3)) <= half
    for quotient, hits in held.items():  # a hundredth is added for caches, so that they are somewhat too wide
        check(0.92 * repeats <= hits <= 0.995 * repeats, "coverage of", "quotients" if quotient else "totals", hits)


def rendered(name, *words):
    stats, rays = f"{name}.json", f"{name}.csv"
    subprocess.run([BIN / "trax-render", HERE.parent / "render/box.obj", "--view", HERE.parent / "render/box.view",
                    "--size", "240x135", "--config", "1x32", "--occlusion", "2", "--quiet", "-o", "p.png", "--stats",
                    stats, "--ray-cycles", rays, *words], check=True)
    with open(rays, newline="") as file:
        rows = [{key: value if key in ("part", "kind") else float(value) for key, value in row.items()}
                for row in csv.DictReader(file)]
    statistics = json.loads(pathlib.Path(stats).read_text())
    return rows, values_of_rays({"ray_cycles": rows}, statistics), statistics


def sampled():
    rows, exact, statistics = rendered("exact")
    check(not any(name.endswith("_half") for name in exact), "an exact run has intervals")
    whole, _, _ = rendered("whole", "--sampled", "--sample-fraction", "1")
    check(rows == whole, "--sample-fraction 1: other cycles")
    held = []
    for seed in ("1", "2", "3"):
        parts, values, some = rendered("some", "--sampled", "--sample-fraction", "0.2", "--sample-seed", seed)
        for row in [row for row in parts if row["part"] == "all"]:
            same = [part for part in parts if part["part"] != "all" and part["kind"] == row["kind"]]
            for cause in ("thread_cycles", "issued", "icache_miss", "wait_memory"):
                total = sum(part["weight"] * part[cause] for part in same)
                check(abs(total - row[cause]) <= 2 + 1e-6 * total + 25 * (cause == "thread_cycles"), seed, row["kind"],
                      cause, "adds up to", total, "not", row[cause])
            rays = statistics["rays_by_kind"].get(row["kind"], 0)
            check(row["rays"] == rays, seed, "rays of", row["kind"])
            estimated = sum(part["weight"] * part["rays"] for part in same)
            check(abs(estimated - rays) <= 0.25 * rays, seed, "rays of the parts", estimated)
        total = sum(row["thread_cycles"] for row in parts if row["part"] == "all")
        check(abs(total / some["thread_cycles"] - 1) < 1e-3, seed, "all kinds took", total, some["thread_cycles"])
        for kind in ("primary", "shadow", "occlusion"):
            for figure in FIGURES:
                name = f"rays.{kind}.{figure}"
                half = values[f"{name}_half"]
                held.append(abs(values[name] - exact[name]) <= half)
                fits = (half > 0) == (values[name] > 0) and half < 0.6 * max(exact[name], 0.05)
                check(fits, seed, name, values[name], "half width", half)
    check(sum(held) >= 0.9 * len(held), "intervals hold", sum(held), "of", len(held))


def document(records):
    return {"format": "trax-eval-results", "version": 2, "runs": records, "sweeps": [], "series": [], "scenes": [],
            "programs": [], "workloads": []}


class Paper:
    chips = ["1x32", "8x64"]


def tables():
    """The interval of a mean of scenes, and of a quotient of two chips, by hand."""
    def record(scene, chip, rate, half):
        return {"key": f"{scene}{chip}", "scene": scene, "program": "ours", "config": chip, "mode": "quick",
                "status": "done", "experiments": ["s"], "size": [8, 8],
                "values": {"rays.shadow.count": 9, "rays.shadow.mrps": rate, "rays.shadow.mrps_half": half}}

    records = [record("a", "1x32", 2.0, 0.3), record("b", "1x32", 4.0, 0.4), record("a", "8x64", 20.0, 1.0),
               record("b", "8x64", 28.0, 0.0)]
    results = Results(document(records))
    runs = list(by_kind(results.of_sweep("s")))
    spec = {"rows": ["kind"], "columns": ["chip"], "mean": ["scene"], "relative": {"chip": "1x32"},
            "values": [{"name": "kind.mrps", "as": "figure"}, {"name": "kind.mrps", "as": "times", "title": "growth"}]}
    made = SweepTable(results, Paper, {"name": "s"}, spec, runs).made("s", "s")
    cells = [(cell.shown, cell.below) for cell in made.rows[0][1:5]]
    growth = 8 * math.sqrt((0.25 / 3)**2 + (0.5 / 24)**2)
    halves = [below.removeprefix("±\u00a0") for _, below in cells]
    check([shown for shown, _ in cells] == ["3.00", "1.00", "24.0", "8.00"], cells)
    check(halves == ["0.25", "", "0.50", f"{growth:.2f}"], cells)


def sweep():
    """A quick sweep with workloads: trax-eval finds the kinds, and shows intervals."""
    pathlib.Path("s.json").write_text(json.dumps({
        "name": "s", "programs": "ours", "chips": ["1x32"], "workloads": ["primary-shadow"], "ray_cycles": True,
        "mode": "quick", "size": "240x135", "set": {"trax-render --sample-fraction": 0.2},
        "scenes": [{"name": "box", "meshes": [str(HERE.parent / "render/box.obj")],
                    "view": str(HERE.parent / "render/box.view")}],
        "table": {"rows": "kind", "columns": [], "values": ["kind.mrps", "kind.utilisation"]}}))
    done = subprocess.run([BIN / "trax-eval", "s.json", "-o", "out", "--jobs", "1"], capture_output=True, text=True)
    check(done.returncode == 0, done.stderr)
    rows = [line for line in done.stdout.splitlines() if line.startswith(("| primary", "| shadow"))]
    check(len(rows) == 2 and all(line.count("±") == 2 for line in rows), done.stdout)
    run = json.loads(pathlib.Path("out/results.json").read_text())["runs"][0]
    dry = subprocess.run([BIN / "trax-eval", "s.json", "-o", "out", "--jobs", "1", "--chip", "1x32,1x48", "--dry-run"],
                         capture_output=True, text=True)
    seconds = run["host"]["processor_seconds"]
    said = re.search(r"^1 of 2 runs are missing\nthey take about ([\d.]+)\u00a0(m?s) of a processor, by the 1 that ",
                     dry.stdout, re.M)
    check(said and abs(float(said[1]) / (1000 if said[2] == "ms" else 1) - seconds) <= 0.01 * seconds, dry.stdout,
          dry.stderr, seconds)
    check(run["mode"] == "quick" and run["values"]["rays.primary.mrps_half"] > 0, "no interval", run["values"])


sys.exit(checking.run(student, coverage, sampled, tables, sweep))
