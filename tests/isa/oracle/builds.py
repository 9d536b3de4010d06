#!/usr/bin/env python3
"""The arithmetic of trax/semantics.h must not depend on the compiler, the level or the processor that it is compiled
for.

    tests/isa/oracle/builds.py --build build

Compiles builds.c with gcc and clang-19 at -O0 and -O3, and at -O3 for processors with fused multiply-add, with the
flags of the build, and compares the results with the oracle's. Then compiles with fast-math and the like, which must be
refused, and looks at the flags of all that the build compiles for the host: nothing may allow contraction, fast-math or
the x87. Exit status: 0 if all of that holds, 1 otherwise.
"""

import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
COMPILERS = ["gcc", "clang-19"]
FUSED = "-march=haswell"
REFUSED = [["-ffast-math"], ["-Ofast"], ["-ffinite-math-only"]]
REFUSED_BY_GCC = [["-funsafe-math-optimizations"], ["-freciprocal-math"], ["-fno-signed-zeros"], ["-mfpmath=387"]]
FORBIDDEN = re.compile(
    r"-Ofast|-ffast-math|-ffinite-math-only|-funsafe-math-optimizations|-fassociative-math|-freciprocal-math|"
    r"-fno-signed-zeros|-ffp-contract=(?!off)|-ffp-model=(?!strict|precise)|-mfpmath=.*387|-mno-sse2?|"
    r"-fdenormal-fp-math.*|"
    r"-frounding-math|-mdaz-ftz|-m32|-ffp-eval-method=(?!source)|-fexcess-precision=(?!standard)")


class Failure(Exception):
    pass


def commands(build):
    """(file, words) of everything that the build compiles for the host."""
    path = os.path.join(build, "compile_commands.json")
    try:
        with open(path, encoding="utf-8") as file:
            entries = json.load(file)
    except (OSError, ValueError) as error:
        raise Failure(f"{path}: {error}") from error
    return [(os.path.realpath(entry["file"]), shlex.split(entry["command"])) for entry in entries]


def flags_of(build, source):
    """The flags of one source as the build compiles it, without level, sanitizers and names of files."""
    for file, words in commands(build):
        if file == source:
            kept = [word for word in words[1:] if not re.match(r"-O|-o$|-c$|-g|-fsanitize|-fno-sanitize|-fno-omit|-M",
                                                               word)]
            return [word for word in kept if word != file and not word.endswith(".o")]
    raise Failure(f"{build}/compile_commands.json does not compile {source}")


def compiled(compiler, flags, output):
    words = [compiler, *flags, os.path.join(HERE, "builds.c"), "-o", output, "-lm"]
    return subprocess.run(words, capture_output=True, text=True, check=False)


def hashes(compiler, flags, folder, count):
    program = os.path.join(folder, "builds")
    done = compiled(compiler, flags, program)
    if done.returncode != 0:
        raise Failure(f"{compiler} {' '.join(flags)}: {done.stderr.strip()}")
    return subprocess.run([program, str(count)], capture_output=True, text=True, check=True).stdout.splitlines()


def differing(ours, theirs):
    return [a.split()[0] for a, b in zip(ours, theirs) if a != b] if len(ours) == len(theirs) else ["all"]


def check_results(flags, folder, count, fused):
    expected = hashes("gcc", flags + ["-O2", "-DBUILDS_ORACLE", os.path.join(HERE, "oracle.c")], folder, count)
    for compiler in COMPILERS:
        for level in [["-O0"], ["-O3"]] + ([["-O3", FUSED]] if fused else []):
            wrong = differing(hashes(compiler, flags + level, folder, count), expected)
            name = " ".join([compiler, *level])
            if wrong:
                raise Failure(f"{name}: {', '.join(wrong)} differ from the oracle")
            print(f"{name}: {len(expected)} operations, {count} pairs, the oracle's bits", flush=True)
    return expected


def check_refusals(flags, folder):
    for compiler in COMPILERS:
        for bad in REFUSED + (REFUSED_BY_GCC if compiler == "gcc" else []):
            done = compiled(compiler, flags + ["-O2", "-w"] + bad, os.path.join(folder, "refused"))
            if done.returncode == 0 or "trax/semantics.h needs" not in done.stderr:
                raise Failure(f"{compiler} {' '.join(bad)}: semantics.h does not refuse it")
            print(f"{compiler} {' '.join(bad)}: refused")


def check_contraction(flags, folder, count, expected):
    """Contraction could merge nothing, since every result passes the test for a NaN; where it can, the results show
    it."""
    for compiler in COMPILERS:
        fast = flags + ["-O3", FUSED, "-ffp-contract=fast"]
        wrong = differing(hashes(compiler, fast, folder, count), expected)
        mergeable = differing(hashes(compiler, fast + ["-DBUILDS_MERGEABLE"], folder, count), expected)
        if wrong or mergeable != ["multiply_add"]:
            raise Failure(
                f"{compiler} {FUSED} -ffp-contract=fast: {wrong or 'nothing'} differs, and {mergeable or 'nothing'} "
                "where the multiply-add can be merged")
        print(f"{compiler} {FUSED} -ffp-contract=fast: the oracle's bits; a multiply-add that can be merged differs")


def check_flags(build, folders, wrong_on_purpose):
    seen = 0
    for file, words in commands(build):
        if not any(file.startswith(os.path.realpath(folder) + os.sep)
                   for folder in folders) or file in wrong_on_purpose:
            continue
        seen += 1
        bad = [word for word in words if FORBIDDEN.fullmatch(word)]
        if bad:
            raise Failure(f"{file} is compiled with {' '.join(bad)}")
        if "-ffp-contract=off" not in words:
            raise Failure(f"{file} is compiled without -ffp-contract=off")
    if seen == 0:
        raise Failure(f"{build}/compile_commands.json compiles nothing of {' '.join(folders)}")
    print(f"{seen} files of the host's code: contraction is off, no fast-math")


def has_fused():
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
            words = set(file.read().split())
    except OSError:
        return False
    return {"fma", "avx2", "bmi1", "bmi2", "movbe", "f16c"} <= words


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--build", default=os.path.join(HERE, "../../../build"), help="the build folder")
    parser.add_argument("--count", type=int, default=1000000, help="pairs (default: 1000000)")
    options = parser.parse_args()
    top, fused = os.path.realpath(os.path.join(HERE, "../../..")), has_fused()
    try:
        flags = flags_of(options.build, os.path.join(os.path.realpath(HERE), "operations.c"))
        with tempfile.TemporaryDirectory() as folder:
            expected = check_results(flags, folder, options.count, fused)
            if fused:
                check_contraction(flags, folder, options.count, expected)
            check_refusals(flags, folder)
        check_flags(options.build, [os.path.join(top, name) for name in ("isa", "emulator", "raytracer", "tests/isa")],
                    [os.path.join(top, "tests/isa/mutants/arithmetic.c")])
    except Failure as failure:
        sys.exit(f"builds.py: {failure}")
    if not fused:
        print("this host has no fused multiply-add: nothing was run for a processor that has")


if __name__ == "__main__":
    main()
