#!/usr/bin/env python3
"""Compare the TP's floating-point instructions, and the library's sqrtf, with the oracle, in each engine of trax-sim.

    tests/isa/oracle/sweep.py                                        pairs enough for test.sh
    tests/isa/oracle/sweep.py --engine functional --count 10000000   as many as asked, of one engine

The operands are the numbered pairs of pairs.h; only hashes of results are compared, and where one differs, the search
for the first such pair follows. Exit status: 0 if nothing differs, else 1.
"""

import argparse
import os
import struct
import subprocess
import sys
import tempfile
import time

# Pairs of each engine by default; the slower ones get fewer. A million has all pairs of corner values.
ENGINES = {"reference": 10000, "fast": 50000, "functional": 1000000}
REDUCED = [23, 12, 1]  # precisions of the special unit besides the whole 24, with an eighth of the pairs
PIECE = 1 << 20


def output(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, check=False)
    if done.returncode != 0:
        sys.exit(f"sweep.py: {' '.join(command)} ended with status {done.returncode}")
    return done.stdout.decode().splitlines()


class Oracle:
    def __init__(self, folder):
        self.name, self.program = "the oracle", os.path.join(folder, "../tests/bin/isa-oracle-sweep")

    def run(self, first, count, bits, verbose=0):
        return output([self.program] + [str(n) for n in (first, count, bits, verbose)])


class Engine:
    def __init__(self, folder, engine, machine, bits):
        self.name, self.bits = engine, bits
        self.command = [os.path.join(folder, "trax-sim"), "--quiet", "--engine", engine, "--config", machine]
        self.program = os.path.join(folder, "../tests/bin/isa-oracle-sweep.elf")

    def run(self, first, count, bits, verbose=0):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "parameters")
            with open(path, "wb") as file:
                file.write(struct.pack("<4I", first, count, bits, verbose))
            return output(self.command + ["--set", f"special.precision_bits={self.bits or bits}", "--bind",
                                          f"parameters={path}", self.program])


def find(engine, oracle, first, count, bits):
    """Print what differs at the first pair of the range for which something does."""
    while count > 1:
        half = count // 2
        if engine.run(first, half, bits) == oracle.run(first, half, bits):
            first, count = first + half, count - half
        else:
            count = half
    for ours, theirs in zip(engine.run(first, 1, bits, 1), oracle.run(first, 1, bits, 1)):
        if ours != theirs:
            print(f"  pair {first}: {engine.name} {ours}, {oracle.name} {theirs}")


def compare(engine, oracle, first, count, bits):
    """Returns whether nothing differs."""
    start = last = time.monotonic()
    for done in range(0, count, PIECE):
        size = min(PIECE, count - done)
        ours, theirs = engine.run(first + done, size, bits), oracle.run(first + done, size, bits)
        if ours != theirs or len(ours) < 2:
            print(f"{engine.name}, {bits} bits: differs among pairs {first + done} to {first + done + size - 1}")
            find(engine, oracle, first + done, size, bits)
            return False
        if sys.stderr.isatty() and time.monotonic() - last > 1:
            last = time.monotonic()
            left = (last - start) * (count - done - size) / (done + size)
            sys.stderr.write(f"\r{engine.name}, {bits} bits: {done + size} of {count} pairs, {left:.0f} s left\033[K")
    if sys.stderr.isatty():
        sys.stderr.write("\r\033[K")
    print(f"{engine.name}, {bits} bits: {len(ours)} operations, {count} pairs each, no difference", flush=True)
    return True


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--count", type=int,
                        help=f"pairs (default: {', '.join(f'{n} {e}' for e, n in ENGINES.items())})")
    parser.add_argument("--first", type=int, default=0, help="the number of the first (default: 0)")
    parser.add_argument("--engine", choices=list(ENGINES), help="one engine only")
    parser.add_argument("--bits", type=int, help="one precision of the special unit only")
    parser.add_argument("--engine-bits", type=int,
                        help="another precision for the engine: to see that differences are found")
    parser.add_argument("--bin", default=os.path.join(here, "../../../build/bin"), help="the folder of the programs")
    parser.add_argument("--machine", default="1x32", help="trax-sim's --config")
    options = parser.parse_args()
    if options.count is not None and options.count < 1 or options.first < 0 or options.first + (options.count or
                                                                                                0) > 1 << 32:
        parser.error("pairs are numbered from 0 to 4294967295")
    oracle, same = Oracle(options.bin), True
    for name in [options.engine] if options.engine else ENGINES:
        engine = Engine(options.bin, name, options.machine, options.engine_bits)
        count = options.count or ENGINES[name]
        for bits in [options.bits] if options.bits else [24] + REDUCED:
            same &= compare(engine, oracle, options.first, count if bits == 24 else max(1, count // 8), bits)
    return not same


if __name__ == "__main__":
    sys.exit(main())
