"""The programs of tests/c that are made for several threads and end well."""

import os
import re
import shlex
import sys

C = os.path.join(os.path.dirname(os.path.abspath(__file__)), "c")
# Marks of a program for several threads; the others run on one, and each thread of a larger machine prints the same.
SHARES = r"trax_thread|trax_atomic_inc|\b_Atomic\b|<stdatomic\.h>|<atomic>|<mutex>|<thread>|__atomic_"
OF_ONE_THREAD = {"atomic_single.c", "cxx_library.cpp", "machine_operations.c"}


def value(words, option):
    return words[words.index(option) + 1] if option in words else ""


def c_programs():
    """(source, the compiler's flags, the simulator's) of each way in which they are compiled and run."""
    found = set()
    for name in sorted(os.listdir(C)):
        if not name.endswith((".c", ".cpp")):
            continue
        with open(os.path.join(C, name), encoding="utf-8") as file:
            text = file.read().replace("\\\n// RUN:", "")
        lines = [shlex.split(line) for line in re.findall(r"RUN: %run_c %s %t(.*)", text)]
        lines = [words for words in lines if "--fault" not in words and "--clang-only" not in words]
        machines = [re.sub(r"--max-cycles \d+|--engine \w+", "", value(words, "--simflags")) for words in lines]
        ways = {(os.path.join(C, name), value(words, "--cflags"), machine) for words, machine in zip(lines, machines)
                if re.search(r"--config|chip\.t", machine)}
        if lines and not ways and re.search(SHARES, text) and name not in OF_ONE_THREAD:
            sys.exit(f"{name} runs on one thread only: is it for several?")
        found |= ways
    return sorted(found)
