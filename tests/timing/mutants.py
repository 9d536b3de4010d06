#!/usr/bin/env python3
"""Do the tests of time notice a wrong engine?

    mutants.py SCRATCH [--only EXPRESSION]     only mutants in whose file or lines it is found
    mutants.py --stale                         only lists texts that are not there

Each mutant is one changed line of an engine. A copy of the tree is changed, built and tested; a mutant that no test
notices is named.
"""

import os
import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from mutants_list import MUTANTS  # noqa: E402
from mutation import ROOT, Mutant, failure, main  # noqa: E402

SOURCE = ROOT / "emulator"
HAND = ["runs", "faults"]
TESTS = [(["timing-rules-test", "docs/timing-rules.md"], {}), (["timing-dram-test"], {})]
TESTS += [([f"timing-{name}-test"], {"TRAX_ENGINE": engine}) for engine in ("fast", "reference") for name in HAND]
TESTS += [(["timing-bandwidth-test"], {})]
TESTS += [(["timing-translated-test"], {})]
TESTS += [(["timing-engines-test", "--engine", engine, "--count", "200", "--jobs", "2", "--stop"], {})
          for engine in ("fast-translated", "fast")]
TESTS += [(["timing-state-test"], {}),
          (["timing-epochs-test"], {}), (["timing-checkpoint-test"], {})]
SECONDS = 60  # of a processor, that a test may take
TARGETS = sorted({test[0][0] for test in TESTS})


def copy_tree(tree):
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True).stdout.split(b"\0")
    for name in filter(None, map(os.fsdecode, files)):
        source, target = ROOT / name, tree / name
        if not source.is_file() or (target.exists() and target.read_bytes() == source.read_bytes()):
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, target)


def build(tree):
    return subprocess.run(["ninja", "-C", tree / "build", "-j2", *TARGETS], capture_output=True, text=True)


def first_failure(tree):
    """The number of the first test that fails; None if none does."""
    for i, (command, environment) in enumerate(TESTS):
        program = tree / "build/tests/bin" / command[0]
        if failure(SECONDS, program, *command[1:], cwd=tree, env=os.environ | environment):
            return i
    return None


def tree_for(folder):
    """A built copy of the sources beside the folder."""
    tree = folder.parent / "tree"
    copy_tree(tree)
    if not (tree / "build/build.ninja").exists():
        launcher = ["-DCMAKE_C_COMPILER_LAUNCHER=ccache",
                    "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        subprocess.run(["cmake", "--preset", "release", *launcher], cwd=tree, check=True, stdout=subprocess.DEVNULL)
    return tree


def noticed(folder, _, mutant):
    """The first test that fails in a copy of the tree."""
    tree = tree_for(folder)
    (tree / "emulator" / mutant.file).write_text(mutant.changed(SOURCE))
    if build(tree).returncode:
        return ["does not compile"] if mutant.text == mutant.other else sys.exit(f"does not compile: {mutant}")
    test = first_failure(tree)
    if test is None:
        return []
    words, environment = TESTS[test]
    return [f"{' '.join(environment.values())} {words[0]}".strip()]


def print_totals(results):
    """Of each engine: by counts derived by hand, not by comparison with another engine."""
    by_comparison = ("timing-engines", "timing-state", "timing-epochs", "timing-checkpoint")
    for kind in sorted({mutant.file.split("/")[0] for mutant, _ in results}):
        found = [said for mutant, said in results if mutant.file.startswith(kind + "/")]
        by_hand = sum(bool(said) and not said[0].startswith(by_comparison) for said in found)
        print(f"{kind}: {sum(map(bool, found))} of {len(found)} caught, {by_hand} by counts derived by hand")


if __name__ == "__main__":
    sys.exit(main(__doc__, SOURCE, [Mutant(*row) for row in MUTANTS], noticed, totals=print_totals))
