#!/usr/bin/env python3
"""How scenes are stored against how fast they are traversed: a table with a row for each way and scene.

    raytracer/evaluation/bench/traversal.py SCENES_DIRECTORY [--size 320x180] [--configs 4x32,8x64] [--only WAY;...] [--scene NAME]
                                 [--choices | --stacks 2,4,8,12,16,62] [--bin build/bin]

SCENES_DIRECTORY is lean.py's. Every way renders the same picture, which is checked. For each chip: million rays a second, bytes
from and to memory a ray, instructions a ray; before, bytes of the
program's code and stack on the last chip. With --choices: one choice of the builder's at a time, and the cycles as parts of those of the default.
With --stacks: how many entries the traversal's stack has, instead of how scenes are stored.
"""

import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

from lean import figures
from scenes import SCENES, arguments, find

# Name, options of trax-scene, options of trax-render.
WAYS = [
    ("binary", ["--nodes", "binary", "--splits=1"], []),
    ("quantised", ["--nodes", "quantised", "--splits=1"], []),
    ("quantised8", ["--nodes", "quantised8"], []),
    ("wide", ["--nodes", "wide"], []),
    ("wide-quantised", ["--nodes", "wide-quantised"], []),
    ("wide-quantised8", ["--nodes", "wide-quantised8"], []),
    ("binary, splits", ["--nodes", "binary", "--splits"], []),
    ("quantised, splits", ["--nodes", "quantised", "--splits"], []),
    ("quantised, splits 3", ["--nodes", "quantised", "--splits=3"], []),
    ("leaves of 1", ["--nodes", "quantised", "--splits=1", "--leaf", "1"], []),
    ("leaves of 2", ["--nodes", "quantised", "--splits=1", "--leaf", "2"], []),
    ("leaves of 7", ["--nodes", "quantised", "--splits=1", "--leaf", "7"], []),
    ("node costs 1/2 triangle", ["--nodes", "quantised", "--splits=1", "--traversal-cost", "0.5"], []),
    ("node costs 2 triangles", ["--nodes", "quantised", "--splits=1", "--traversal-cost", "2"], []),
    ("depth first", ["--nodes", "quantised", "--splits=1", "--cache-lines", "1"], []),
    ("by itself", [], []),
    ("by itself, one queue", [], ["--queues", "1"]),
]

# What differs from the default, and the options of trax-scene for it.
CHOICES = [
    ("default", []),
    *[(f"leaves of at most {count}", ["--leaf", str(count)]) for count in (1, 2, 3, 5, 7)],
    *[(f"a node costs {cost} triangles", ["--traversal-cost", cost]) for cost in ("0.5", "1.5", "2", "4")],
    ("no triangle split", ["--splits=1"]),
    ("room for 3 times the triangles", ["--splits=3"]),
    ("nodes depth first", ["--cache-lines", "1"]),
    *[(f"tree improved, {count} pass{'es' if count != 1 else ''}", ["--passes", str(count)]) for count in (0, 1, 4, 8)],
]


def choices(options, configs):
    """A row for each choice of CHOICES: cycles in parts of the default's, for each scene and chip, and their geometric mean. How many pictures differ."""
    chosen = [choice for choice in CHOICES if not options.only or choice[0] in options.only.split(";") or choice[0] == "default"]
    scenes = [(name, files) for name, files in SCENES if not options.scene or name == options.scene]
    cycles, pictures = {}, {}
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        for scene, files in scenes:
            for choice, how in chosen:
                stored = scratch / "scene.trax"
                subprocess.run([options.bin / "trax-scene", "--quiet", *[find(options.scenes, file) for file in files], "-o", stored, *how], check=True)
                for config in configs:
                    subprocess.run([options.bin / "trax-render", stored, "--view", scene, "--config", config, "--size", options.size, "--quiet",
                                    "--cache", scratch / "cache", "--stats", scratch / "stats.json", "-o", scratch / "picture.png"], check=True)
                    cycles[choice, scene, config] = json.loads((scratch / "stats.json").read_text())["cycles"]
                    pictures.setdefault(scene, set()).add((scratch / "picture.png").read_bytes())
                print(f"{scene}: {choice}: " + ", ".join(f"{cycles[choice, scene, config]:,}" for config in configs), file=sys.stderr, flush=True)
    print(f"{options.size}: cycles as parts of the default's, {' and '.join(configs)}")
    print("| choice | " + " | ".join(scene for scene, _ in scenes) + " | geometric mean |")
    print("| --- |" + " --- |" * (len(scenes) + 1))
    for choice, _ in chosen:
        parts = {scene: [cycles[choice, scene, config] / cycles["default", scene, config] for config in configs] for scene, _ in scenes}
        every = [part for row in parts.values() for part in row]
        print(f"| {choice} | " + " | ".join(", ".join(f"{part:.3f}" for part in row) for row in parts.values())
              + f" | {math.exp(sum(map(math.log, every)) / len(every)):.3f} |")
    return sum(len(seen) - 1 for seen in pictures.values())


