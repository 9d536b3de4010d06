#!/usr/bin/env python3
"""Measures the speed of the engines on the ray tracer: a row for each scene and chip.

    emulator/bench/speed.py SCENES_DIRECTORY [--scenes conference,dragon,sibenik] [--chips 4x32,8x64] [--size 320x180]
                            [--whole | --max-cycles 400000] [--repeats 3] [--bin build/bin]

SCENES_DIRECTORY holds the meshes of trax-eval's scenes. The columns are million simulated instructions per second of
wall time: of the reference engine, of the fast engine on one thread and on two, of the functional engine; then ratios.
Each repetition runs all engines, and the shortest time of an engine counts, since the host may be busy. The timed
engines run the first cycles of the picture, the functional engine the whole picture. With --whole, all engines run the
whole picture, without the reference, which takes some forty times as long. The first line names the host's processor:
processors differ by more than versions do. The exit status is 1 if the engines disagree on cycles or instructions.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "raytracer/evaluation"))
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
    """The manifest of the scene's picture, in scratch."""
    subprocess.run([options.bin / "trax-render", *files_of(options.scenes, scene), "--view", scene,
                    "--size", options.size, "--quiet", "--prepare", scratch], check=True)
    return pathlib.Path(scratch, "manifest.json")


ENGINES = {"reference": ("reference", 1), "fast": ("fast", 1), "2 threads": ("fast", 2),
           "functional": ("functional", 1)}


def run(options, chip, name, manifest):
    """(seconds, cycles, instructions) of a run of the engine with this name."""
    engine, threads = ENGINES[name]
    stats = manifest.with_name("stats.json")
    limit = [] if options.whole or name == "functional" else ["--max-cycles", str(options.max_cycles)]
    command = [options.bin / "trax-sim", "--quiet", "--engine", engine, "--host-threads", str(threads),
               "--config", chip, *limit, "--stats", stats, manifest]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0 and not (limit and done.returncode == 124):
        sys.exit(f"speed.py: error: trax-sim ended with status {done.returncode}: {done.stderr}")
    figures = json.loads(stats.read_text())
    return figures["host_seconds"], figures["cycles"], figures["instructions"]


def processor():
    """The host's processor as Linux names it, with family and model, since a name may be that of a whole family."""
    facts = {}
    for line in pathlib.Path("/proc/cpuinfo").read_text().split("\n\n")[0].splitlines():
        name, _, value = line.partition(":")
        facts[name.strip()] = value.strip()
    name, family, model = (facts.get(key, "?") for key in ("model name", "cpu family", "model"))
    return f"{name} (family {family}, model {model})"


def row(chip, scene, best):
    speed = {name: instructions / seconds / 1e6 for name, (seconds, _, instructions) in best.items()}
    cycles, instructions = best["fast"][1:]
    cells = [chip, scene, f"{cycles:,}", f"{instructions:,}",
             *(f"{speed[name]:.1f}" if name in speed else "-" for name in ENGINES),
             f"{speed['fast'] / speed['reference']:.1f}" if "reference" in speed else "-",
             f"{speed['fast'] / speed['functional']:.2f}", f"{speed['2 threads'] / speed['fast']:.2f}"]
    return f"| {' | '.join(cells)} |"


def main():
    parser = arguments(__doc__, "320x180")
    parser.add_argument("--scenes", dest="names", default="conference,dragon,sibenik")
    parser.add_argument("--chips", default="4x32,8x64")
    parser.add_argument("--max-cycles", type=int, default=400000)
    parser.add_argument("--whole", action="store_true")
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()

    names = [name for name in ENGINES if not (options.whole and name == "reference")]
    heads = ["chip", "scene", "cycles", "instructions", *ENGINES, "fast/reference", "fast/functional", "2 threads/1"]
    print(f"processor: {processor()}\n\n| {' | '.join(heads)} |\n|{' --- |' * len(heads)}")
    same = True
    for scene in options.names.split(","):
        with tempfile.TemporaryDirectory() as scratch:
            manifest = prepare(options, scene, scratch)
            for chip in options.chips.split(","):
                rounds = [{name: run(options, chip, name, manifest) for name in names} for _ in range(options.repeats)]
                best = {name: min(each[name] for each in rounds) for name in names}
                counts = {best[name][1:] for name in names if name != "functional"}
                same &= len(counts) == 1
                print(row(chip, scene, best) + ("" if len(counts) == 1 else " DIFFERENT"), flush=True)
    return not same


if __name__ == "__main__":
    sys.exit(main())
