#!/usr/bin/env python3
"""How good is the code? Executed instructions of our clang against Debian's clang-19 for 32-bit RISC-V, kernel by kernel.

    llvm-target/bench/quality.py --build build [KERNEL...]

Both compilers have -O3 and the same flags; RISC-V is rv32im_zfinx, which has 32 registers for integers and floats alike, as ours,
besides a divide, a square root and a fused multiply-add, which ours has not. It contracts to the latter by default; the last
columns say what it does with -ffp-contract=off. A kernel's instructions are those of two repetitions less those of one, so
that start-up does not count. Ours are counted by trax-sim, RISC-V's by qemu-riscv32 with a plugin; both are tried on a loop that was
counted by hand. Both link the same library, compiled by the compiler that is measured.

Every result is compared with the same source's on the host: equal to the bit without contraction, within 0.1 % with it.

Exit status: 0 if the geometric mean is at most 1.00 and no kernel above 1.15; 2 if not; 1 if something failed.
"""

import argparse
import json
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

BENCH = Path(__file__).resolve().parent
ROOT = BENCH.parent.parent
GEOMETRIC_MEAN_LIMIT = 1.00
KERNEL_LIMIT = 1.15
CONTRACTION_TOLERANCE = 1e-3
SECONDS = 600

COMMON = ["-std=c17", "-fno-math-errno", "-Wall", "-Wextra", "-Werror", "-I", str(ROOT / "raytracer/device"), "-I",
          str(ROOT / "raytracer/include")]
RISCV = ["--target=riscv32", "-march=rv32im_zfinx", "-mabi=ilp32"]
PACKAGES = {"clang-19": "clang-19", "llvm-ar-19": "llvm-19", "ld.lld-19": "lld-19", "qemu-riscv32": "qemu-user", "cc": "gcc"}


class Failure(Exception):
    """What ends the program with a message."""


def run(command):
    """Run a command; return what it printed to standard output and to standard error."""
    try:
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=SECONDS, check=False,
                              stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired as expired:
        raise Failure(f"{' '.join(map(str, command))}\n  did not end in {SECONDS} s") from expired
    if done.returncode != 0:
        raise Failure(f"{' '.join(map(str, command))}\n  ended with status {done.returncode}\n{done.stderr}{done.stdout}")
    return done.stdout, done.stderr


class Trax:
    """Our compiler, counted by the simulator."""

    def __init__(self, build, work, name="trax", flags=()):
        self.build, self.work, self.name, self.flags = build, work, name, list(flags)

    def compile(self, source, output, flags):
        run([self.build / "bin/clang", "--target=trax", *flags, *self.flags, "-c", source, "-o", output])

    def link(self, objects, output):
        run([self.build / "bin/clang", "--target=trax", *objects, "-o", output])

    def execute(self, program):
        """Run a program; return what it printed and how many instructions it took."""
        statistics = program.with_suffix(".json")
        printed, _ = run([self.build / "bin/trax-sim", "--engine", "fast", "--quiet", "--stats", statistics, program])
        return printed, json.loads(statistics.read_text())["instructions"]


class Riscv:
    """Debian's clang for RISC-V, counted by qemu."""

    def __init__(self, build, work, name="riscv", flags=()):
        self.headers, self.work, self.name = build / "lib/trax/include", work, name
        self.flags = [*RISCV, "-nostdlibinc", "-isystem", str(self.headers), *flags]
        self.plugin = work / "count.so"
        run(["cc", "-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", BENCH / "count_plugin.c", "-o", self.plugin])
        self.library = self.make_library()

    def compile(self, source, output, flags):
        run(["clang-19", *self.flags, "-I", BENCH / "twin", *flags, "-c", source, "-o", output])

    def make_library(self):
        """The runtime's functions, compiled as the runtime compiles them."""
        objects = []
        for part in ("builtins", "math", "string"):
            for source in sorted((ROOT / "runtime" / part).glob("*.c")):
                objects.append(self.work / f"{self.name}-{part}-{source.stem}.o")
                self.compile(source, objects[-1], ["-std=c17", "-O2", "-ffreestanding", "-fno-builtin", "-ffunction-sections",
                                                   f"-I{ROOT / 'isa/include'}"])
        library = self.work / f"{self.name}.a"
        run(["llvm-ar-19", "rcs", library, *objects])
        return library

    def link(self, objects, output):
        run(["ld.lld-19", "--gc-sections", *objects, self.library, "-o", output])

    def execute(self, program):
        printed, counted = run(["qemu-riscv32", "-cpu", "rv32,zfinx=true,f=false,d=false", "-plugin", self.plugin, program])
        return printed, int(counted.split()[1])


class Host:
    """The host's own results, which the others must have."""

    def __init__(self, work, name, flags=()):
        self.work, self.name, self.flags = work, name, list(flags)

    def compile(self, source, output, flags):
        run(["clang-19", *self.flags, "-ffp-contract=off", "-I", BENCH / "twin", *flags, "-c", source, "-o", output])

    def link(self, objects, output):
        run(["clang-19", *objects, "-lm", "-o", output])

    def execute(self, program):
        return run([program])[0], None


def build_and_run(machine, source, repetitions, flags=()):
    """Compile and link a kernel and its driver; return (checksum, measure, executed instructions)."""
    stem = machine.work / f"{machine.name}-{source.stem}-{repetitions}"
    kernel, driver, program = stem.with_suffix(".kernel.o"), stem.with_suffix(".driver.o"), stem.with_suffix(".elf")
    machine.compile(source, kernel, [*COMMON, "-O3", *flags])
    machine.compile(BENCH / "driver.c", driver, [*COMMON, "-O3", f"-DREPETITIONS={repetitions}"])
    machine.link([driver, kernel], program)
    printed, count = machine.execute(program)
    try:
        checksum, measure = (int(word, 16) for word in printed.split())
    except ValueError as error:
        raise Failure(f"{program} printed {printed!r}") from error
    return checksum, struct.unpack("<f", struct.pack("<I", measure))[0], count


