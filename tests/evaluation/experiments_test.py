#!/usr/bin/env python3
"""The experiments of raytracer/evaluation/experiments fit the device program's source, and change how long it takes, but no bit of the picture.

Usage: experiments_test.py --bin BIN"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

BUNNY = "/usr/share/glmark2/models/bunny.obj"
LEAST = 8  # experiments: one that is not found any more must not go unnoticed


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    binaries = parser.parse_args().bin.resolve()
    files = sorted((binaries.parent / "lib/trax/evaluation/experiments").glob("*/*.json"))
    if len(files) < LEAST:
        sys.exit(f"FAILED: {len(files)} experiments")
    with tempfile.TemporaryDirectory() as folder:
        sweep = {"name": "experiments", "scenes": [{"name": "bunny", "meshes": [BUNNY], "view": "bunny"}], "chips": ["1x32"], "size": "128x128", "reference": "ours",
                 "programs": ["ours", *(os.path.relpath(file, folder) for file in files)]}
        pathlib.Path(folder, "experiments.json").write_text(json.dumps(sweep))
        run = subprocess.run([binaries / "trax-eval", "experiments.json", "--output", "out"], cwd=folder, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            sys.exit(f"FAILED: trax-eval: status {run.returncode}\n{run.stdout}{run.stderr}")
        runs = {run["program"]: run for run in json.loads(pathlib.Path(folder, "out/results.json").read_text())["runs"]}
    failures = []
    if len(runs) != len(files) + 1:
        failures.append(f"{len(runs)} runs of {len(files)} experiments")
    for name, run in runs.items():
        if run["status"] != "done" or run["values"]["picture.pixels_that_differ"] != 0:
            failures.append(f"{name}: {run['status']} {run.get('error') or ''}, {run.get('values', {}).get('picture.pixels_that_differ')} pixels differ")
        elif name != "ours" and run["stats"]["instructions"] == runs["ours"]["stats"]["instructions"]:
            failures.append(f"{name}: takes as many instructions as the program without a change")
    for failure in failures:
        print(f"FAILED: {failure}")
    return len(failures)


if __name__ == "__main__":
    sys.exit(1 if main() else 0)
