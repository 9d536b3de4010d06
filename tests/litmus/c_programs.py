#!/usr/bin/env python3
"""The threaded programs of tests/c on memory as weak as docs/isa.md allows: on each machine they must print, and end
with, what they do on the model without caches and delays.

  c_programs.py --build build [--machines 2x1,2x16,4x32] [--seeds 0,1,2] [--level -O2] [--only REGEX] [--jobs N]
"""

import argparse
import concurrent.futures
import os
import re
import shlex
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import interrupts  # noqa: E402
from threaded import C, c_programs  # noqa: E402

LIMIT = 4000000000  # instructions


def threaded():
    """{name: the compiler's flags, of each way in which it is compiled}"""
    found = {}
    for source, flags, _ in c_programs():
        found.setdefault(os.path.basename(source), set()).add(flags)
    return {name: sorted(flags) for name, flags in found.items()}


def result(options, model, machine, binary, seed=None):
    tms, tps = machine.split("x")
    environment = os.environ | ({} if seed is None else {"TRAX_SEED": seed})
    done = subprocess.run([os.path.join(options.build, "tests", "bin", model), "--tms", tms, "--tps", tps,
                           "--memory-mib", str(options.memory_mib), "--limit", str(LIMIT), binary],
                          env=environment, capture_output=True, check=False)
    return done.returncode, done.stdout, done.stderr.decode(errors="replace").replace("trax-isa-model", "")


def check(options, name, flags, directory):
    """How many runs went well, and what went wrong."""
    compiler = "clang++" if name.endswith(".cpp") else "clang"
    good, problems = 0, []
    for way, cflags in enumerate(flags):
        binary = os.path.join(directory, f"{name}.{way}")
        subprocess.run([os.path.join(options.build, "bin", compiler), "--target=trax", options.level,
                        *shlex.split(cflags),
                        os.path.join(C, name), "-o", binary], check=True)
        for machine in options.machines.split(","):
            what = f"{name} {cflags} {machine}".replace("  ", " ")
            expected = result(options, "trax-isa-model", machine, binary)
            if expected[0] == 124:
                problems.append(f"{what}: it does not end")
                continue
            for seed in options.seeds.split(","):
                found = result(options, "isa-weak-model", machine, binary, seed)
                if found[:2] == expected[:2]:
                    good += 1
                else:
                    problems.append(
                        f"{what}, seed {seed}: exit status {found[0]}, not {expected[0]}; {found[1][-200:]!r}, "
                        f"not {expected[1][-200:]!r} {found[2].strip()}")
    return good, problems


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--build", required=True, help="the build directory")
    parser.add_argument("--machines", default="2x1,2x16,4x32")
    parser.add_argument("--seeds", default="0", help="of the model's random orders")
    parser.add_argument("--level", default="-O2", choices=["-O0", "-O1", "-O2", "-O3", "-Os", "-Oz"])
    parser.add_argument("--only", default="", help="programs whose names match")
    parser.add_argument("--memory-mib", type=int, default=64, help="a program fills what is free (default: 64)")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--verbose", action="store_true")
    arguments = sys.argv[1:]
    for i, word in enumerate(arguments[:-1]):
        if word == "--level":  # its value begins with a dash
            arguments[i:i + 2] = [f"--level={arguments[i + 1]}"]
            break
    options = parser.parse_args(arguments)
    interrupts.end_by_signals()
    programs = {name: flags for name, flags in threaded().items() if re.search(options.only, name)}
    good, problems = 0, []
    with tempfile.TemporaryDirectory() as directory, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for name, (well, wrong) in zip(programs,
                                       pool.map(lambda name: check(options, name, programs[name], directory),
                                                programs)):
            good += well
            problems += wrong
            if options.verbose:
                print(f"{name}: {well} well", flush=True)
            for line in wrong:
                print(line, flush=True)
    print(f"{len(programs)} programs: {good} runs well, {len(problems)} not")
    return bool(problems) or good == 0


if __name__ == "__main__":
    sys.exit(main())
