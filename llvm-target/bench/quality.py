#!/usr/bin/env python3
"""Measures the compiler's code: our clang against Debian's clang-19 for 32-bit RISC-V.

    llvm-target/bench/quality.py --build build [KERNEL...]       executed instructions, kernel by kernel
    llvm-target/bench/quality.py --build build --short           the same, against the column without contraction alone
    llvm-target/bench/quality.py --build build --compile-time    seconds for the ray tracer's program
    llvm-target/bench/quality.py --build build --code-size       bytes of the ray tracer's program and of the library

Both compilers get -O3 and the same flags. RISC-V is rv32im_zfinx. Like the TP it has 32 registers for integers and
floats. It also has a divide, a square root and a fused multiply-add, which the TP lacks, and contracts to the latter by
default. Further columns are for -ffp-contract=off, for rv32im_zbb_zfinx (which has min and max like the TP, and
rotations and counts of bits) and for both compilers at -O2. The limit for each kernel is for the column without
contraction, because a fused multiply-add computes another result. A kernel's instructions are those of two repetitions
less those of one, so start-up does not count. trax-sim counts ours. qemu-riscv32 counts RISC-V's by a plugin, or by its
log if it takes no plugin. Both counters are checked on a loop that was counted by hand. Both sides link the same
library, compiled by the measured compiler. Every result is compared with the host's of the same source: equal in every
bit without contraction, within 0.1 % with it.

The kernels in missing/ need instructions that the TP lacks. They are measured, but have no limit.

Exit status: 0 if what is required holds (the constants below), 2 if not, 1 if something failed.
"""

import argparse
import math
import os
import resource
import statistics
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from machines import (BENCH, COMMON, ROOT, Failure, Host, Riscv, Trax, build_and_run, check_counter,
                      check_programs, measure_kernel, run)

GEOMETRIC_MEAN_LIMIT = 0.87
ZBB_LIMIT = 0.93
STRICT_LIMIT = 0.83  # without contraction: the limit of the mean for --short
SECOND_LIMIT = 1.00  # -O2 against -O2
KERNEL_LIMIT = 1.05  # without contraction
COMPILE_TIME_LIMIT = 1.30
CONTRACTION_TOLERANCE = 1e-3
RAY_TRACER = ROOT / "raytracer/device/main.c"
RAY_TRACER_FLAGS = ["-Wno-frame-larger-than", "-DGENERAL_LAYOUTS_ONLY=1"]  # as the general program of the TPs


# --- executed instructions ----------------------------------------------------

@dataclass
class Row:
    """Executed instructions of a kernel: ours and RISC-V's, the latter without contraction and with Zbb, and both at
    -O2. --short measures the first two."""

    ours: int
    strict: int
    theirs: int = 0
    bits: int = 0
    ours2: int = 0
    theirs2: int = 0

    @property
    def ratio(self):
        return self.ours / self.theirs

    @property
    def strictly(self):
        return self.ours / self.strict

    @property
    def ratio2(self):
        return self.ours2 / self.theirs2


class Comparison:
    """Every machine that a kernel is run on."""

    def __init__(self, build, work, short):
        self.short = short
        self.trax = Trax(build, work)
        self.riscv_strict = Riscv(build, work, "riscv-strict", ["-ffp-contract=off"])
        self.host = Host(work, "host")
        check_counter(self.trax)
        check_counter(self.riscv_strict)
        if not short:
            self.riscv = Riscv(build, work)
            self.riscv_zbb = Riscv(build, work, "riscv-zbb", extensions="_zbb")

    def measure(self, source):
        """Return executed instructions of one repetition: a Row."""
        ours, our_count = measure_kernel(self.trax, source)
        strict, strict_count = measure_kernel(self.riscv_strict, source)
        expected = build_and_run(self.host, source, "2")[:2]
        exact = build_and_run(self.host, source, "2", "exact")[:2]
        check_equal(source, self.trax, ours, exact)
        check_equal(source, self.riscv_strict, strict, expected)
        if self.short:
            return Row(our_count, strict_count)
        theirs, their_count = measure_kernel(self.riscv, source)
        bits, bits_count = measure_kernel(self.riscv_zbb, source)
        ours2, our_count2 = measure_kernel(self.trax, source, "-O2")
        theirs2, their_count2 = measure_kernel(self.riscv, source, "-O2")
        check_equal(source, self.trax, ours2, exact)
        for found in (theirs, bits, theirs2):
            check_contracted(source, self.riscv, found, expected)
        return Row(our_count, strict_count, their_count, bits_count, our_count2, their_count2)


