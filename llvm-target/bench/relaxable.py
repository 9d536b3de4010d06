#!/usr/bin/env python3
"""How much a linker that relaxes addresses could save: of every kernel's executed instructions at -O3, those that are a `lui rd, 0`, the
upper half of an address below 32 kB.

    llvm-target/bench/relaxable.py --build build [KERNEL...]

They are counted by putting `mul rd, r0, r0` in their place, which gives 0 as well and goes to a unit whose operations the simulator
counts.
"""

import argparse
import json
import struct
import tempfile
from pathlib import Path

from machines import BENCH, COMMON, run

LUI_ZERO, LUI_MASK = 0x44000000, 0xFC1FFFFF  # lui rd, 0
MUL_ZERO, RD = 0x08000000, 0x03E00000        # mul rd, r0, r0


def without_upper_halves(program):
    """Write program.mul, in which each lui of 0 is a mul; return its path and how many there are."""
    image = bytearray(program.read_bytes())
    headers, = struct.unpack_from("<I", image, 28)
    offset, _, _, size = struct.unpack_from("<4I", image, headers + 4)  # the first segment is the text
    count = 0
    for place in range(offset, offset + size, 4):
        word, = struct.unpack_from("<I", image, place)
        if word & LUI_MASK == LUI_ZERO:
            struct.pack_into("<I", image, place, MUL_ZERO | word & RD)
            count += 1
    changed = program.with_suffix(".mul")
    changed.write_bytes(image)
    return changed, count


def execute(build, program):
    """Return what the program printed, how many instructions it executed, and how many of them were integer multiplications."""
    statistics = program.with_suffix(".json")
    printed, _ = run([build / "bin/trax-sim", "--engine", "fast", "--quiet", "--stats", statistics, program])
    numbers = json.loads(statistics.read_text())
    return printed, numbers["instructions"], numbers["int_mul"]["operations"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=Path("build"))
    parser.add_argument("kernels", nargs="*", default=sorted(path.stem for path in (BENCH / "kernels").glob("*.c")))
    options = parser.parse_args()
    print(f"{'kernel':20} {'in the text':>12} {'executed':>12} {'of':>12}")
    with tempfile.TemporaryDirectory() as directory:
        for kernel in options.kernels:
            program = Path(directory) / kernel
            run([options.build / "bin/clang", "--target=trax", *COMMON, "-O3", "-DREPETITIONS=2", "-I", BENCH,
                 BENCH / "kernels" / f"{kernel}.c", BENCH / "driver.c", "-o", program])
            changed, count = without_upper_halves(program)
            printed, total, before = execute(options.build, program)
            same, _, after = execute(options.build, changed)
            assert printed == same, f"{kernel}: the changed program computes something else"
            print(f"{kernel:20} {count:12} {after - before:12} {total:12} {100 * (after - before) / total:6.2f} %")


if __name__ == "__main__":
    main()
