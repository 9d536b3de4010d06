#!/usr/bin/env python3
"""Our figures beside the paper's (Table 2, 4x32), a row for each scene: deviation and what it cost to know.

    raytracer/bench/paper.py SCENES_DIRECTORY [--size 320x180] [--config 4x32] [--render build/bin/trax-render]

SCENES_DIRECTORY holds conference.ply.xz, crytek-sponza.ply.xz, dragon.ply.xz with dragon_box.obj, and sibenik.ply.xz (also
without .xz). The paper rendered 1280x720; a smaller picture spends relatively more time on the tail, when threads run out of
pixels. Its ray tracer is not published, so the deviation is of hardware and program together.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

# Scene, its files, and the paper's million rays per second on the chips of Table 2 that are listed here.
SCENES = [
    ("conference", ["conference.ply"], {"1x32": 2.48, "2x32": 4.94, "4x32": 9.80, "8x32": 19.1, "8x64": 32.5}),
    ("crytek-sponza", ["crytek-sponza.ply"], {"1x32": 1.41, "2x32": 2.80, "4x32": 5.55, "8x32": 10.8, "8x64": 18.2}),
    ("dragon", ["dragon.ply", "dragon_box.obj"], {"1x32": 1.94, "2x32": 3.62, "4x32": 6.18, "8x32": 5.75, "8x64": 5.68}),
    ("sibenik", ["sibenik.ply"], {}),
    ("forest", ["generate:forest"], {}),  # stands in for the paper's fairy scene, which is not to be had
]


def find(directory, name):
    if name.startswith("generate:"):
        return name
    for candidate in (directory / name, directory / (name + ".xz")):
        if candidate.exists():
            return str(candidate)
    sys.exit(f"paper.py: error: {directory}: neither {name} nor {name}.xz is there")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scenes", type=pathlib.Path)
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--config", default="4x32")
    parser.add_argument("--render", default=str(pathlib.Path(__file__).resolve().parents[2] / "build/bin/trax-render"))
    options = parser.parse_args()

    print(f"{options.config}, {options.size}")
    print("| scene | cycles | rays | MRPS | paper's | deviation | FLOPs/ray | bytes/ray | GB/s | host s | million instr/s |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as scratch:
        for scene, files, paper in SCENES:
            report = pathlib.Path(scratch) / "stats.json"
            subprocess.run([options.render, *(find(options.scenes, name) for name in files), "--view", scene,
                            "--config", options.config, "--size", options.size, "--quiet", "--stats", str(report),
                            "-o", str(pathlib.Path(scratch) / "picture.png")], check=True)
            run = json.loads(report.read_text())
            published = paper.get(options.config)
            deviation = f"{run['mrps'] / published - 1:+.0%}" if published else "-"
            print(f"| {scene} | {run['cycles']:,} | {run['rays']:,} | {run['mrps']:.2f} | {published or '-'} | {deviation} | "
                  f"{run['flops'] / run['rays']:.0f} | {run['memory']['bytes'] / run['rays']:.0f} | "
                  f"{run['memory']['bandwidth_gbps']:.2f} | {run['host_seconds']:.1f} | "
                  f"{run['instructions_per_host_second'] / 1e6:.1f} |", flush=True)


if __name__ == "__main__":
    main()
