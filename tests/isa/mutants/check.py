#!/usr/bin/env python3
"""Does the conformance suite notice a wrong machine? Runs it against mutants of the reference engine.

    tests/isa/mutants/check.py [--build FOLDER] [--only EXPRESSION] [--every N] [--jobs N] [--verbose]

Every mutant is the machine with one thing wrong: an instruction's statement, a special case of an operation, a bit of
the decoder, a check, the report of a fault, the state at reset (mutants.h). A mutant is caught if an image of the suite
ends otherwise than its reference. Prints caught / total and names the survivors. Ends with status 1 if there is one
that equivalent.py does not explain, or one that it explains and that is caught.
"""

import argparse
import collections
import fnmatch
import json
import os
import pathlib
import re
import subprocess
import sys
import time

from equivalent import EQUIVALENT

SOURCE = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(SOURCE / "tests"))
from progress import Progress  # noqa: E402


def write_tests(suite, path):
    description = json.loads((suite / "suite.json").read_text())
    with open(path, "w") as file:
        for test in description["tests"]:
            status = "-" if test["status"] is None else test["status"]
            print(suite / (test["name"] + ".elf"), suite / (test["name"] + ".signature"), test["of"], test["tms"],
                  test["tps"], status,
                  test["output"].encode("latin-1").hex(), sep="\t", file=file)
    return description["memory_mib"], len(description["tests"])


def list_mutants(program):
    listing = subprocess.run([program, "--list"], check=True, capture_output=True, text=True).stdout
    return {int(number): (mnemonic, what) for number, mnemonic,
            what in (line.split("\t") for line in listing.splitlines())}


def name(mutant):
    return ": ".join(filter(None, mutant))


def reason(mutant):
    """Why it cannot be noticed; None if it can."""
    for pattern, why in EQUIVALENT:
        if fnmatch.fnmatchcase(name(mutant), pattern):
            return why
    return None


def select(mutants, options):
    wanted = re.compile(options.only)
    chosen = [number for number, mutant in mutants.items() if wanted.search(name(mutant))]
    if options.every == 0:  # the first of each instruction that can be noticed: for the others all images are run
        first = {}
        for number in chosen:
            if not reason(mutants[number]):
                first.setdefault(mutants[number][0], number)
        return list(first.values())
    return chosen[::options.every]


def run(program, tests, memory_mib, numbers, options):
    """The image that noticed each mutant, "-" if none did."""
    progress, noticed = Progress(len(numbers)), {}
    process = subprocess.Popen([program, tests, str(memory_mib), str(options.jobs)], stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)
    process.stdin.write("".join(f"{number}\n" for number in numbers))
    process.stdin.close()
    try:
        for line in process.stdout:
            number, image = line.rstrip("\n").split("\t")
            noticed[int(number)] = image
            progress.show(len(noticed), "mutants")
    finally:
        if process.poll() is None and len(noticed) < len(numbers):
            process.terminate()
        progress.clear()
    if process.wait() or len(noticed) != len(numbers):
        sys.exit(f"{program}: status {process.returncode}, {len(noticed)} of {len(numbers)} mutants were tried")
    return noticed


def report(mutants, noticed, options):
    """Whether every mutant was caught that can be."""
    bad = []
    explained = collections.Counter()
    for number in sorted(noticed):
        why, caught = reason(mutants[number]), noticed[number] != "-"
        if options.verbose:
            print(f"{number}\t{name(mutants[number])}\t{os.path.basename(noticed[number])}")
        if caught and why:
            bad.append(f"caught, though said to change nothing that can be seen: {name(mutants[number])}")
        elif not caught and not why:
            bad.append(f"SURVIVES: {number} {name(mutants[number])}")
        elif not caught:
            explained[why] += 1
    for line in bad:
        print(line)
    for why, count in explained.items():
        print(f"not counted, {count}: {why}")
    total = len(noticed) - sum(explained.values())
    caught = sum(image != "-" for image in noticed.values())
    print(f"{caught} / {total} mutants caught")
    return not bad


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--build", type=pathlib.Path, default=SOURCE / "build", help="the build folder; default build")
    parser.add_argument("--only", default="", metavar="EXPRESSION",
                        help="mutants whose instruction and text it is found in")
    parser.add_argument("--every", type=int, default=1, metavar="N",
                        help="every Nth of them; 0: the first of each instruction that can be noticed")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="mutants at the same time")
    parser.add_argument("--verbose", action="store_true", help="name the image that notices each mutant")
    options = parser.parse_args()
    if options.every < 0 or options.jobs < 1:
        parser.error("--every is 0 or more, --jobs is 1 or more")
    program = options.build / "tests/bin/trax-isa-mutants"
    if not program.exists() or not (options.build / "isa-suite/suite.json").exists():
        sys.exit(f"{options.build}: ninja -C {options.build} trax-isa-mutants isa-suite comes first")
    tests = options.build / f"isa-mutants.{os.getpid()}"
    mutants = list_mutants(program)
    numbers = select(mutants, options)
    begin = time.monotonic()
    try:
        memory_mib, count = write_tests(options.build / "isa-suite", tests)
        noticed = run(program, tests, memory_mib, numbers, options)
    finally:
        for path in options.build.glob(tests.name + "*"):
            path.unlink()
    good = report(mutants, noticed, options)
    print(f"{count} images, {time.monotonic() - begin:.0f} s")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
