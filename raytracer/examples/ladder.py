#!/usr/bin/env python3
"""The steps from the plain program to the tuned one: a table of what each takes, on the same scene and with the same
picture.

    raytracer/examples/ladder.py MESH... [--view VIEW] [--size 320x180] [--config 4x32] [--set KEY=VALUE] [--figure
    FILE.svg] [--bin build/bin]

The steps are the C files in this folder, in the order of their numbers. Behind them stands the device program, which
trax-render compiles for one picture: with the same tree, and with the tree that trax-scene makes unless told otherwise.
The last rows are a step for another machine, whose comment names its key, and other schedules of a step's rays, whose
comments name that step. Exit status 1 if the first step's picture is not Embree's in 99 % of the pixels, if a step's is
not that of the step before or the step named in every bit, or if a step takes more cycles than the step before. Another
schedule may take more."""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
TREE = ["--splits=1", "--passes", "0"]  # the tree as the builder leaves it, as for the plain program

# The figure's parts of a run: a colour, a name, and causes of docs/trax-sim.md, together where the same hardware is
# behind them.
PARTS = [
    ("#4e79a7", "instructions", ["issued"]),
    ("#f28e2b", "adders and multipliers busy", ["fp_add_conflict", "fp_mul_conflict", "int_mul_conflict"]),
    ("#e15759", "off-chip memory", ["wait_memory", "memory_queue_full"]),
    ("#76b7b2", "data-cache banks and hits", ["dcache_bank_conflict", "wait_dcache_hit", "wait_local"]),
    ("#edc948", "instruction fetch", ["icache_bank_conflict", "icache_miss"]),
    ("#bab0ac", "everything else", None),
]
MACHINE = re.compile(r"needs (\w+\.\w+=\w+)")  # what a step's comment says of the machine
SCHEDULE = re.compile(r"is compared with step (\d+)")
LEFT, BAR, GAP, WIDTH = 150, 22, 10, 560  # of the figure, in pixels


def run(*command):
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        sys.exit(f"ladder.py: error: {pathlib.Path(command[0]).name} ended with status {done.returncode}")
    return done.stdout


class Ladder:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.bin = options.bin.resolve()
        self.view = [] if options.view is None else ["--view", options.view]

    def scene(self, name, *options):
        path = self.folder / f"{name}.trax"
        run(self.bin / "trax-scene", "--quiet", *options, *self.options.meshes, "-o", path)
        return path

    def compile(self, source):
        """With a queue for each TM: a chip's name begins with their number."""
        tms = re.match(r"(\d+)x", self.options.config)
        program = self.folder / f"{source.stem}.elf"
        run(self.bin / "clang", "--target=trax", "-std=c17", "-O3", "-Wall", "-Wextra", "-Werror",
            f"-DQUEUES={tms[1] if tms else 1}",
            "-I", HERE.parent / "include", "-I", HERE.parent, source, "-o", program)
        return program

    def render(self, name, scene, *options):
        """The picture and what trax-sim counts."""
        picture, statistics = self.folder / f"{name}.png", self.folder / f"{name}.json"
        settings = [part for setting in self.options.set for part in ("--set", setting)]
        run(self.bin / "trax-render", "--quiet", scene, *self.view, "--size", self.options.size, "--config",
            self.options.config, *settings, *options,
            "--stats", statistics, "-o", picture)
        return picture, json.loads(statistics.read_text())

    def embree(self, scene):
        picture = self.folder / "embree.png"
        run(self.bin / "trax-render", "--quiet", scene, *self.view, "--size", self.options.size, "--engine", "embree",
            "-o", picture)
        return picture

    def differing(self, one, other, within):
        """The number of pixels that differ by more than `within`, and the share of the others, in per cent."""
        output = subprocess.run([self.bin / "trax-compare", one, other, "--within", str(within), "--at-least", "0"],
                                stdout=subprocess.PIPE, text=True,
                                check=True).stdout
        share, _, differ = re.match(r"([\d.]+) % of (\d+) pixels within \d+/255, (\d+) differ", output).groups()
        return int(differ), float(share)


