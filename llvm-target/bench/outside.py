#!/usr/bin/env python3
"""Measures the code of programs that the compiler was not tuned for: libraries from the sources of Debian's packages,
unchanged, compiled by our clang and by Debian's clang-19 for 32-bit RISC-V.

    llvm-target/bench/outside.py --build build --work DIR [PROGRAM...]

It is run on request: it fetches some 20 MB with apt-get. DIR keeps the sources. outside/PROGRAM.c drives each program.
It counts executed instructions as quality.py does. Both sides link the runtime, each compiled by its own compiler, and
must compute the same checksum. A packer's output is checked by unpacking.

Exit status: 0 if what is required holds (geometric means: -O3 against -O3 at most 0.95, -O2 against -O2 at most 1.00),
2 if not, 1 if something failed.
"""

import argparse
import math
import os
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from machines import BENCH, ROOT, Failure, Riscv, Trax, check_counter, check_programs, run

sys.path.insert(0, str(ROOT / "tests/programs"))
import outside  # noqa: E402

LIMITS = {"-O3": 0.95, "-O2": 1.00}
FLAGS = ["-std=gnu17", "-fno-math-errno", "-w"]


class Program:
    """package: Debian's source. sources, include: patterns and folders in it. flags: further ones."""

    def __init__(self, package, sources, include=(".",), flags=(), without=()):
        self.package, self.sources, self.include, self.flags, self.without = package, sources, include, list(
            flags), without


NEWLIB = ["exp", "exp2", "exp_data", "log", "log_data", "log2", "log2_data", "pow", "pow_log_data", "math_err"]
MBEDTLS = ["library/aes.c", "library/chacha20.c", "library/md5.c", "library/sha1.c", "library/sha256.c",
           "library/sha512.c",
           "library/platform_util.c"]
PROGRAMS = {
    "brotli": Program("brotli", ["c/common/*.c", "c/enc/*.c", "c/dec/*.c"], ["c/include"]),
    "bzip2": Program("bzip2", ["blocksort.c", "bzlib.c", "compress.c", "crctable.c", "decompress.c", "huffman.c",
                               "randtable.c"],
                     flags=["-DBZ_NO_STDIO"]),
    "gsm": Program("libgsm", ["src/[acdglprst]*.c"], ["inc"], ["-DSASR", "-DNeedFunctionPrototypes=1"],
                   ["debug.c", "gsm_print.c", "toast.c", "toast_alaw.c", "toast_audio.c", "toast_lin.c",
                    "toast_ulaw.c"]),
    "jbigkit": Program("jbigkit", ["libjbig/jbig.c", "libjbig/jbig_ar.c"], ["libjbig"]),
    "libdeflate": Program("libdeflate", ["lib/deflate_*.c", "lib/utils.c"]),
    "libyaml": Program("libyaml", ["src/api.c", "src/parser.c", "src/reader.c", "src/scanner.c"], ["include"],
                       ['-DYAML_VERSION_STRING="0"', "-DYAML_VERSION_MAJOR=0", "-DYAML_VERSION_MINOR=0",
                        "-DYAML_VERSION_PATCH=0"]),
    "lua": Program("lua5.4", ["src/l*.c"], ["src"], ["-DLUA_USE_JUMPTABLE=0"],
                   ["lua.c", "luac.c", "linit.c", "liolib.c", "loslib.c", "loadlib.c", "ldblib.c"]),
    "lz4": Program("lz4", ["lib/lz4.c", "lib/lz4hc.c"], ["lib"]),
    "mbedtls": Program("mbedtls", MBEDTLS, ["include"]),
    "md4c": Program("md4c", ["src/*.c"], ["src"]),
    "xxhash": Program("xxhash", ["xxhash.c"]),
    "zlib": Program("zlib", ["adler32.c", "compress.c", "crc32.c", "deflate.c", "inf*.c", "trees.c", "uncompr.c",
                             "zutil.c"],
                    without=["infback.c"]),
}


class OutsideRiscv(Riscv):
    """With all of the runtime that runs on a host."""

    def make_library(self):
        objects = [self.work / "outside-riscv.o"]
        run([*self.compiler, "-O2", "-c", BENCH / "outside/riscv.c", "-o", objects[0]])
        small = ("posix", "stdio", "stdlib")
        for part in ("builtins", "heap", "math", "string", *small):
            for source in sorted((ROOT / "runtime" / part).glob("*.c")):
                objects.append(self.work / f"outside-{part}-{source.stem}.o")
                run([*self.compiler, "-std=c17", "-D_DEFAULT_SOURCE", "-O2", *(["-Os"] if part in small else []),
                     "-ffreestanding", "-fno-builtin",
                     "-fno-math-errno", "-ffunction-sections", f"-I{ROOT / 'isa/include'}",
                     f"-I{self.build / 'isa/include'}", f"-I{self.build / 'runtime/math'}", "-c", source,
                     "-o", objects[-1]])
        newlib = self.build / "runtime/newlib/libm/common"
        for name in NEWLIB:
            objects.append(self.work / f"outside-newlib-{name}.o")
            run([*self.compiler, "-std=c17", "-O2", "-ffreestanding", "-fno-math-errno", "-ffunction-sections", "-w",
                 "-include",
                 ROOT / "runtime/newlib/config.h", f"-I{ROOT / 'runtime/newlib'}", f"-I{newlib}", "-c",
                 newlib / f"{name}.c", "-o", objects[-1]])
        library = self.work / "outside.a"
        run(["llvm-ar-19", "rcs", library, *objects])
        return [library]


