#!/usr/bin/env python3
"""The threaded programs of tests/c, and those of tests/litmus, on warps: they end, with the output and the exit status
that they have without.

  programs.py --build build [--widths 8] [--tps 8] [--only REGEX] [--jobs N]
"""

import argparse
import concurrent.futures
import math
import os
import re
import shlex
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
LITMUS = os.path.join(HERE, "..", "litmus")
sys.path.insert(0, os.path.join(HERE, ".."))
from threaded import c_programs  # noqa: E402

SECONDS = 240  # of a run
RUNS = 20  # of a litmus test


def litmus_programs():
    return [(os.path.join(LITMUS, name), f"-DRUNS={RUNS}", "--set chip.tms=2 --set chip.tps_per_tm=16")
            for name in sorted(os.listdir(LITMUS)) if name.endswith(".c")]


def tps_of(machine):
    found = re.findall(r"chip\.tps_per_tm=(\d+)", machine) or re.findall(r"--config \d+x(\d+)", machine)
    return int(found[-1]) if found else 1


def lanes_of(machine, width):
    """The width that the machine can have: as asked, or less."""
    return math.gcd(tps_of(machine), width)


def outcome(options, machine, binary):
    simulator = os.path.join(options.build, "bin", "trax-sim")
    done = subprocess.run([simulator, "--quiet", *shlex.split(machine), binary], capture_output=True, timeout=SECONDS,
                          check=False)
    return done.returncode, done.stdout, done.stderr


def check(options, program, directory):
    """(runs, what went wrong)"""
    source, cflags, machine = program
    if options.tps and tps_of(machine) > options.tps:
        machine += f" --set chip.tps_per_tm={options.tps}"
    name = os.path.basename(source)
    what = f"{name} {cflags} {machine}"
    with tempfile.NamedTemporaryFile(dir=directory, prefix=name, delete=False) as file:
        binary = file.name
    compiler = os.path.join(options.build, "bin", "clang++" if name.endswith(".cpp") else "clang")
    subprocess.run([compiler, "--target=trax", "-O2", "-w", *shlex.split(cflags), source, "-o", binary], check=True)
    expected = outcome(options, machine, binary)
    widths = sorted({lanes_of(machine, int(width)) for width in options.widths.split(",")} - {1})
    problems = []
    for width in widths:
        try:
            found = outcome(options, f"{machine} --set simt.width={width}", binary)
        except subprocess.TimeoutExpired:
            problems.append(f"{what}, width {width}: it has not ended after {SECONDS} s")
            continue
        if found != expected:
            problems.append(f"{what}, width {width}: exit status {found[0]}, not {expected[0]}; {found[1][-200:]!r}, "
                            f"not {expected[1][-200:]!r} {found[2].decode(errors='replace').strip()}")
    return len(widths), problems


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--build", required=True, help="the build directory")
    parser.add_argument("--widths", default="8", help="with commas; a machine with fewer TPs has less")
    parser.add_argument("--tps", type=int, help="of a TM at most; default: as many as the program's test has")
    parser.add_argument("--only", default="", help="programs whose names match")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    programs = [program for program in c_programs() + litmus_programs()
                if re.search(options.only, os.path.basename(program[0]))]
    runs, problems = 0, []
    with tempfile.TemporaryDirectory() as directory, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for count, wrong in pool.map(lambda program: check(options, program, directory), programs):
            runs += count
            problems += wrong
            for line in wrong:
                print(line, flush=True)
    print(f"{len(programs)} programs, {runs} runs on warps: {len(problems)} differ")
    return bool(problems) or runs == 0


if __name__ == "__main__":
    sys.exit(main())
