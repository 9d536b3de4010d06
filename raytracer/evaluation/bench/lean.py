#!/usr/bin/env python3
"""What it brings to compile the device program for one picture: a table of both programs, a row for each scene.

    raytracer/evaluation/bench/lean.py SCENES_DIRECTORY [--size 320x180] [--config 4x32] [--bin build/bin]

SCENES_DIRECTORY holds conference.ply.xz, crytek-sponza.ply.xz, dragon.ply.xz with dragon_box.obj, and sibenik.ply.xz (also
without .xz). Every cell has the general program's figure and the specialised one's. Exit status 1 if a picture is not the same bit for bit.
"""

import pathlib
import subprocess
import sys
import tempfile

from scenes import SCENES, arguments, find

ROWS = ["bytes of code", "bytes of stack", "bytes of scene", "instructions run", "cycles", "bytes from and to memory"]


def figures(output):
    """The rows of trax-render --report: name -> (general, specialised)."""
    found = {}
    for line in output.splitlines():
        for row in ROWS:
            if line.startswith(row + " "):
                general, specialised = line[len(row):].split()[:2]
                found[row] = (int(general), int(specialised))
    missing = [row for row in ROWS if row not in found]
    if missing:
        sys.exit(f"lean.py: error: trax-render --report has no line '{missing[0]}'")
    return found


def main():
    parser = arguments(__doc__, "320x180")
    parser.add_argument("--config", default="4x32")
    options = parser.parse_args()

    different = 0
    print(f"{options.config}, {options.size}")
    print("| scene | " + " | ".join(ROWS) + " | change of cycles |")
    print("| --- |" + " --- |" * (len(ROWS) + 1))
    scenes = [(name, [find(options.scenes, file) for file in files]) for name, files in SCENES]
    with tempfile.TemporaryDirectory() as scratch:
        for scene, files in scenes:
            run = subprocess.run([options.bin / "trax-render", *files, "--view", scene, "--config", options.config, "--size", options.size, "--report",
                                  "--cache", scratch, "-o", str(pathlib.Path(scratch) / "picture.png")], stdout=subprocess.PIPE, text=True,
                                 check=False)
            if run.returncode not in (0, 1) or not run.stdout:
                return 1
            different += run.returncode
            found = figures(run.stdout)
            cells = [f"{found[row][0]:,} to {found[row][1]:,}" for row in ROWS]
            cycles = found["cycles"]
            print(f"| {scene} | {' | '.join(cells)} | {100 * (cycles[1] / cycles[0] - 1):+.1f} % |", flush=True)
    print(f"{len(scenes)} scenes, pictures {'different: ' + str(different) if different else 'identical in every bit'}")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