class OutsideTrax(Trax):
    """With large stacks."""

    def __init__(self, build, work):
        super().__init__(build, work)
        self.compiler += ["-mstack=global", "-mstack-size=256k"]


def sources_of(shop, program):
    """The files to compile, and the flags."""
    folder = shop.fetch(program.package)
    files = sorted({
        path
        for pattern in program.sources for path in folder.glob(pattern) if path.name not in program.without})
    return files, [*FLAGS, *program.flags, *(f"-I{folder / name}" for name in program.include)]


def measure(shop, machine, name, level):
    """(checksum, executed instructions of one repetition)"""
    files, flags = sources_of(shop, PROGRAMS[name])
    work = machine.work / f"{name}{level}-{machine.name}"
    work.mkdir(exist_ok=True)
    objects = []
    for source in [*files, BENCH / f"outside/{name}.c"]:
        objects.append(work / f"{len(objects)}.o")
        run([*machine.compiler, *flags, level, "-ffunction-sections", "-c", source, "-o", objects[-1]])
    driver, program = work / "driver.o", work / "program.elf"
    run([*machine.compiler, "-O3", "-c", BENCH / "driver.c", "-o", driver])
    machine.link([driver, *objects], program)
    counts = []
    for repetitions in "12":
        printed, count = machine.execute(program, repetitions)
        counts.append(count)
    return printed.split()[0], counts[1] - counts[0]


def compare(shop, machines, name):
    """One row: for each level ours and theirs; None, with a message, if it failed."""
    row = []
    try:
        for level in LIMITS:
            (ours, our_count), (theirs, their_count) = (measure(shop, machine, name, level) for machine in machines)
            if ours != theirs or ours == "00000000":
                raise Failure(f"{level}: trax computes {ours}, RISC-V {theirs}")
            row += [our_count, their_count]
    except Failure as failure:
        print(f"outside.py: error: {name}: {failure}", file=sys.stderr)
        return None
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("programs", nargs="*", metavar="PROGRAM", help="measure these only (default: all)")
    parser.add_argument("--build", type=Path, required=True, help="the build folder")
    parser.add_argument("--work", type=Path, required=True, help="keeps the sources")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(),
                        help="programs at a time (default: as many as processors)")
    options = parser.parse_args()
    chosen = options.programs or list(PROGRAMS)
    shop = outside.Workshop(options.build.resolve(), options.work.resolve(), "functional")
    shop.work.mkdir(parents=True, exist_ok=True)
    try:
        check_programs(options.build)
        unknown = [name for name in chosen if name not in PROGRAMS]
        if unknown:
            raise Failure(f"no program '{unknown[0]}'; there are {', '.join(PROGRAMS)}")
        if any(not (shop.work / "sources" / PROGRAMS[name].package / "unpacked").exists() for name in chosen):
            shop.apt("update")
        for name in chosen:  # one after the other: apt-get locks
            shop.fetch(PROGRAMS[name].package)
        with tempfile.TemporaryDirectory() as scratch, ThreadPoolExecutor(options.jobs) as pool:
            machines = OutsideTrax(options.build.resolve(),
                                   Path(scratch)), OutsideRiscv(options.build.resolve(), Path(scratch))
            for machine in machines:
                check_counter(machine)
            rows = dict(zip(chosen, pool.map(lambda name: compare(shop, machines, name), chosen)))
    except (Failure, RuntimeError) as failure:
        print(f"outside.py: error: {failure}", file=sys.stderr)
        return 1
    print(
        f"{'executed instructions':18} {'-O3 trax':>12} {'rv32':>10} {'ratio':>6} {'-O2 trax':>12} {'rv32':>10} "
        f"{'ratio':>6}"
    )
    measured = {name: row for name, row in rows.items() if row}
    for name, (ours3, theirs3, ours2, theirs2) in measured.items():
        print(f"{name:21} {ours3:9} {theirs3:10} {ours3 / theirs3:6.3f} {ours2:12} {theirs2:10} {ours2 / theirs2:6.3f}")
    if len(measured) < len(rows):
        return 1
    means = [math.exp(sum(math.log(row[i] / row[i + 1]) for row in rows.values()) / len(rows)) for i in (0, 2)]
    print(f"{'geometric mean':21} {'':20} {means[0]:6.3f} {'':23} {means[1]:6.3f}")
    print("required: at most " + ", ".join(f"{limit:.2f} at {level}" for level, limit in LIMITS.items()))
    return 0 if all(mean <= limit for mean, limit in zip(means, LIMITS.values())) else 2


if __name__ == "__main__":
    sys.exit(main())
