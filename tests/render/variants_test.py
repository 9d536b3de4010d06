#!/usr/bin/env python3
"""Every variant of raytracer/evaluation/bench/variants.py still applies to the device program, compiles, fits and renders the picture that it should.

    tests/render/variants_test.py BIN

The scene is a wavy ground of two materials with roofs above it, so that there are shadows."""

import math
import pathlib
import re
import subprocess
import sys
import tempfile

VARIANTS = pathlib.Path(__file__).resolve().parents[2] / "raytracer/evaluation/bench/variants.py"
SIDE, ROOFS = 24, 5
WIDTH, HEIGHT = 64, 36


def write_scene(path):
    lines = ["mtllib waves.mtl"]
    for x in range(SIDE + 1):
        for z in range(SIDE + 1):
            lines.append(f"v {x} {math.sin(x * 0.7) + math.cos(z * 0.9) * 0.5:.6f} {z}")
    for x in range(SIDE):
        for z in range(SIDE):
            first = x * (SIDE + 1) + z + 1
            lines += [f"usemtl {'light' if (x + z) % 3 else 'dark'}", f"f {first} {first + 1} {first + SIDE + 2} {first + SIDE + 1}"]
    for roof in range(ROOFS):
        corner = 4 * roof + 2
        lines += [f"v {corner + x} {5 + roof} {corner + z}" for x, z in ((0, 0), (0, 3), (3, 3), (3, 0))] + ["f -4 -3 -2 -1"]
    path.write_text("\n".join(lines) + "\n")
    path.with_suffix(".mtl").write_text("newmtl light\nKd 0.8 0.7 0.6\nnewmtl dark\nKd 0.2 0.3 0.4\n")


def run(*arguments):
    return subprocess.run([sys.executable, VARIANTS, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)


def main():
    programs, failures = sys.argv[1], []
    with tempfile.TemporaryDirectory() as name:
        mesh = pathlib.Path(name) / "waves.obj"
        write_scene(mesh)
        for group, variants in (("order", 13), ("triangles", 9)):
            result = run(mesh, group, "--size", f"{WIDTH}x{HEIGHT}", "--configs", "1x32", "--bin", programs)
            print(result.stdout, result.stderr)
            rows = re.findall(r"^\| mesh \| [^|]+ \| ([\d,]+) \| ([\d,]+) \| (\d+) \| [^|]+ \| [^|]+ \| [^|]+ \| (\d+) \|$", result.stdout, re.M)
            if result.returncode != 0 or len(rows) != variants:
                failures.append(f"{group}: exit status {result.returncode}, {len(rows)} rows instead of {variants}")
            failures += [f"{group}: {row}: beyond the cache or the stack" for row in rows if int(row[1].replace(",", "")) > 4096 or int(row[2]) > 512]
            failures += [f"{group}: {row}: another picture" for row in rows if int(row[3]) > WIDTH * HEIGHT // 100]
        refused = run(mesh, "order", "--only", "none such", "--bin", programs)
        if refused.returncode != 1 or "none such" not in refused.stderr:
            failures.append(f"--only with an unknown name: exit status {refused.returncode}")
    print("\n".join(failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
