#!/usr/bin/env python3
"""The litmus tests of this folder, C11 atomics compiled for the TP, on the model with memory as weak as docs/isa.md
allows.

  litmus.py --build build [--runs 100000] [--seeds 0,1,2] [--machines 2x1,2x16,4x32] [--levels -O2] [--only REGEX]
  [--jobs N]

Each test runs on each machine three times: as it is, when no forbidden outcome may come; with relaxed orders and no
fences, and on a machine that ignores fences, when the forbidden outcome must come, or the test could not fail. Where
too few runs show it, more are made."""

import argparse
import concurrent.futures
import os
import re
import subprocess
import sys
import tempfile
import threading

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import interrupts  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
FEW_RUNS, MOST_RUNS = 4000, 1000000  # of those that are to show the forbidden outcome
SECONDS = 3600


def compiled(options, name, level, runs, relaxed, directory):
    binary = os.path.join(directory, f"{name}{level}-{runs}{'-relaxed' if relaxed else ''}")
    if not os.path.exists(binary):
        part = f"{binary}.{threading.get_ident()}"
        subprocess.run([os.path.join(options.build, "bin", "clang"), "--target=trax", level, "-Wall", "-Wextra",
                        "-Werror", f"-DRUNS={runs}",
                        *(["-DRELAXED"] if relaxed else []), os.path.join(HERE, name + ".c"), "-o", part], check=True)
        os.rename(part, binary)
    return binary


def outcomes(options, binary, machine, seed, broken="none"):
    """(runs, weak, broken), or what went wrong."""
    tms, tps = machine.split("x")
    done = subprocess.run([os.path.join(options.build, "tests", "bin", "isa-weak-model"), "--tms", tms, "--tps", tps,
                           "--limit", "2000000000", binary],
                          env=os.environ | {"TRAX_SEED": str(seed), "TRAX_BREAK": broken}, capture_output=True,
                          text=True, timeout=SECONDS,
                          check=False)
    counts = re.fullmatch(r"(\d+) runs: (\d+) weak, (\d+) broken\n", done.stdout)
    if done.returncode or not counts:
        raise RuntimeError(f"exit status {done.returncode}: {done.stdout}{done.stderr}")
    return tuple(map(int, counts.groups()))


def strong(options, name, level, machine, seed, directory):
    runs, weak, broken = outcomes(options, compiled(options, name, level, options.runs, False, directory), machine,
                                  seed)
    if runs != options.runs or weak or broken:
        return f"{weak} of {runs} outcomes are forbidden, {broken} are impossible"
    return None


def without(options, name, level, machine, seed, directory, relaxed):
    """Weak outcomes must come in some number of runs."""
    runs = min(options.runs, FEW_RUNS)
    while True:
        binary = compiled(options, name, level, runs, relaxed, directory)
        count, weak, broken = outcomes(options, binary, machine, seed, "none" if relaxed else "fence")
        if count != runs or (broken and relaxed):
            return f"{broken} of {count} outcomes are impossible"
        if weak:
            return weak, runs
        if runs == MOST_RUNS:
            return f"no weak outcome in {runs} runs"
        runs = min(4 * runs, MOST_RUNS)


def check(options, name, machine, directory):
    """A line, and whether all is well."""
    found, problems = [], []
    for level in options.levels.split(","):
        for seed in options.seeds.split(","):
            problem = strong(options, name, level, machine, int(seed), directory)
            problems += [f"{level}, seed {seed}: {problem}"] if problem else []
        # Without fences the library's locks fail too, and what is not inline may wait forever.
        for relaxed in (False, True) if level == "-O2" else (True,):
            result = without(options, name, level, machine, 0, directory, relaxed)
            if isinstance(result, str):
                problems.append(f"{level}, {'relaxed' if relaxed else 'fences ignored'}: {result}")
            else:
                found.append(f"{result[0]:,} of {result[1]:,} {'relaxed' if relaxed else 'without fences'}")
    total = options.runs * len(options.seeds.split(",")) * len(options.levels.split(","))
    if problems:
        return f"{name} {machine}: {'; '.join(problems)}", False
    return f"{name:20} {machine:5} 0 of {total:,} forbidden; weak: {', '.join(found)}", True


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--build", required=True, help="the build directory")
    parser.add_argument("--runs", type=int, default=FEW_RUNS, help="of each test on each machine under each seed")
    parser.add_argument("--seeds", default="0", help="of the model's random orders")
    parser.add_argument("--machines", default="2x1,2x16,4x32")
    parser.add_argument("--levels", default="-O2")
    parser.add_argument("--only", default="", help="tests whose names match")
    parser.add_argument("--jobs", type=int, default=1)
    # Values such as -O2 begin with a dash.
    arguments = [f"--levels={value}" if word == "--levels" else word
                 for word, value,
                 before in zip(sys.argv[1:], sys.argv[2:] + [""], sys.argv[:-1]) if before != "--levels"]
    options = parser.parse_args(arguments)
    interrupts.end_by_signals()
    names = sorted(name[:-2] for name in os.listdir(HERE) if name.endswith(".c") and re.search(options.only, name))
    good = bool(names)
    with tempfile.TemporaryDirectory() as directory, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for name in names:
            for line, well in pool.map(lambda machine, name=name: check(options, name, machine, directory),
                                       options.machines.split(",")):
                print(line, flush=True)
                good &= well
    return not good


if __name__ == "__main__":
    sys.exit(main())
