#!/usr/bin/env python3
"""Which triangles the device program hits, against exact arithmetic and Embree: a table with a row for each scene.

    raytracer/evaluation/bench/hits.py SCENES_DIRECTORY [--size 1280x720] [--bin build/bin]

SCENES_DIRECTORY is lean.py's. Pixels count as tied where the error bound of the watertight test explains both answers
(raytracer/render/hits.h). Exit status 1 if there is a pixel that it does not explain.
"""

import os
import re
import subprocess
import sys
import tempfile

from scenes import SCENES, arguments, find

LINE = re.compile(r"^hits +(\d+) of (\d+) pixels hit the nearest triangle, (\d+) another within the error bound, (\d+) beyond it, "
                  r"of which (\d+) are holes.*\nEmbree +(\d+) ", re.M)


def main():
    options = arguments(__doc__, "1280x720").parse_args()

    scenes = [(name, [find(options.scenes, file) for file in files]) for name, files in SCENES]
    if (options.scenes / "CornellBox.obj").exists():
        scenes.append(("CornellBox", [str(options.scenes / "CornellBox.obj")]))
    unexplained = 0
    print("| scene | pixels | the nearest triangle | tied | beyond the bound | holes | Embree's triangle |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as scratch:
        for scene, files in scenes:
            run = subprocess.run([options.bin / "trax-render", *files, "--view", scene, "--size", options.size, "--engine", "native", "--compare",
                                  "-o", os.path.join(scratch, "picture.png")], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                 check=False)
            found = LINE.search(run.stdout)
            if not found:
                sys.exit(f"hits.py: error: {scene}: trax-render --compare has no line about hits\n{run.stderr}")
            same, pixels, tied, beyond, holes, embree = map(int, found.groups())
            unexplained += beyond
            print(f"| {scene} | {pixels:,} | {same:,} | {tied:,} | {beyond:,} | {holes:,} | {embree:,} |", flush=True)
    return 1 if unexplained else 0


if __name__ == "__main__":
    sys.exit(main())
