#!/usr/bin/env python3
"""Refits the tree of a moving mesh on the TPs by refit.c, and compares it with trax-scene's in every byte.

    refit.py --bin build/bin 'wave-%03d.obj' --from 0 --at 20 --config 4x32

The scene is that of the moment --from, with the triangles of the moment --at in their places. Prints the cycles and
bytes of the run; exit status 1 if a box differs."""

import argparse
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

NODES, TRIANGLES = 0, 1  # sections of a scene file (raytracer/include/trax/scene_format.h)
SECTIONS, BOUNDS, NODE_BYTES = 64, slice(32, 56), 64


def section(scene, number):
    """The bytes of a section, as a slice."""
    offset, size, *_ = struct.unpack_from("<4I", scene, SECTIONS + 16 * number)
    return slice(offset, offset + size)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("--bin", required=True, type=pathlib.Path)
    parser.add_argument("--from", dest="base", default="0")
    parser.add_argument("--at", required=True)
    parser.add_argument("--config", default="4x32")
    options = parser.parse_args()
    here = pathlib.Path(__file__).parent
    include = next(path for path in (here.parent / "include", here.parents[1] / "include")
                   if (path / "trax" / "scene_format.h").exists())

    def run(program, *words):
        done = subprocess.run([options.bin / program, *words], capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"refit.py: {program}: {done.stderr.strip() or done.stdout.strip()}")
        return done.stdout

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        base, wanted, moved, found = (folder / f"{part}.trax" for part in ("base", "wanted", "moved", "found"))
        run("clang", "--target=trax", "-O2", f"-I{include}", f"-I{here.parent}", here / "refit.c", "-o",
            folder / "refit")
        tree = ["--nodes", "binary", "--quiet"]
        run("trax-scene", options.mesh, "--at", options.base, "--splits=1", *tree, "-o", base)
        run("trax-scene", options.mesh, "--at", options.at, "--refit", base, *tree, "-o", wanted)
        old, new = base.read_bytes(), wanted.read_bytes()
        if len(old) != len(new):
            sys.exit("refit.py: some triangles have an area at one of the moments only")
        scene = bytearray(old)
        scene[section(old, TRIANGLES)] = new[section(new, TRIANGLES)]
        moved.write_bytes(scene)
        words = len(old[section(old, NODES)]) // NODE_BYTES * 4
        print(run("trax-sim", folder / "refit", "--config", options.config, "--main-on", "0", "--quiet",
                  "--bind", f"scene={moved}", "--alloc", f"links={words}", "--alloc", f"arrived={words}",
                  "--dump", f"scene={found}", "--stats", folder / "stats.json"), end="")
        statistics = json.loads((folder / "stats.json").read_text())
        print(f"{statistics['memory']['bytes']} bytes of off-chip memory, {statistics['cycles']} cycles in all")
        result = found.read_bytes()
        same = all(result[part] == new[part] for part in (section(new, NODES), BOUNDS))
        print("the boxes are those of trax-scene" if same else "refit.py: the boxes differ from those of trax-scene")
        return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