def figure(config, size, found):
    """Cycles as bars, one below the other, each divided by what the threads did in them: SVG."""
    longest = max(statistics["cycles"] for _, statistics in found)
    height = 60 + len(found) * (BAR + GAP)
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + 90}" height="{height}" '
        f'font-family="sans-serif" font-size="12">',
        '<rect width="100%" height="100%" fill="#ffffff"/>']
    for place, (colour, name, _) in enumerate(PARTS):
        x, y = 10 + place % 3 * 260, 8 + place // 3 * 18
        lines.append(
            f'<rect x="{x}" y="{y}" width="12" height="12" fill="{colour}"/><text x="{x + 18}" '
            f'y="{y + 10}">{name}</text>'
        )
    for row, (step, statistics) in enumerate(found):
        x, y, rest = LEFT, 52 + row * (BAR + GAP), statistics["thread_cycles"]
        lines.append(f'<text x="{LEFT - 8}" y="{y + 15}" text-anchor="end">{step}</text>')
        for colour, name, causes in PARTS:
            amount = sum(statistics["causes"][cause] for cause in causes) if causes else rest
            rest -= amount
            width = WIDTH * amount / statistics["threads"] / longest
            lines.append(
                f'<rect x="{x:.1f}" y="{y}" width="{width:.1f}" height="{BAR}" fill="{colour}"><title>{step}, {name}: '
                f'{100 * amount / statistics["thread_cycles"]:.1f} %</title></rect>')
            x += width
        lines.append(f'<text x="{x + 6:.1f}" y="{y + 15}">{statistics["cycles"] / 1e6:.2f} M cycles</text>')
    return "\n".join([*lines, f"<!-- {config}, {size} -->", "</svg>", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("meshes", metavar="MESH", nargs="+")
    parser.add_argument("--view")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--config", default="4x32")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a setting of the machine")
    parser.add_argument("--figure", type=pathlib.Path, help="cycles by cause, as SVG")
    parser.add_argument("--bin", type=pathlib.Path, default=HERE.parents[1] / "build/bin")
    options = parser.parse_args()
    wrong, all_found, before, picture_before, done = [], [], None, None, {}
    with tempfile.TemporaryDirectory() as name:
        ladder = Ladder(options, pathlib.Path(name))
        binary, quantised = (ladder.scene(nodes, "--nodes", nodes, *TREE) for nodes in ("binary", "quantised"))
        steps = sorted(HERE.glob("[0-9]*.c"), key=lambda path: int(path.name.split("-")[0]))
        rows = [(source.stem, "plain_scene.h" in (text := source.read_text()), source,
                 MACHINE.findall(text), SCHEDULE.findall(text)) for source in steps]
        rows += [("device, the same tree", False, None, [], []), ("device, its own tree", False, None, [], [])]
        rows.sort(key=lambda row: len(row[3]) + 2 * len(row[4]))
        print(
            "| step | cycles | change | instructions/ray | bytes from and to memory | bytes/ray | MRPS | pixels that "
            "differ from the step before |\n| --- |"
            + " --- |" * 7, flush=True)
        for step, plain, source, machine, schedule in rows:
            if machine or schedule:
                before, picture_before = done[schedule[0] if schedule else str(int(step.split("-")[0]) - 1)]
            if source:
                settings = [part for setting in machine for part in ("--set", setting)]
                picture, found = ladder.render(step, binary if plain else quantised, *settings, "--program",
                                               ladder.compile(source))
            else:
                scene = quantised if "same" in step else ladder.scene("own", "--nodes", "auto")
                picture, found = ladder.render(step, scene, "--cache", ladder.folder / "cache")
            change, differ = "", ""
            if before:
                change = f"{100 * (found['cycles'] / before['cycles'] - 1):+.1f} %"
                differ, _ = ladder.differing(picture, picture_before, 0)
                if source and differ:
                    wrong.append(f"{step}: {differ} pixels are not those of the step before")
                if source and not schedule and found["cycles"] > before["cycles"]:
                    wrong.append(f"{step}: {found['cycles']:,} cycles instead of {before['cycles']:,}")
            else:
                _, share = ladder.differing(picture, ladder.embree(binary), 2)
                if share < 99:
                    wrong.append(f"{step}: only {share} % of the pixels are Embree's")
            print(
                f"| {step} | {found['cycles']:,} | {change} | {found['instructions'] / found['rays']:,.0f} | "
                f"{found['memory']['bytes']:,} | "
                f"{found['memory']['bytes'] / found['rays']:.0f} | {found['mrps']:.2f} | {differ} |", flush=True)
            before, picture_before = found, picture
            if source:
                done[step.split("-")[0]] = found, picture
            all_found.append((step, found))
    if options.figure:
        options.figure.write_text(figure(options.config, options.size, all_found))
    for line in wrong:
        print(f"ladder.py: {line}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
