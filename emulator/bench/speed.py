#!/usr/bin/env python3
"""Measures the speed of the engines on the ray tracer: a row for each scene and chip.

    emulator/bench/speed.py SCENES_DIRECTORY [--scenes conference,dragon,sibenik] [--chips 4x32,8x64] [--size 320x180]
                            [--whole | --max-cycles 400000] [--repeats 3] [--bin build/bin]

SCENES_DIRECTORY holds the meshes of trax-eval's scenes. The rows are those of engine-bench (emulator/bench/engines.c):
million simulated instructions per second of wall time for each engine, and ratios. The timed engines run the first
cycles of the picture, the functional engine the whole picture. With --whole, all engines run the whole picture, without
the reference. The first line names the host's processor: processors differ by more than versions do.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "raytracer/evaluation"))
from trax_eval.manifest import read_manifest  # noqa: E402
from trax_eval.scenes import mesh_files  # noqa: E402
from trax_eval.util import Problem  # noqa: E402


def arguments(description, size):
    """A parser of what each measurement takes; size is the default."""
    parser = argparse.ArgumentParser(description=description.split("\n")[0])
    parser.add_argument("scenes", metavar="SCENES_DIRECTORY", type=pathlib.Path)
    parser.add_argument("--size", default=size)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/bin")
    return parser


def files_of(directory, scene):
    """The meshes of the scene of this name."""
    try:
        return mesh_files(directory, scene)
    except Problem as problem:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: error: {problem}")


def prepare(options, scene, scratch):
    """The executable of the scene's picture and its buffers, in scratch, as engine-bench takes them."""
    subprocess.run([options.bin / "trax-render", *files_of(options.scenes, scene), "--view", scene, "--size",
                    options.size, "--quiet", "--prepare", scratch],
                   check=True)
    manifest = read_manifest(scratch)
    return [
        manifest["program"]["file"],
        *(f"{buffer['symbol']}={buffer['file']}" if "file" in buffer else f"{buffer['symbol']}:{buffer['bytes']}"
          for buffer in manifest["buffers"])]


def processor():
    """The host's processor, as Linux names it, with its family and model, since names may be those of a whole
    family."""
    facts = {}
    for line in pathlib.Path("/proc/cpuinfo").read_text().split("\n\n")[0].splitlines():
        name, _, value = line.partition(":")
        facts[name.strip()] = value.strip()
    return (f"{facts.get('model name', 'unknown')} (family {facts.get('cpu family', '?')}, model "
            f"{facts.get('model', '?')})")


def main():
    parser = arguments(__doc__, "320x180")
    parser.add_argument("--scenes", dest="names", default="conference,dragon,sibenik")
    parser.add_argument("--chips", default="4x32,8x64")
    parser.add_argument("--max-cycles", default="400000")
    parser.add_argument("--whole", action="store_true")
    parser.add_argument("--repeats", default="3")
    options = parser.parse_args()

    print(f"processor: {processor()}")
    header = True
    for scene in options.names.split(","):
        with tempfile.TemporaryDirectory() as scratch:
            arguments_of_program = prepare(options, scene, scratch)
            how_far = ["--no-reference"] if options.whole else ["--max-cycles", options.max_cycles]
            run = subprocess.run([(options.bin / "../tests/bin/engine-bench").resolve(), "--chips", options.chips,
                                  *how_far,
                                  "--repeats", options.repeats, *arguments_of_program],
                                 cwd=scratch, text=True, stdout=subprocess.PIPE)
        rows = run.stdout.splitlines()
        if header and rows:
            print(rows[0].replace("case      ", "scene         "))
            header = False
        for row in rows[1:]:
            print(row.replace("program   ", f"{scene:14}"), flush=True)
        if run.returncode:
            sys.exit(f"speed.py: error: engine-bench ended with status {run.returncode}")


if __name__ == "__main__":
    main()
