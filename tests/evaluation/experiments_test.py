#!/usr/bin/env python3
"""Every program of raytracer/evaluation/experiments: its patches apply to the source as it is, it compiles and fits,
and renders the picture that it should.

    tests/evaluation/experiments_test.py --bin build/bin [--bunny]

The scene is a wavy ground of two materials with roofs above it, so that there are shadows; with --bunny also the
bunny."""

import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import checking  # noqa: E402
from checking import check  # noqa: E402

SIDE, ROOFS = 24, 5
WIDTH, HEIGHT = 96, 64
BUNNY = "/usr/share/glmark2/models/bunny.obj"
CACHE, STACK = 4096, 512  # bytes
# Other tests of triangles: some pixels may differ.
OTHER_TESTS = {"triangles-moller-trumbore", "triangles-fast-math", "triangles-moller-trumbore-fast-math"}
SMALL = ("triangles", "era")  # whose programs fit in the instruction cache


def write_scene(path):
    lines = ["mtllib waves.mtl"]
    for x in range(SIDE + 1):
        for z in range(SIDE + 1):
            lines.append(f"v {x} {math.sin(x * 0.7) + math.cos(z * 0.9) * 0.5:.6f} {z}")
    for x in range(SIDE):
        for z in range(SIDE):
            first = x * (SIDE + 1) + z + 1
            lines += [
                f"usemtl {'light' if (x + z) % 3 else 'dark'}",
                f"f {first} {first + 1} {first + SIDE + 2} {first + SIDE + 1}"
            ]
    for roof in range(ROOFS):
        corner = 4 * roof + 2
        lines += [f"v {corner + x} {5 + roof} {corner + z}"
                  for x, z in ((0, 0), (0, 3), (3, 3), (3, 0))] + ["f -4 -3 -2 -1"]
    path.write_text("\n".join(lines) + "\n")
    path.with_suffix(".mtl").write_text("newmtl light\nKd 0.8 0.7 0.6\nnewmtl dark\nKd 0.2 0.3 0.4\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--bunny", action="store_true")
    options = parser.parse_args()
    folder = options.bin.resolve()
    data = folder.parent / "lib/trax/evaluation"
    files = sorted((data / "experiments").glob("*/*.json"))
    folders = {json.loads(file.read_text())["name"]: file.parent.name for file in files}
    sweeps = {
        name for sweep in (data / "sweeps").glob("*.json")
        for name in json.dumps(json.loads(sweep.read_text())).split('"')
    }
    for file in files:
        check(
            f"{file.parent.name}/{file.stem}" in sweeps or
            any(name.endswith(f"{file.parent.name}/{file.name}") for name in sweeps), f"no sweep has {file}")
    with tempfile.TemporaryDirectory(dir=os.environ.get("TRAX_TEST_FOLDER")) as name:
        scratch = pathlib.Path(name)
        write_scene(scratch / "waves.obj")
        scenes = [{"name": "waves", "meshes": ["waves.obj"]}
                  ] + [{"name": "bunny", "meshes": [BUNNY], "view": "bunny"}] * options.bunny
        sweep = {
            "name": "all", "scenes": scenes, "chips": "1x32", "size": f"{WIDTH}x{HEIGHT}", "reference": "ours",
            "programs": ["ours", "era", *(f"{file.parent.name}/{file.stem}" for file in files)]
        }
        (scratch / "all.json").write_text(json.dumps(sweep))
        run = subprocess.run([folder / "trax-eval", "all.json", "-q", "-o", "out"], cwd=scratch, capture_output=True,
                             text=True)
        check(run.returncode == 0, f"trax-eval: {run.returncode}: {run.stderr}")
        runs = {(one["program"], one["scene"]): one
                for one in json.loads((scratch / "out/results.json").read_text())["runs"]}
        check(
            runs.keys() == {(name, scene) for name in ("ours", "era", *folders)
                            for scene in ("waves", "bunny")[:len(scenes)]}, f"the runs are {sorted(runs)}")
        seen = set()
        for (name, scene), one in runs.items():
            if one["status"] != "done":
                check(False, f"{name}: {one.get('error')}")
                continue
            values, group = one["values"], folders.get(name, "")
            job = json.loads((scratch / "out" / one["json"]).read_text())["job"]["inputs"]
            what = job["program"]["xxh128"], tuple(buffer.get("xxh128") for buffer in job["buffers"])
            check(what not in seen, f"{name}: the same program and inputs as another one's")
            seen.add(what)
            print(
                f"{name}, {scene}: {values['code.bytes']} bytes of code, {values['code.stack_bytes']} of stack, "
                f"{one['stats']['cycles']} cycles, {values['picture.pixels_that_differ']} pixels"
            )
            check(values["code.stack_bytes"] <= STACK, f"{name}: {values['code.stack_bytes']} bytes of stack")
            check(values["code.bytes"] <= CACHE or group not in SMALL, f"{name}: {values['code.bytes']} bytes of code")
            expected = runs["era" if group == "era" else "ours", scene]["picture"]
            same = one["picture"] == expected
            check(
                same or name == "era" or
                name in OTHER_TESTS and values["picture.pixels_that_differ"] <= WIDTH * HEIGHT // 100,
                f"{name}, {scene}: another picture")
    return 1 if checking.failures else 0


if __name__ == "__main__":
    sys.exit(main())