def measure_kernel(machine, source):
    """Return a kernel's result and how many instructions a repetition executes."""
    _, _, once = build_and_run(machine, source, 1)
    checksum, measure, twice = build_and_run(machine, source, 2)
    return checksum, measure, twice - once


def check_counter(machine):
    """A counter must count a loop of three instructions, and nothing else, right."""
    counts = [build_and_run(machine, BENCH / "counted_loop.c", 1, [f"-DITERATIONS={n}"])[2] for n in (100000, 200000)]
    if counts[1] - counts[0] != 300000:
        raise Failure(f"the counter of {machine.name} finds {counts[1] - counts[0]} instructions in a loop of 300000")


def check_result(name, machine, found, expected):
    if found != expected:
        raise Failure(f"{name}: {machine.name} computes {found[0]:08x} {found[1]:.9g}, the host {expected[0]:08x} {expected[1]:.9g}")


def check_contracted(name, machine, found, expected):
    """Contraction may change bits, but only where there are floats, and not what comes out."""
    if expected[1] == 0:
        check_result(name, machine, found, expected)
    elif not abs(found[1] - expected[1]) <= CONTRACTION_TOLERANCE * abs(expected[1]):
        raise Failure(f"{name}: contracted, {machine.name} computes {found[1]:.9g}, the host {expected[1]:.9g}")


class Machines:
    def __init__(self, build, work):
        self.trax = Trax(build, work)
        self.riscv = Riscv(build, work)
        self.riscv_strict = Riscv(build, work, "riscv-strict", ["-ffp-contract=off"])
        self.host = Host(work, "host")
        self.host_exact = Host(work, "host-exact", ["-DEXACT_RSQRT"])

    def measure(self, source):
        """Return (ours, RISC-V's, RISC-V's without contraction), executed instructions of one repetition."""
        name = source.stem
        *ours, our_count = measure_kernel(self.trax, source)
        *theirs, their_count = measure_kernel(self.riscv, source)
        *strict, strict_count = measure_kernel(self.riscv_strict, source)
        expected = list(build_and_run(self.host, source, 2)[:2])
        check_result(name, self.trax, ours, list(build_and_run(self.host_exact, source, 2)[:2]))
        check_result(name, self.riscv_strict, strict, expected)
        check_contracted(name, self.riscv, theirs, expected)
        return our_count, their_count, strict_count


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def report(names, counts):
    """Print the table; return whether it is good enough."""
    print(f"{'kernel':20} {'trax':>10} {'rv32':>10} {'ratio':>6}   {'rv32, contraction off':>21} {'ratio':>6}")
    ratios, strict_ratios = [], []
    for name, (ours, theirs, strict) in zip(names, counts):
        ratios.append(ours / theirs)
        strict_ratios.append(ours / strict)
        mark = " *" if ratios[-1] > KERNEL_LIMIT else "  "
        print(f"{name:20} {ours:10} {theirs:10} {ratios[-1]:6.3f}{mark} {strict:21} {strict_ratios[-1]:6.3f}")
    mean, worst = geometric_mean(ratios), max(range(len(names)), key=lambda i: ratios[i])
    print(f"{'geometric mean':20} {'':10} {'':10} {mean:6.3f}   {'':21} {geometric_mean(strict_ratios):6.3f}")
    print(f"worst: {names[worst]} {ratios[worst]:.3f}; required: mean at most {GEOMETRIC_MEAN_LIMIT:.2f}, "
          f"none above {KERNEL_LIMIT:.2f} (*)")
    return mean <= GEOMETRIC_MEAN_LIMIT and ratios[worst] <= KERNEL_LIMIT


def check_programs(build):
    missing = [program for program in PACKAGES if not shutil.which(program)]
    if missing:
        raise Failure(f"not found: {', '.join(missing)}; Debian: apt-get install {' '.join(PACKAGES[p] for p in missing)}")
    for program in (build / "bin/clang", build / "bin/trax-sim", build / "lib/trax/libc.a"):
        if not program.exists():
            raise Failure(f"{program} is missing; build it first (ninja -C {build})")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kernels", nargs="*", metavar="KERNEL", help="measure these only (default: all)")
    parser.add_argument("--build", type=Path, required=True, help="the build folder")
    parser.add_argument("--keep", type=Path, metavar="DIRECTORY", help="leave objects and programs there")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    sources = {path.stem: path for path in sorted((BENCH / "kernels").glob("*.c"))}
    names = options.kernels or list(sources)
    for name in names:
        if name not in sources:
            parser.error(f"no kernel '{name}'; there are {', '.join(sources)}")
    try:
        check_programs(options.build)
        with tempfile.TemporaryDirectory() as scratch:
            work = options.keep or Path(scratch)
            work.mkdir(parents=True, exist_ok=True)
            machines = Machines(options.build.resolve(), work)
            check_counter(machines.trax)
            check_counter(machines.riscv)
            with ThreadPoolExecutor(options.jobs) as pool:
                counts = list(pool.map(lambda name: machines.measure(sources[name]), names))
        return 0 if report(names, counts) else 2
    except Failure as failure:
        print(f"quality.py: error: {failure}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
