#!/usr/bin/env python3
"""Measures parallel work in cycles, for the tables of docs/parallel.md.

  parallel.py --build build [--chips 1x32,4x32]
"""

import argparse
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import interrupts  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--build", required=True, help="the build directory")
    parser.add_argument("--chips", default="1x32,4x32")
    options = parser.parse_args()
    interrupts.end_by_signals()
    programs = os.path.join(options.build, "bin")
    with tempfile.TemporaryDirectory() as directory:
        binary = os.path.join(directory, "costs")
        subprocess.run([os.path.join(programs, "clang"), "--target=trax", "-O2", "-fopenmp", "-mstack=global",
                        os.path.join(HERE, "parallel_costs.c"), "-o", binary], check=True)
        columns = {}
        for chip in ("one TP", *options.chips.split(",")):
            machine = [] if chip == "one TP" else ["--config", chip, "--main-on", "0"]
            lines = subprocess.run([os.path.join(programs, "trax-sim"), *machine, binary], check=True,
                                   capture_output=True, text=True).stdout.splitlines()
            columns[chip] = dict(line.split("|") for line in lines)
    print("| cycles |", " | ".join(columns), "|")
    print("| --- |" + " --- |" * len(columns))
    for what in columns["one TP"]:
        print(f"| {what} |", " | ".join(f"{int(column[what]):,}" for column in columns.values()), "|")
    return 0


if __name__ == "__main__":
    sys.exit(main())
