#!/usr/bin/env python3
"""Compile a C program for the TP at several optimization levels, run each on the emulator, compare what it prints.

    // RUN: %run_c %s %t
    // RUN: %run_c %s %t --levels -O2,-Os --cflags "-ffast-math" --simflags "--config 1x32" --status 3
    // RUN: %run_c %s %t --turns -O0,-O2,-Os  (at one of these levels; which one depends on the program and its flags)
    // RUN: %run_c %s %t --levels -O2 --also -O0      (at -O0 with TRAX_LEVELS=all alone)
    // RUN: %run_c %s %t --clang-only        (compile and link at every level, run nothing)
    // RUN: %run_c %s %t --slow              (of a program that takes seconds to compile: -O2, without the verifier)

Standard output must equal NAME.expected beside the program, byte for byte. Without that file it must equal the one in
the folder of --expected, which the build made on the host (c/CMakeLists.txt). The exit status must be the one given
(default 0). With --fault TEXT the program must end in a fault report that contains TEXT, once for each --fault, with
the status 1 or, if it aborts, the one given. Without --levels and --turns, the level is -O2, and for every third
program -O0, too. With TRAX_LEVELS=all in the environment, it is every one, and with --turns every one of these. The
compiler verifies its machine code at every step; with --slow it does so with TRAX_LEVELS=all. Exit status: 0 if every
level agrees, else 1 with the first difference of each level that does not.
"""

import argparse
import os
import shlex
import subprocess
import sys
import zlib

ALL_LEVELS = ["-O0", "-O1", "-O2", "-O3", "-Os", "-Oz"]
SECONDS = 600  # per step, on a busy machine; a program that hangs is a failure, not a wait
PROCESS = {}  # lit_programs.py: folder and environment of the steps


def run(command):
    """Run a command; return (status, stdout, stderr). A command that hangs gives the status None."""
    try:
        done = subprocess.run(command, capture_output=True, timeout=SECONDS, stdin=subprocess.DEVNULL, check=False,
                              **PROCESS)
    except subprocess.TimeoutExpired as expired:
        return None, expired.stdout or b"", expired.stderr or b""
    return done.returncode, done.stdout, done.stderr


def describe(command, status, error):
    what = "did not end" if status is None else f"ended with status {status}"
    return f"{shlex.join(command)}\n  {what}\n{error.decode(errors='replace')}"


def check_output(expected, output):
    if output == expected:
        return None
    import difflib  # here, since its import takes as long as the run of a small program

    difference = difflib.unified_diff(
        expected.decode(errors="replace").splitlines(), output.decode(errors="replace").splitlines(), "expected",
        "printed",
        lineterm="", n=1)
    return "\n".join(list(difference)[:40]) or "the output differs in its line ends"


def whole():
    return os.environ.get("TRAX_LEVELS") == "all"


def check_level(options, level, expected):
    """Compile and run at one level; return None or what went wrong."""
    binary = f"{options.binary}{level}"
    verifier = [] if options.slow and not whole() else ["-mllvm", "-verify-machineinstrs"]
    compile_command = [options.clang, "--target=trax", level, "-g", "-Wall", "-Werror", *verifier,
                       *shlex.split(options.cflags), options.source, "-o", binary]
    status, _, error = run(compile_command)
    if status != 0:
        return describe(compile_command, status, error)
    if options.clang_only:
        return None
    command = [options.sim, *shlex.split(options.simflags), binary]
    status, output, error = run(command)
    if status != (options.status or (1 if options.fault else 0)):
        return describe(command, status, error) + output.decode(errors="replace")[-2000:]
    for text in options.fault:
        if text not in error.decode(errors="replace"):
            return (f"{shlex.join(command)}\n  the fault report does not contain '{text}':\n"
                    f"{error.decode(errors='replace')}")
    return None if expected is None else check_output(expected, output)


def levels_of(options):
    if options.levels:
        return (options.levels + (f",{options.also}" if options.also and whole() else "")).split(",")
    name = os.path.basename(options.source)
    if options.turns:
        levels = options.turns.split(",")
        return levels if whole() else [levels[zlib.crc32((name + options.cflags).encode()) % len(levels)]]
    if whole():
        return ALL_LEVELS
    return ["-O0", "-O2"] if not options.slow and zlib.crc32(name.encode()) % 3 == 0 else ["-O2"]


def main(arguments):
    parser = argparse.ArgumentParser(description="Compile, run and compare a C program at several optimization levels.")
    parser.add_argument("source")
    parser.add_argument("binary", help="where the programs go; the level is appended")
    parser.add_argument("--clang", required=True)
    parser.add_argument("--sim", required=True)
    parser.add_argument("--expected", required=True,
                        help="a folder of expected outputs that are not beside their programs")
    parser.add_argument("--levels", help="comma separated (default: -O2, for every third program -O0, too)")
    parser.add_argument("--turns", help="comma separated: one of them, and all with TRAX_LEVELS=all")
    parser.add_argument("--also", help="more levels with TRAX_LEVELS=all")
    parser.add_argument("--cflags", default="")
    parser.add_argument("--simflags", default="")
    parser.add_argument("--status", type=int, default=0)
    parser.add_argument("--fault", action="append", default=[])
    parser.add_argument("--clang-only", action="store_true")
    parser.add_argument("--slow", action="store_true", help="by default at -O2 alone, not verified")
    # Values such as -O2 or --config begin with a dash: join them to their option first.
    takes_value = {"--levels", "--turns", "--also", "--cflags", "--simflags", "--fault"}
    joined = []
    while arguments:
        argument = arguments.pop(0)
        joined.append(f"{argument}={arguments.pop(0)}" if argument in takes_value and arguments else argument)
    options = parser.parse_args(joined)

    beside = os.path.splitext(options.source)[0] + ".expected"
    made = os.path.join(options.expected, os.path.basename(beside))
    path = beside if os.path.exists(beside) else made
    expected = None
    if os.path.exists(path):
        with open(path, "rb") as file:
            expected = file.read()
    elif not options.clang_only and not options.fault:
        print(f"run_c.py: error: {beside} is missing", file=sys.stderr)
        return 1

    failed = False
    for level in levels_of(options):
        problem = check_level(options, level, expected)
        if problem:
            print(f"{options.source} at {level}:\n{problem}", file=sys.stderr)
            failed = True
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