def check_equal(source, machine, found, expected):
    if found != expected:
        raise Failure(f"{source.stem}: {machine.name} computes {found[0]:08x} {found[1]:.9g}, "
                      f"the host {expected[0]:08x} {expected[1]:.9g}")


def check_contracted(source, machine, found, expected):
    """Contraction may change only floats, and only within the tolerance."""
    if expected[1] == 0:
        check_equal(source, machine, found, expected)
    elif not abs(found[1] - expected[1]) <= CONTRACTION_TOLERANCE * abs(expected[1]):
        raise Failure(f"{source.stem}: contracted, {machine.name} computes {found[1]:.9g}, the host {expected[1]:.9g}")


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def print_rows(sources, rows):
    """Print a row a kernel."""
    for source, row in zip(sources, rows):
        mark = "*" if row.strictly > KERNEL_LIMIT else " "
        print(
            f"{source.stem:18} {row.ours:10} {row.theirs:10} {row.ratio:6.3f}  "
            f"{row.strictly:8.3f}{mark}{row.ours / row.bits:6.3f} "
            f"{row.ours2:10} {row.theirs2:10} {row.ratio2:6.3f}")


def report_instructions(required, missing, rows):
    """Print the table; return whether it is good enough."""
    print(
        f"{'executed instructions':18} {'trax':>7} {'rv32':>10} {'ratio':>6}  {'strictly':>8} {'zbb':>6} "
        f"{'-O2 trax':>10} {'rv32':>10} {'ratio':>6}"
    )
    good = True
    if required:
        print_rows(required, rows[:len(required)])
        mean, strict, bits, second = (geometric_mean([ratio(row) for row in rows[:len(required)]]) for ratio in (
            lambda row: row.ratio, lambda row: row.strictly, lambda row: row.ours / row.bits, lambda row: row.ratio2))
        worst = max(range(len(required)), key=lambda i: rows[i].strictly)
        print(
            f"{'geometric mean':18} {'':10} {'':10} {mean:6.3f}  {strict:8.3f} {bits:6.3f} {'':10} {'':10} "
            f"{second:6.3f}"
        )
        print(
            f"worst strictly: {required[worst].stem} {rows[worst].strictly:.3f}; required: means at most "
            f"{GEOMETRIC_MEAN_LIMIT:.2f}, "
            f"{ZBB_LIMIT:.2f} (zbb) and {SECOND_LIMIT:.2f} (-O2), none strictly above {KERNEL_LIMIT:.2f} (*)")
        good = mean <= GEOMETRIC_MEAN_LIMIT and rows[
            worst].strictly <= KERNEL_LIMIT and bits <= ZBB_LIMIT and second <= SECOND_LIMIT
    if missing:
        print("\nabout instructions that the TP has not got:")
        print_rows(missing, rows[len(required):])
    return good


def report_short(sources, rows):
    """Print our instructions beside those without contraction; return whether ours are few enough."""
    for source, row in zip(sources, rows):
        mark = "*" if row.strictly > KERNEL_LIMIT else ""
        print(f"{source.stem:18} {row.ours:10} {row.strict:10} {row.strictly:6.3f}{mark}")
    mean = geometric_mean([row.strictly for row in rows])
    print(f"{'geometric mean':40} {mean:6.3f}; required: at most {STRICT_LIMIT}, no kernel above {KERNEL_LIMIT} (*)")
    return mean <= STRICT_LIMIT and all(row.strictly <= KERNEL_LIMIT for row in rows)


def compare_instructions(options, work):
    folders = ("kernels",) if options.short else ("kernels", "missing")
    sources = {path.stem: path for folder in folders for path in sorted((BENCH / folder).glob("*.c"))}
    unknown = [name for name in options.kernels if name not in sources]
    if unknown:
        raise Failure(f"no kernel '{unknown[0]}'; there are {', '.join(sources)}")
    chosen = [source for name, source in sources.items() if not options.kernels or name in options.kernels]
    comparison = Comparison(options.build, work, options.short)
    with ThreadPoolExecutor(options.jobs) as pool:
        counts = list(pool.map(comparison.measure, chosen))
    if options.short:
        return report_short(chosen, counts)
    required = [source for source in chosen if source.parent.name == "kernels"]
    return report_instructions(required, chosen[len(required):], counts)


