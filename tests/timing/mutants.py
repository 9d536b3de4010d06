#!/usr/bin/env python3
"""Do the tests of time notice a wrong engine?

Each mutant is one changed line of an engine. A copy of the tree is changed, built and tested; a mutant that no test
notices survives, and is named. Ends with status 1 if one does, or if a line to be changed is not there any more.

    tests/timing/mutants.py SCRATCH [--only EXPRESSION]     only mutants in whose file or lines it is found
    tests/timing/mutants.py --stale                         only lines that are not there any more
"""

import argparse
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys

from mutants_list import MUTANTS

SOURCE = pathlib.Path(__file__).resolve().parents[2]
HAND = ["runs", "faults"]
TESTS = [(["timing-rules-test", "docs/timing-rules.md"], {}), (["timing-dram-test"], {})]
TESTS += [([f"timing-{name}-test"], {"TRAX_ENGINE": engine}) for engine in ("fast", "reference") for name in HAND]
TESTS += [(["timing-bandwidth-test"], {})]
TESTS += [(["timing-engines-test", "--count", "200", "--jobs", "2", "--stop"], {}), (["timing-state-test"], {}),
          (["timing-epochs-test"], {}), (["timing-checkpoint-test"], {})]
SECONDS = 60  # of a processor, that a test may take
TARGETS = sorted({test[0][0] for test in TESTS})


def copy_tree(tree):
    files = subprocess.run(["git", "ls-files", "-z"], cwd=SOURCE, check=True, capture_output=True).stdout.split(b"\0")
    for name in filter(None, map(os.fsdecode, files)):
        source, target = SOURCE / name, tree / name
        if not source.is_file() or (target.exists() and target.read_bytes() == source.read_bytes()):
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, target)


def build(tree):
    return subprocess.run(["ninja", "-C", tree / "build", "-j2", *TARGETS], capture_output=True, text=True)


def limit():
    """A test that goes on for ever ends by the host's time that it takes itself, however much others leave of it."""
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))


def first_failure(tree):
    """The number of the first test that fails; None if none does."""
    for i, (command, environment) in enumerate(TESTS):
        try:
            status = subprocess.run([tree / "build/tests/bin" / command[0], *command[1:]], cwd=tree,
                                    env=os.environ | environment,
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=10 * SECONDS,
                                    preexec_fn=limit).returncode
        except subprocess.TimeoutExpired:
            status = "timeout"
        if status:
            return i
    return None


def try_mutant(tree, name, old, new):
    file = tree / "emulator" / name
    text = file.read_text()
    if text.count(old) != 1:
        return "stale" if old not in text else "ambiguous"
    file.write_text(text.replace(old, new))
    try:
        if build(tree).returncode:
            return "does not compile"
        test = first_failure(tree)
    finally:
        file.write_text(text)
    if test is None:
        return "SURVIVES"
    command, environment = TESTS[test]
    return f"{' '.join(environment.values())} {command[0]}".strip()


def list_stale():
    stale = [(name, old) for name, old, _ in MUTANTS if (SOURCE / "emulator" / name).read_text().count(old) != 1]
    for name, old in stale:
        print(f"{name}: {old.strip()}")
    print(f"{len(stale)} of {len(MUTANTS)} mutants are stale")
    return bool(stale)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scratch", type=pathlib.Path, nargs="?")
    parser.add_argument("--only", default="")
    parser.add_argument("--stale", action="store_true")
    options = parser.parse_args()
    if options.stale:
        return list_stale()
    if not options.scratch:
        parser.error("a folder to work in is needed")
    tree = options.scratch.resolve() / "tree"
    copy_tree(tree)
    if not (tree / "build/build.ninja").exists():
        launcher = ["-DCMAKE_C_COMPILER_LAUNCHER=ccache",
                    "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        subprocess.run(["cmake", "--preset", "release", *launcher], cwd=tree, check=True, stdout=subprocess.DEVNULL)
    if build(tree).returncode or first_failure(tree) is not None:
        sys.exit("mutants.py: the tests fail without a mutant")
    totals = {}
    for name, old, new in MUTANTS:
        if not re.search(options.only, name + old + new):
            continue
        outcome = try_mutant(tree, name, old, new)
        kind = name.split("/")[0]
        caught = totals.setdefault(kind, [0, 0, 0])
        caught[2] += 1
        if "-test" in outcome:
            caught[0] += 1
            caught[1] += not outcome.startswith(("timing-engines", "timing-state", "timing-epochs",
                                                 "timing-checkpoint"))
        print(f"{outcome:28} {name}: {old.strip()}  ->  {new.strip()}", flush=True)
    for kind, (caught, by_hand, total) in totals.items():
        print(f"{kind}: {caught} of {total} caught, {by_hand} by counts derived by hand")
    return any(caught != total for caught, _, total in totals.values())


if __name__ == "__main__":
    sys.exit(main())
