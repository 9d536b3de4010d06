#!/usr/bin/env python3
"""Measures the gain of a profile: the ray tracer's general program with -fprofile-sample-use and without.

    llvm-target/bench/profiled.py --build build [--instrumented] SCENE...

--instrumented: with the counters of -fprofile-instr-generate and -fprofile-instr-use instead.

The profile is that of the first scene; each scene is then rendered by both programs on a chip of 4x32. SCENE is a mesh
or generate:NAME; its view has its name. Pictures must be the same in every bit.

Exit status: 0 if all programs ran, 1 if not.
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path

from machines import ROOT, Failure, run

DEVICE = ROOT / "raytracer/device/main.c"
FLAGS = ["-std=c17", "-O3", "-g", "-fdebug-info-for-profiling", "-DTRAX_TREE_DEPTH=TRAX_SCENE_DEFAULT_DEPTH",
         f"-I{ROOT / 'raytracer/include'}", f"-I{ROOT / 'raytracer'}"]


def build(options, output, *flags):
    run([options.build / "bin/clang", "--target=trax", *FLAGS, *flags, DEVICE, "-o", output])
    return output


def render(options, scene, program, work, *more):
    """(cycles, instructions, picture)"""
    view = scene.rpartition(":")[2].rpartition("/")[2].partition(".")[0]
    folder = work / f"{view}-{program.stem}"
    if not folder.exists():
        run([options.build / "bin/trax-render", scene, "--view", view, "--size", options.size, "--program", program,
             "--quiet", "--prepare", folder])
    run([options.build / "bin/trax-sim", folder / "manifest.json", "--config", "4x32", "--quiet", "--stats",
         folder / "stats.json",
         "--dump", f"image={folder / 'image'}", *more])
    statistics = json.loads((folder / "stats.json").read_text())
    return view, statistics["cycles"], statistics["instructions"], (folder / "image").read_bytes()


def profile_use(options, plain, work):
    """The option of the compiler that reads a profile of the first scene."""
    if not options.instrumented:
        render(options, options.scenes[0], plain, work, "--profile-sample", work / "samples")
        return f"-fprofile-sample-use={work / 'samples'}"
    counting = build(options, work / "counting.elf", "-mstack=global", "-DEND_THREAD()=exit(0)", "-include", "stdlib.h",
                     "-fprofile-instr-generate=out/main.profraw")
    render(options, options.scenes[0], counting, work, "--engine", "functional", "--dir", f"{work}::out")
    run(["llvm-profdata-19", "merge", work / "main.profraw", "-o", work / "main.profdata"])
    return f"-fprofile-instr-use={work / 'main.profdata'}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    parser.add_argument("--build", type=Path, required=True, help="the build folder")
    parser.add_argument("--size", default="160x90", help="of the pictures (default: 160x90)")
    parser.add_argument("--instrumented", action="store_true", help="count in the program, and not by the emulator")
    options = parser.parse_args()
    options.build = options.build.resolve()
    try:
        with tempfile.TemporaryDirectory() as scratch:
            work = Path(scratch)
            plain = build(options, work / "plain.elf")
            profiled = build(options, work / "profiled.elf", profile_use(options, plain, work))
            print(
                f"{'4x32, ' + options.size:16} {'cycles':>10} {'profiled':>10} {'ratio':>6} {'instructions':>12} "
                f"{'profiled':>10} {'ratio':>6}"
            )
            for scene in options.scenes:
                view, cycles, instructions, picture = render(options, scene, plain, work)
                _, cycles2, instructions2, picture2 = render(options, scene, profiled, work)
                if picture != picture2:
                    raise Failure(f"{scene}: the pictures differ")
                print(
                    f"{view:16} {cycles:10} {cycles2:10} {cycles2 / cycles:6.3f} {instructions:12} {instructions2:10} "
                    f"{instructions2 / instructions:6.3f}"
                )
    except Failure as failure:
        print(f"profiled.py: error: {failure}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