def program_bytes(cache):
    """Of the program that was used last: bytes of code and of main's frame, which is its only one."""
    elf = max(cache.glob("*.elf"), key=lambda path: path.stat().st_mtime_ns).read_bytes()
    table, = struct.unpack_from("<I", elf, 32)
    entry, count, names = struct.unpack_from("<HHH", elf, 46)
    sections = [struct.unpack_from("<10I", elf, table + number * entry) for number in range(count)]
    code = sum(size for _, kind, flags, _, _, size, *_ in sections if kind == 1 and flags & 4)
    stack = 0
    for name, _, _, _, offset, size, *_ in sections:
        start = sections[names][4] + name
        if elf[start:elf.index(b"\0", start)] == b".stack_sizes":
            at, end = offset, offset + size
            while at < end:
                at, shift, frame = at + 4, 0, 0
                while True:
                    frame |= (elf[at] & 127) << shift
                    at, shift = at + 1, shift + 7
                    if not elf[at - 1] & 128:
                        break
                stack = max(stack, frame)
    return code, stack


def stacks(options, configs):
    """A row for each scene, chip and number of entries; the last one is what the others are compared with. How many pictures differ."""
    entries = options.stacks.split(",")
    print(f"{options.size}")
    print("| scene | chip | entries | bytes of stack | instructions run | cycles | bytes from and to memory | change of cycles |")
    print("| --- |" + " --- |" * 7)
    different = 0
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        for scene, files in SCENES:
            if options.scene and scene != options.scene:
                continue
            stored = scratch / "scene.trax"
            subprocess.run([options.bin / "trax-scene", "--quiet", *[find(options.scenes, file) for file in files], "-o", stored], check=True)
            for config in configs:
                rows, pictures = [], set()
                for count in entries:
                    run = subprocess.run([options.bin / "trax-render", stored, "--view", scene, "--config", config, "--size", options.size,
                                          "--quiet", "--report", "--stack", count, "--cache", scratch / "cache", "-o", scratch / "picture.png"],
                                         stdout=subprocess.PIPE, text=True, check=False)
                    if run.returncode not in (0, 1) or not run.stdout:
                        sys.exit("traversal.py: error: trax-render failed")
                    different += run.returncode
                    pictures.add((scratch / "picture.png").read_bytes())
                    rows.append((count, {row: pair[1] for row, pair in figures(run.stdout).items()}))
                different += len(pictures) - 1
                for count, found in rows:
                    print(f"| {scene} | {config} | {count} | {found['bytes of stack']} | {found['instructions run']:,} | {found['cycles']:,} | "
                          f"{found['bytes from and to memory']:,} | {100 * (found['cycles'] / rows[-1][1]['cycles'] - 1):+.1f} % |", flush=True)
    return different


def main():
    parser = arguments(__doc__, "320x180")
    parser.add_argument("--configs", default="4x32,8x64")
    parser.add_argument("--only", help="ways, separated by ';'")
    parser.add_argument("--scene")
    parser.add_argument("--choices", action="store_true", help="one choice of the builder's at a time")
    parser.add_argument("--stacks", help="numbers of entries, separated by ','")
    options = parser.parse_args()
    configs = options.configs.split(",")
    ways = [way for way in WAYS if not options.only or way[0] in options.only.split(";")]
    if not ways and not options.choices:
        sys.exit(f"traversal.py: error: --only: the ways are {', '.join(name for name, *_ in WAYS)}")

    if options.stacks or options.choices:
        different = stacks(options, configs) if options.stacks else choices(options, configs)
        print(f"pictures {'different: ' + str(different) if different else 'identical in every bit'}")
        return 1 if different else 0

    print(f"{options.size}")
    print("| scene | stored | bytes | code | stack | " + " | ".join(f"{config}: MRPS | bytes/ray | instructions/ray" for config in configs) + " |")
    print("| --- | --- |" + " --- |" * (3 + 3 * len(configs)))
    different = 0
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        for scene, files in SCENES:
            if options.scene and scene != options.scene:
                continue
            meshes = [find(options.scenes, file) for file in files]
            first = None
            for way, how, shown in ways:
                stored = scratch / "scene.trax"
                subprocess.run([options.bin / "trax-scene", "--quiet", *meshes, "-o", stored, *how], check=True)
                cells = []
                for config in configs:
                    subprocess.run([options.bin / "trax-render", stored, "--view", scene, "--config", config, "--size", options.size, "--quiet", *shown,
                                    "--cache", scratch / "cache", "--stats", scratch / "stats.json", "-o", scratch / "picture.png"], check=True)
                    run = json.loads((scratch / "stats.json").read_text())
                    cells += [f"{run['mrps']:.2f}", f"{run['memory']['bytes'] / run['rays']:.0f}", f"{run['instructions'] / run['rays']:.0f}"]
                    picture = (scratch / "picture.png").read_bytes()
                    first = first or picture
                    different += picture != first
                code, stack = program_bytes(scratch / "cache")
                print(f"| {scene} | {way} | {stored.stat().st_size:,} | {code:,} | {stack} | {' | '.join(cells)} |", flush=True)
    print(f"pictures {'different: ' + str(different) if different else 'identical in every bit'}")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
