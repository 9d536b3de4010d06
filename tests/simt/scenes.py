#!/usr/bin/env python3
"""Pictures with simt.width=1 on the simt engine and on the reference: the same bytes in statistics and pictures.

  scenes.py --bin build/bin [--scenes FOLDER] [--only REGEX] [--size 160x90] [--jobs N]
"""

import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, "..", "timing"), os.path.join(HERE, "..", "..", "raytracer", "evaluation")]
import engines  # noqa: E402
from trax_eval.scenes import mesh_files  # noqa: E402

SCENES = ["conference", "crytek-sponza", "dragon", "forest", "sibenik"]


def check(options, scene, folder):
    """What differs, in words; None if nothing does."""
    inputs = os.path.join(folder, scene)
    subprocess.run([os.path.join(options.bin, "trax-render"), *mesh_files(options.scenes, scene), "--view", scene,
                    "--size", options.size, "--config", "1x32", "--prepare", inputs, "--quiet"], check=True)
    command = [os.path.join(options.bin, "trax-sim"), "--dump", "image=picture", "--quiet",
               os.path.join(inputs, "manifest.json")]
    runs = [engines.run(command, engine, inputs, ["picture"], 24 * 3600) for engine in ("reference", "simt")]
    if not runs[1].files or runs[1].status:
        return f"there is no picture: {runs[1].errors.decode(errors='replace')[:300]}"
    return engines.difference(*runs) or engines.violation(runs[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--bin", required=True, type=os.path.abspath, help="the folder of the programs")
    parser.add_argument("--scenes", default=HERE, type=pathlib.Path, help="the folder of the scenes' meshes")
    parser.add_argument("--only", default="", help="scenes whose names match")
    parser.add_argument("--size", default="160x90", help="of the pictures (default %(default)s)")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    scenes = [scene for scene in SCENES if re.search(options.only, scene)]
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        found = []
        for scene, difference in zip(scenes, pool.map(lambda scene: check(options, scene, folder), scenes)):
            found.append(difference)
            print(f"{scene}: {difference or 'the same'}", flush=True)
    return any(found) or not found


if __name__ == "__main__":
    sys.exit(main())
