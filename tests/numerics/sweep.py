#!/usr/bin/env python3
"""Compare arithmetic on the TP, and its sources compiled for the host, with the host's hardware, operand by operand.

    sweep.py --count 10000000 --group doubles      one group; --first splits the work between processes
    sweep.py                                       20,000 operands for all routines of the groups doubles and integers,
                                                   and 500 for
                                                   those of functions

Each routine gets the same operands everywhere (sweep.h), and only hashes of the results are compared; where one
differs, the search for the first such operands follows, and they are printed. The groups doubles and integers are
compared with the hardware, functions (sin, pow, complex numbers, ...) with the runtime's sources compiled for the host.
Exit status: 0 if nothing differs, else 1.
"""

import argparse
import os
import struct
import subprocess
import sys
import tempfile
import time

GROUPS = {"doubles": 0, "integers": 1, "functions": 2}
PIECE = 1 << 20  # operands between two lines of progress


class Program:
    """Something that prints a hash for each routine of a group over a range of operands."""

    def __init__(self, name, command, on_tp=False):
        self.name, self.command, self.on_tp = name, command, on_tp

    def run(self, group, first, count, verbose=0):
        numbers = (GROUPS[group], first, count, verbose)
        command = self.command + [str(n) for n in numbers]
        with tempfile.TemporaryDirectory() as folder:
            if self.on_tp:
                path = os.path.join(folder, "parameters")
                with open(path, "wb") as file:
                    file.write(struct.pack("<4I", *numbers))
                command = self.command[:-1] + ["--bind", f"parameters={path}", self.command[-1]]
            done = subprocess.run(command, stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, check=False)
        if done.returncode != 0:
            sys.exit(f"sweep.py: {' '.join(command)} ended with status {done.returncode}")
        return done.stdout.decode().splitlines()


def differing(ours, theirs):
    return [a.split()[0] for a, b in zip(ours, theirs) if a != b] if len(ours) == len(theirs) else ["all"]


def find(program, reference, group, first, count):
    """Print the first operands of the range, which has some, for which the two differ."""
    while count > 1:
        half = count // 2
        if program.run(group, first, half) == reference.run(group, first, half):
            first, count = first + half, count - half
        else:
            count = half
    for ours, theirs in zip(program.run(group, first, 1, 1), reference.run(group, first, 1, 1)):
        if ours != theirs:
            print(f"{program.name}, operand {first}:\n  {ours}\n  {theirs}   ({reference.name})")


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    build = os.path.join(here, "..", "..", "build")
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--count", type=int, help="operands for each routine (default: 20000, of functions 500)")
    parser.add_argument("--first", type=int, default=0, help="the number of the first (default: 0)")
    parser.add_argument("--group", choices=list(GROUPS), help="one group only")
    parser.add_argument("--host-only", action="store_true", help="not on the TP")
    parser.add_argument("--bin", default=os.path.join(build, "bin"),
                        help="the folder of trax-sim, beside tests/bin of the compiled sweeps")
    parser.add_argument("--machine", default="1x32", help="trax-sim's --config")
    options = parser.parse_args()

    def program(name):
        return os.path.join(options.bin, name if name == "trax-sim" else f"../tests/bin/{name}")

    hardware = Program("hardware", [program("sweep-hardware")])
    sources = Program("runtime on the host", [program("sweep-runtime")])
    tp = Program("TP",
                 [program("trax-sim"), "--engine", "functional", "--quiet", "--config", options.machine,
                  program("sweep.elf")], True)
    failed = False
    for group in [options.group] if options.group else list(GROUPS):
        count = options.count or (500 if group == "functions" else 20000)
        # Compiled for the host, functions are the reference itself.
        programs = ([] if group == "functions" else [sources]) + ([] if options.host_only else [tp])
        for candidate in programs:
            start, wrong, routines = time.monotonic(), [], 0
            for done in range(0, count, PIECE):
                first, size = options.first + done, min(PIECE, count - done)
                theirs = hardware.run(group, first, size)
                ours = candidate.run(group, first, size)
                routines = len(theirs)
                wrong = differing(ours, theirs)
                if count > PIECE:
                    print(f"{group}, {candidate.name}: {done + size} operands, {time.monotonic() - start:.0f} s",
                          flush=True)
                if wrong:
                    failed = True
                    print(f"{group}, {candidate.name}: differs in {', '.join(wrong)}")
                    find(candidate, hardware, group, first, size)
                    break
            if not wrong:
                print(f"{group}, {candidate.name}: {routines} routines, {count} operands each, no difference")
    return failed


if __name__ == "__main__":
    sys.exit(main())
