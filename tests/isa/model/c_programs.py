#!/usr/bin/env python3
"""The C programs of tests/c on the machine made from the manual: they must print what is expected. Those that test
faults, and what the model lacks, are left out.

  c_programs.py --build build [--level -O2] [--only REGEX]
"""

import argparse
import os
import re
import shlex
import subprocess
import sys
import tempfile

SOURCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "c")
SECONDS = 300  # of a program


def expected_of(build, source):
    """The file of what a program prints: beside it, or made by the build."""
    beside = source[:-2] + ".expected"
    return beside if os.path.exists(beside) else os.path.join(build, "tests", "c", os.path.basename(beside))


def options_of(build, source):
    """What the program's %run_c line says, or None if it has no expected output to compare."""
    with open(source, encoding="utf-8") as file:
        text = file.read().replace("\\\n// RUN:", "")
    line = re.search(r"RUN: %run_c %s %t(.*)", text)
    if not line or not os.path.exists(expected_of(build, source)):
        return None
    words = shlex.split(line[1])
    if "--fault" in words or "--clang-only" in words:
        return None
    return dict(zip(words[::2], words[1::2]))


def machine_of(flags):
    """The model's options for the emulator's, or None if it lacks one."""
    known = {"chip.tms": "--tms", "chip.tps_per_tm": "--tps", "memory.size_mib": "--memory-mib"}
    words, result = shlex.split(flags), []
    for option, value in zip(words[::2], words[1::2]):
        key, _, number = value.partition("=")
        chip = re.fullmatch(r"(\d+)x(\d+)", value)
        if option == "--config" and chip:
            result += ["--tms", chip[1], "--tps", chip[2]]
        elif option == "--set" and key in known:
            result += [known[key], number]
        elif option != "--max-cycles":
            return None
    return result


def check(options, source, directory):
    """None if the program ran well, or what went wrong; False if it was left out."""
    asked = options_of(options.build, source)
    machine = machine_of(asked.get("--simflags", "")) if asked is not None else None
    if machine is None:
        return False
    binary = os.path.join(directory, "program")
    compiled = subprocess.run([os.path.join(options.build, "bin", "clang"), "--target=trax", options.level,
                               *shlex.split(asked.get("--cflags", "")), source, "-o", binary],
                              stderr=subprocess.PIPE, text=True, check=False)
    if compiled.returncode:
        return compiled.stderr
    try:
        result = subprocess.run([os.path.join(options.build, "tests", "bin", "trax-isa-model"), *machine, binary],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return f"it did not end in {SECONDS} s"
    with open(expected_of(options.build, source), "rb") as file:
        if result.stdout != file.read():
            return "it prints something else " + result.stderr.decode(errors="replace")
    status = int(asked.get("--status", "0"))
    return None if result.returncode == status else f"exit status {result.returncode}, not {status}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--build", required=True, help="the build directory")
    parser.add_argument("--level", default="-O2", help="the compiler's level")
    parser.add_argument("--only", default="", help="programs whose names match")
    options = parser.parse_args()
    good, bad, left_out = 0, 0, 0
    names = sorted(name for name in os.listdir(SOURCES) if name.endswith(".c") and re.search(options.only, name))
    with tempfile.TemporaryDirectory() as directory:
        for number, name in enumerate(names):
            result = check(options, os.path.join(SOURCES, name), directory)
            good += result is None
            left_out += result is False
            if result:
                bad += 1
                print(f"{name}: {result}")
            if sys.stderr.isatty():
                print(f"\r{number + 1} of {len(names)} ", end="", file=sys.stderr)
    print(f"{good} programs print what is expected, {bad} do not, {left_out} were left out")
    return bad != 0 or good == 0


if __name__ == "__main__":
    sys.exit(main())
