#!/usr/bin/env python3
"""Pictures by the reference and by the fast engine on the paper's chips: the same cycles, statistics and bytes.

    tests/render/chips.py SCENES_DIRECTORY                 four scenes at 160x90 on the fifteen chips
    tests/render/chips.py MESH --chips 1x32,8x64 --size 32x18

SCENES_DIRECTORY holds conference.ply.xz, crytek-sponza.ply.xz, dragon.ply.xz with dragon_box.obj, and sibenik.ply.xz
(also without .xz). Prints a row for each picture, with the million instructions that each engine simulated in a second
of the host. Exit status 0 if all are equal.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "timing"), str(HERE.parents[1] / "raytracer/evaluation")]
import engines  # noqa: E402
from trax_eval.scenes import mesh_files  # noqa: E402

CHIPS = "1x32 1x48 2x32 1x64 2x48 4x32 2x64 6x32 4x48 8x32 4x64 6x48 8x48 6x64 8x64".split()


def scenes_of(options, folder):
    """Import what the command line names; return names and arguments of trax-render."""
    if options.scenes.is_dir():
        chosen = [(name, mesh_files(options.scenes, name), ["--view", name]) for name in options.only.split(",")]
    else:
        chosen = [(options.scenes.stem, [str(options.scenes)], [])]
    made = []
    for name, files, view in chosen:
        scene = os.path.join(folder, name + ".trax")
        subprocess.run([os.path.join(options.bin, "trax-scene"), "--quiet", *files, "-o", scene], check=True)
        made.append((name, [scene, *view]))
    return made


def speed(one):
    return f"{one.statistics.get('instructions', 0) / max(one.host_seconds, 1e-9) / 1e6:.1f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scenes", type=pathlib.Path, metavar="SCENES_DIRECTORY|MESH")
    parser.add_argument("--bin", default=str(HERE.parents[1] / "build/bin"),
                        help="the folder of trax-render and trax-scene")
    parser.add_argument("--only", default="conference,crytek-sponza,dragon,sibenik",
                        help="scenes of the directory, with commas between")
    parser.add_argument("--chips", default=",".join(CHIPS), help="with commas between (default: all fifteen)")
    parser.add_argument("--size", default="160x90")
    parser.add_argument("--work", help="a folder that keeps scenes, pictures and statistics")
    options = parser.parse_args()
    options.bin = os.path.abspath(options.bin)
    options.scenes = options.scenes.resolve()

    begin, different, rows = time.monotonic(), 0, 0
    print("| scene | chip | cycles | instructions | reference, M/s | fast, M/s | ratio | equal |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as temporary:
        folder = os.path.abspath(options.work or temporary)
        os.makedirs(folder, exist_ok=True)
        for name, arguments in scenes_of(options, folder):
            for chip in options.chips.split(","):
                command = [os.path.join(options.bin, "trax-render"), *arguments, "--quiet", "--config", chip, "--size",
                           options.size, "-o",
                           "picture.png"]
                fast, reference = (engines.run(command, engine, os.path.join(folder, name, chip),
                                               ["picture.png"]) for engine in ("fast", "reference"))
                wrong = engines.difference(reference, fast) or engines.violation(reference)
                if not wrong and (reference.status != 0 or not reference.files):
                    wrong = f"exit status {reference.status}: {reference.errors.decode()[:200]}"
                rows += 1
                different += wrong is not None
                print(
                    f"| {name} | {chip} | {fast.statistics.get('cycles', 0):,} | "
                    f"{fast.statistics.get('instructions', 0):,} | {speed(reference)} | "
                    f"{speed(fast)} | {reference.host_seconds / max(fast.host_seconds, 1e-9):.1f} | "
                    f"{'NO: ' + wrong if wrong else 'yes'} |",
                    flush=True)
    print(f"{rows} pictures of {options.size}, {different} different; {time.monotonic() - begin:.0f} s")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
