#!/usr/bin/env python3
"""The greatest errors of the binary64 functions, as docs/results/functions.md has them.

    worst.py --measure [--count N] [--seed N]   searches (math64-worst; a few minutes on two idle cores), from the
                                                operands in found.csv on, writes found.csv, then does what --update does
    worst.py --update                           writes the table of docs/results/functions.md from found.csv
    worst.py --check                            exit status 1 if the table is not that of found.csv

test-math64 computes the errors of found.csv again.
"""

import argparse
import concurrent.futures
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
import interrupts  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
FOUND = HERE / "found.csv"
PAGE = ROOT / "docs/results/functions.md"
BEGIN, END = "<!-- worst.py: begin -->\n", "<!-- worst.py: end -->\n"


def replace(path, text):
    new = path.with_name(path.name + ".new")
    new.write_text(text, encoding="utf-8")
    new.rename(path)


def functions():
    return [line.split(",")[0] for line in FOUND.read_text(encoding="ascii").splitlines()]


def measure(options):
    command = [options.bin / "../tests/bin/math64-worst", "--count", str(options.count), "--seed", str(options.seed),
               "--start", FOUND]

    def search(name):
        return subprocess.run([*command, name], stdout=subprocess.PIPE, stdin=subprocess.DEVNULL,
                              check=True).stdout.decode()

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        replace(FOUND, "".join(pool.map(search, functions())))


def row(line):
    name, _, _, share, *worst = line.split(",")
    name = {"lgamma-": "`lgamma`, negative"}.get(name, f"`{name}`")
    if not worst:
        return f"| {name} | 0 |  | 0 |"
    error, *operand = worst[0].split()
    return f"| {name} | {error} | {', '.join(operand)} | {share} % |" if float(
        share) else f"| {name} | {error} | {', '.join(operand)} | 0 |"


def table():
    lines = ["| function | greatest error | at | not correctly rounded |", "| --- | --- | --- | --- |"]
    return "\n".join(lines + [row(line) for line in FOUND.read_text(encoding="ascii").splitlines()]) + "\n"


def parts():
    page = PAGE.read_text(encoding="utf-8")
    if page.count(BEGIN) != 1 or page.count(END) != 1:
        sys.exit(f"worst.py: {PAGE}: the marks of the table are missing")
    before, rest = page.split(BEGIN)
    return before, rest.split(END)[0], rest.split(END)[1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--measure", action="store_true", help="search, then --update")
    what.add_argument("--update", action="store_true", help="write the table of docs/results/functions.md")
    what.add_argument("--check", action="store_true", help="compare the table with found.csv")
    parser.add_argument("--count", type=int, default=10_000_000,
                        help="operands of each function (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2, help="functions at a time (default: %(default)s)")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/bin")
    options = parser.parse_args()
    interrupts.end_by_signals()
    if options.measure:
        measure(options)
    before, old, after = parts()
    if options.check:
        if old != table():
            sys.exit("worst.py: docs/results/functions.md differs from found.csv: run worst.py --update")
        return
    replace(PAGE, before + BEGIN + table() + END + after)


main()
