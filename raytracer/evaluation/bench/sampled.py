#!/usr/bin/env python3
"""What sampled simulation of a picture costs and how far off it is, beside exact runs and the simpler ways to be quick.

    raytracer/evaluation/bench/sampled.py SCENES_DIRECTORY [--chips 4x32,8x64] [--scenes conference,dragon] [--size 1280x720] [--seeds 1]
                               [--exact DIRECTORY] [--bin build/bin] [--fractions 0.05]

SCENES_DIRECTORY is lean.py's, or holds NAME.trax. For each scene and chip a row for the exact run, for
trax-render --sampled of each fraction and seed, for the prediction alone, and for a picture of a quarter of the width and height
whose cycles are scaled by the number of pixels. Times are of the host's processor, for one thread, without reading the scene; ratios are of one run of this program, so that other
work on the host counts for both. --exact keeps the statistics of exact runs for the next time, under names of all that decides
them, with their time. The last line counts the intervals that hold the exact cycles.
"""

import hashlib
import json
import pathlib
import resource
import subprocess
import tempfile

from scenes import arguments, files_of


def scene_file(options, name, scratch):
    built = options.scenes / f"{name}.trax"
    if built.exists():
        return built
    path = scratch / f"{name}.trax"
    subprocess.run([options.bin / "trax-scene", "--quiet", *files_of(options.scenes, name), "-o", path], check=True)
    return path


def timed(command):
    """Runs it; seconds of the processor."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


class Case:
    def __init__(self, options, scratch, scene, chip, size):
        self.options, self.scratch = options, scratch
        self.command = [options.bin / "trax-render", scene, "--view", scene.stem, "--config", chip, "--size", size, "--threads", "1", "--quiet"]
        self.identity = "|".join([str(word) for word in self.command[2:]] + [hashlib.sha256(path.read_bytes()).hexdigest() for path in
                                 (scene, options.bin / "trax-render", options.bin / "clang")])
        self.overhead = timed([*self.command, "--prepare", scratch / "inputs"])  # reading, compiling, loading

    def run(self, *more):
        """(statistics, seconds)"""
        stats = self.scratch / "stats.json"
        seconds = timed([*self.command, *more, "--stats", stats, "-o", self.scratch / "picture.png"])
        return json.loads(stats.read_text()), max(seconds - self.overhead, 0.001)

    def exact(self):
        kept = self.options.exact and self.options.exact / (hashlib.sha256(self.identity.encode()).hexdigest()[:32] + ".json")
        if kept and kept.exists():
            found = json.loads(kept.read_text())
            return found["cycles"], found["seconds"]
        statistics, seconds = self.run()
        if kept:
            kept.parent.mkdir(parents=True, exist_ok=True)
            kept.write_text(json.dumps({"cycles": statistics["cycles"], "seconds": seconds}))
        return statistics["cycles"], seconds


def main():
    parser = arguments(__doc__, "1280x720")
    parser.add_argument("--chips", default="4x32,8x64")
    parser.add_argument("--scenes", dest="names", default="conference,crytek-sponza,dragon,forest")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--fractions", default="0.05")
    parser.add_argument("--warm-ups", default="", help="slots before a range, a row for each; default: what trax-render takes")
    parser.add_argument("--exact", type=pathlib.Path)
    options = parser.parse_args()

    counts = {}
    print("| scene, chip | how | host s | speed-up | cycles | error % | interval % | holds | slots % |")
    print("| --- |" + " --- |" * 8)
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        width, height = map(int, options.size.split("x"))
        for scene_name in options.names.split(","):
            scene = scene_file(options, scene_name, scratch)
            for chip in options.chips.split(","):
                case = Case(options, scratch, scene, chip, options.size)
                truth, exact_seconds = case.exact()

                def row(how, seconds, cycles, sampled=None):
                    cells = [f"{scene_name}, {chip}", how, f"{seconds:.2f}" if seconds else "-", f"{exact_seconds / seconds:.1f}" if seconds else "-",
                             f"{cycles:,.0f}", f"{100 * (cycles / truth - 1):+.2f}"]
                    low, high = (sampled["cycles_low"], sampled["cycles_high"]) if sampled else (None, None)
                    if low is not None:
                        holds = low <= truth <= high
                        hit, all_ = counts.get(how, (0, 0))
                        counts[how] = (hit + holds, all_ + 1)
                        cells += [f"{100 * (low / truth - 1):+.1f} ... {100 * (high / truth - 1):+.1f}", "yes" if holds else "no",
                                  f"{100 * sampled['detailed_slots'] / sampled['slots']:.1f}"]
                    else:
                        cells += ["", "", ""]
                    print("| " + " | ".join(cells) + " |", flush=True)

                row("exact", exact_seconds, truth)
                for fraction in options.fractions.split(","):
                    for warm_up in options.warm_ups.split(","):
                        how, mean = f"sampled {fraction}" + (f", warm-up {warm_up}" if warm_up else ""), 0
                        for seed in range(1, options.seeds + 1):
                            words = ["--sampled", "--sample-fraction", fraction, "--sample-seed", str(seed)]
                            statistics, seconds = case.run(*words, *(["--sample-warm-up", warm_up] if warm_up else []))
                            row(how, seconds, statistics["cycles"], statistics["sampled"])
                            mean += 100 * (statistics["cycles"] / truth - 1) / options.seeds
                        if options.seeds > 1:
                            print(f"| {scene_name}, {chip} | {how}, mean of {options.seeds} | | | | {mean:+.2f} | | | |", flush=True)
                row("prediction alone", None, statistics["sampled"]["predicted_cycles"])
                small = Case(options, scratch, scene, chip, f"{width // 4}x{height // 4}")
                statistics, seconds = small.run()
                row("a sixteenth of the pixels", seconds, statistics["cycles"] * width * height / (width // 4 * (height // 4)))
    for how, (hit, all_) in counts.items():
        print(f"{how}: {hit} of {all_} intervals hold the exact cycles")


if __name__ == "__main__":
    main()