# --- compile time --------------------------------------------------------------

def processor_seconds(command):
    """Run a compiler; return its processor time, which other programs hardly change."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run(command)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def compare_compile_time(options, work):
    """Run both compilers in turn, so that other load on the computer affects both."""
    seconds = [[], []]
    for _ in range(options.runs):
        for times, machine in zip(seconds, (Trax(options.build, work), Riscv(options.build, work, library=False))):
            times.append(processor_seconds([*machine.compiler, *COMMON, *RAY_TRACER_FLAGS, "-O3", "-c", RAY_TRACER,
                                            "-o", work / "time.o"]))
    ours, theirs = map(statistics.median, seconds)
    print(
        f"{RAY_TRACER.relative_to(ROOT)} at -O3, median of {options.runs} runs: trax {ours:.3f} s, rv32 {theirs:.3f} "
        f"s, "
        f"ratio {ours / theirs:.2f}; required: at most {COMPILE_TIME_LIMIT:.2f}")
    return ours <= COMPILE_TIME_LIMIT * theirs


# --- code size -----------------------------------------------------------------

SIZE_LEVELS = {"-O3": ["-O3"], "-O2": ["-O2"], "-Os": ["-Os"], "-Oz": ["-Oz"]}


def code_bytes(machine, flags, sources, work):
    """Return the size of the sources' text sections together."""
    total = 0
    for source in sources:
        run([*machine.compiler, *flags, "-c", source, "-o", work / "size.o"])
        listing, _ = run(["llvm-size-19", "-A", work / "size.o"])
        total += sum(int(line.split()[1]) for line in listing.splitlines() if line.startswith(".text"))
    return total


def compare_code_size(options, work):
    """Print a row for each level; nothing is required of them."""
    library = [source for part in ("builtins", "math", "stdio", "stdlib", "string")
               for source in sorted((ROOT / "runtime" / part).glob("*.c"))]
    library_flags = ["-std=c17", "-D_DEFAULT_SOURCE", "-ffreestanding", "-fno-builtin", f"-I{ROOT / 'isa/include'}",
                     f"-I{options.build / 'runtime/math'}"]
    trax, riscv = Trax(options.build, work), Riscv(options.build, work, library=False)
    print(f"{'bytes of code':18} {'ray tracer':>10} {'rv32':>8} {'library':>10} {'rv32':>8}")
    for name, flags in SIZE_LEVELS.items():
        sizes = [code_bytes(machine, [*level, *extra], sources, work)
                 for sources, extra in (([RAY_TRACER], [*COMMON, *RAY_TRACER_FLAGS]), (library, library_flags))
                 for machine, level in ((trax, flags), (riscv, flags))]
        print(f"{name:18} {sizes[0]:10} {sizes[1]:8} {sizes[2]:10} {sizes[3]:8}")
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("kernels", nargs="*", metavar="KERNEL", help="measure these only (default: all)")
    parser.add_argument("--build", type=Path, required=True, help="the build folder")
    parser.add_argument("--short", action="store_true", help="against the column without contraction alone")
    parser.add_argument("--compile-time", action="store_true", help="compare compile times instead")
    parser.add_argument("--code-size", action="store_true", help="compare code sizes instead")
    parser.add_argument("--runs", type=int, default=15, help="of each compiler, for --compile-time (default: 15)")
    parser.add_argument("--keep", type=Path, metavar="DIRECTORY", help="leave objects and programs there")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(),
                        help="kernels at a time (default: as many as processors)")
    options = parser.parse_args()
    options.build = options.build.resolve()
    try:
        check_programs(options.build)
        with tempfile.TemporaryDirectory() as scratch:
            work = options.keep or Path(scratch)
            work.mkdir(parents=True, exist_ok=True)
            compare = (compare_compile_time if options.compile_time else
                       compare_code_size if options.code_size else compare_instructions)
            good = compare(options, work)
    except Failure as failure:
        print(f"quality.py: error: {failure}", file=sys.stderr)
        return 1
    return 0 if good else 2


if __name__ == "__main__":
    sys.exit(main())
