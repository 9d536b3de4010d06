#!/usr/bin/env python3
"""Counts the fast engine's host instructions by function, with callgrind.

    emulator/bench/instructions.py SCENES_DIRECTORY [--scene conference] [--chip 4x32] [--size 320x180]
                                   [--cycles 60000:160000] [--bin build/bin]

SCENES_DIRECTORY holds the scenes as for speed.py. The figures are instructions of the host in user mode while trax-sim
simulates the cycles of the picture between the two numbers of --cycles, on one thread of the host. They are the
difference of two runs, so loading and the end of the run cancel out. Inlined functions count where they are inlined.
Debian's valgrind does not support AVX-512, so the variant for AVX2 is measured. The figures are reproducible.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import speed

ROWS = 12  # of functions; the rest is one row


def count(programs, words, cycles, scratch):
    """Host instructions by function, and the statistics of the run."""
    out, stats = scratch / "callgrind.out", scratch / "stats.json"
    run = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", programs / "trax-sim",
                          "--host-threads", "1", "--max-cycles", str(cycles), "--stats", stats, *words],
                         cwd=scratch, capture_output=True, text=True)
    if run.returncode != 124 or not stats.exists():
        sys.exit(f"instructions.py: error: the run has not stopped at cycle {cycles}:\n{run.stderr}")
    listing = subprocess.run(["callgrind_annotate", "--threshold=100", "--auto=no", out], check=True,
                             capture_output=True, text=True).stdout
    functions = {}
    for number, name in re.findall(r"^ *([\d,]+) \([ \d.]+%\)  \S*?:([^\[\n]+?) *(?:\[[^\]\n]*\])?$", listing, re.M):
        name = re.sub(r"(_v3)?('\d+)?$", "", name)  # suffixes of the variant and of recursive calls
        functions[name] = functions.get(name, 0) + int(number.replace(",", ""))
    return functions, json.loads(stats.read_text())


def main():
    parser = speed.arguments(__doc__, "320x180")
    parser.add_argument("--scene", default="conference")
    parser.add_argument("--chip", default="4x32")
    parser.add_argument("--cycles", default="60000:160000")
    options = parser.parse_args()
    first, last = map(int, options.cycles.split(":"))
    if not shutil.which("valgrind"):
        sys.exit("instructions.py: error: valgrind is not installed (Debian's package valgrind)")

    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        words = ["--config", options.chip, speed.prepare(options, options.scene, scratch)]
        before, stats_before = count(options.bin.resolve(), words, first, scratch)
        after, stats_after = count(options.bin.resolve(), words, last, scratch)
    difference = sorted(((after[name] - before.get(name, 0), name) for name in after), reverse=True)
    total = sum(number for number, _ in difference)
    cycles = (stats_after["cycles"] - stats_before["cycles"]) * stats_after["configuration"]["chip"]["tms"]
    instructions = stats_after["instructions"] - stats_before["instructions"]
    print("| function | of a TM's cycle | share |\n| --- | --- | --- |")
    rows = [(name, number) for number, name in difference[:ROWS]]
    rows.append(("the rest", total - sum(number for _, number in rows)))
    for name, number in rows:
        shown = name if name == "the rest" else f"`{name}`"
        print(f"| {shown} | {number / cycles:,.0f} | {100 * number / total:.1f} % |")
    print(f"| all | {total / cycles:,.0f} | 100 % |")
    print(f"\n{total / instructions:.1f} host instructions for each instruction of the program")


if __name__ == "__main__":
    main()
