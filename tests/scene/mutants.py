#!/usr/bin/env python3
"""Breaks the choice of splits and the improvement of trees, one line at a time, and says whether the tests notice.

    mutants.py SCRATCH [--build build] [--only NAME]
    mutants.py --stale             only lists texts that are not there

Needs a finished build, which is not changed. Exit status 0 if every mutant is noticed.
"""

import argparse
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "render"))
from mutation import ROOT, command, list_stale  # noqa: E402

SOURCE = ROOT / "raytracer/scene"
TESTS = ("scene-scene-test", "scene-layout-test")

# Name, file of raytracer/scene, text, what it becomes.
MUTANTS = [
    ("splits-of-duplicates", "splits.c", "    if (duplicates->first[i] != i)\n      continue;\n", ""),
    ("splits-of-lamps", "splits.c", "if (emits(mesh, &mesh->triangles[i]))\n      return false;", ""),
    ("splits-never", "splits.c", "#define BOXES_IN_VAIN 2", "#define BOXES_IN_VAIN 1000000"),
    ("splits-always", "splits.c", "#define BOXES_IN_VAIN 2", "#define BOXES_IN_VAIN 0"),
    ("splits-whole-box", "splits.c", "in_vain -= fabs(", "in_vain -= 0 * fabs("),
    ("one-focus", "reinsert.c", "MOST_FOCI = 8", "MOST_FOCI = 1"),
    ("close-foci", "reinsert.c", "FOCUS_STEP = 4", "FOCUS_STEP = 2"),
    ("foci-of-few", "reinsert.c", "LEAST_OF_TRIANGLES = 16", "LEAST_OF_TRIANGLES = 2"),
    ("smaller-child", "reinsert.c", "b->triangles > a->triangles ? b : a", "b->triangles > a->triangles ? a : b"),
    ("focus-weight", "reinsert.c", "(struct focus){node->box, 1 / area}", "(struct focus){node->box, 1}"),
    ("short-search", "reinsert.c", "MOST_LOOKED_AT = 1000", "MOST_LOOKED_AT = 10"),
    ("stale-boxes", "reinsert.c", "  refit(nodes, nodes[beside].parent);\n", ""),
    ("too-deep", "reinsert.c", " && place.depth + 1 + height <= links->max_depth", ""),
    ("order-of-parts", "reinsert.c", "left->visits > right->visits ? -1 : 1", "left->visits > right->visits ? 1 : -1"),
    ("one-pass", "reinsert.c", "pass < passes && result", "pass < 1 && result"),
]


def noticed(folder, build, file, text):
    """The tests that fail with this text in the place of the file."""
    folder.mkdir(parents=True, exist_ok=True)
    source, made = folder / file, folder / f"{file}.o"
    source.write_text(text)
    words = command(build, f"raytracer/scene/CMakeFiles/traxscene.dir/{file}.o")
    words[words.index(str(SOURCE / file))] = source
    words[words.index("-MF") + 1] = "/dev/null"
    words[words.index("-o") + 1] = made
    subprocess.run([*words, f"-I{SOURCE}", "-w"], check=True, cwd=build)
    failed = []
    for test in TESTS:
        link = command(build, f"tests/bin/{test}")
        link[link.index("-o") + 1] = folder / test
        at = next(i for i, word in enumerate(link) if str(word).endswith(".a"))
        subprocess.run([*link[:at], made, *link[at:]], check=True, cwd=build)
        try:
            done = subprocess.run([folder / test], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=300)
            failed += [test] if done.returncode else []
        except subprocess.TimeoutExpired:
            failed.append(f"{test} does not end")
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scratch", type=pathlib.Path, nargs="?")
    parser.add_argument("--stale", action="store_true", help="only lists mutants of texts that are not there")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--only", help="the mutant of this name")
    options = parser.parse_args()
    if options.stale:
        return list_stale(MUTANTS, SOURCE)
    if options.scratch is None:
        parser.error("SCRATCH is missing")
    scratch, build = options.scratch.resolve(), options.build.resolve()
    for file in ("splits.c", "reinsert.c"):
        if failed := noticed(scratch / "unchanged", build, file, (SOURCE / file).read_text()):
            sys.exit(f"mutants.py: error: without a mutant: {', '.join(failed)}")
    missed = 0
    for name, file, text, other in MUTANTS:
        if options.only in (None, name):
            failed = noticed(scratch / name, build, file, (SOURCE / file).read_text().replace(text, other))
            missed += not failed
            print(f"{name}: {', '.join(failed) or 'NOT NOTICED'}", flush=True)
    return missed > 0


if __name__ == "__main__":
    sys.exit(main())
