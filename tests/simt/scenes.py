#!/usr/bin/env python3
"""Pictures with simt.width=1 on the simt engine and on the reference: the same bytes in statistics and pictures.

  scenes.py --bin build/bin [--scenes FOLDER] [--only REGEX] [--size 160x90] [--jobs N]
"""

import argparse
import concurrent.futures
import os
import re
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "timing"))
import engines  # noqa: E402
import same_scenes  # noqa: E402

MACHINE = ["--config", "1x32"]


def check(options, scene, folder):
    """What differs, in words; None if nothing does."""
    inputs = os.path.join(folder, scene)
    same_scenes.prepare(options.bin, options.scenes, scene, "ours", options.size, inputs)
    command = [os.path.join(options.bin, "trax-sim"), *MACHINE, *same_scenes.program_options(inputs),
               "--dump", "image=picture", "--quiet", os.path.join(inputs, "program.elf")]
    runs = [engines.run(command, engine, inputs, ["picture"], 24 * 3600) for engine in ("reference", "simt")]
    if not runs[1].files or runs[1].status:
        return f"there is no picture: {runs[1].errors.decode(errors='replace')[:300]}"
    return engines.difference(*runs) or engines.violation(runs[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--bin", required=True, type=os.path.abspath, help="the folder of the programs")
    parser.add_argument("--scenes", default=HERE, type=os.path.abspath, help="the folder of the scenes' meshes")
    parser.add_argument("--only", default="", help="scenes whose names match")
    parser.add_argument("--size", default="160x90", help="of the pictures (default %(default)s)")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    scenes = [scene for scene in same_scenes.SCENES if re.search(options.only, scene)]
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        found = []
        for scene, difference in zip(scenes, pool.map(lambda scene: check(options, scene, folder), scenes)):
            found.append(difference)
            print(f"{scene}: {difference or 'the same'}", flush=True)
    return any(found) or not found


if __name__ == "__main__":
    sys.exit(main())
