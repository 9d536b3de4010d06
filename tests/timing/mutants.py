#!/usr/bin/env python3
"""Do the tests of time notice a wrong engine?

    mutants.py [SCRATCH] [--jobs N] [--only EXPRESSION]
    mutants.py --stale             only lists texts that are not there

Each mutant is one changed line of an engine. A copy of the tree is changed, built and tested until a test fails.
"""

import itertools
import os
import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from mutants_list import MUTANTS  # noqa: E402
from mutation import ROOT, Mutant, failure, main  # noqa: E402

SOURCE = ROOT / "emulator"
ENGINES = ["timing-engines-test", "--jobs", "1", "--stop", "--engine"]
MANY = "200"
# The quickest first, since it decides about most mutants.
TESTS = [(["timing-rules-test", "docs/timing-rules.md"], {}), (["timing-dram-test"], {})]
TESTS += [([f"timing-{name}-test"], {"TRAX_ENGINE": engine})
          for engine in ("fast", "reference") for name in ("runs", "faults")]
TESTS += [([*ENGINES, "fast-translated", "--count", "15"], {}), (["timing-bandwidth-test"], {}),
          (["timing-translated-test"], {}), (["timing-epochs-test"], {}), (["timing-checkpoint-test"], {}),
          (["timing-state-test"], {})]
TESTS += [([*ENGINES, engine, "--count", MANY], {}) for engine in ("fast-translated", "fast")]


def copy_sources(tree):
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True).stdout.split(b"\0")
    for name in filter(None, map(os.fsdecode, files)):
        source, target = ROOT / name, tree / name
        if not source.is_file() or (target.exists() and target.read_bytes() == source.read_bytes()):
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, target)


class Tree:
    """A copy of the sources, with a build. The fast engine is compiled once, not also for newer processors."""

    def __init__(self, folder):
        self.folder, self.changed = folder, None
        self.environment = os.environ | {"CCACHE_BASEDIR": str(folder)}  # one tree's objects serve the others
        copy_sources(folder)
        if not (folder / "build/build.ninja").exists():
            launcher = ["-DCMAKE_C_COMPILER_LAUNCHER=ccache",
                        "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
            subprocess.run(["cmake", "--preset", "release", "-DTRAX_FAST_AVX2=OFF", *launcher], cwd=folder,
                           env=self.environment, check=True, stdout=subprocess.DEVNULL)

    def change(self, mutant):
        """Makes the mutant's change the only one."""
        if self.changed not in (None, mutant.file):
            shutil.copy(SOURCE / self.changed, self.folder / "emulator" / self.changed)
        (self.folder / "emulator" / mutant.file).write_text(mutant.changed(SOURCE))
        self.changed = mutant.file

    def first_failure(self, mutant):
        """What notices first. Tests are linked when their turn comes."""
        for words, environment in TESTS:
            if subprocess.run(["ninja", "-C", self.folder / "build", "-j1", words[0]], capture_output=True,
                              env=self.environment, check=False).returncode:
                return "does not compile" if mutant.text == mutant.other else sys.exit(f"does not compile: {mutant}")
            program = self.folder / "build/tests/bin" / words[0]
            seconds = 120 if MANY in words else 20  # of a processor: some five times as many as without a mutant
            if why := failure(seconds, program, *words[1:], cwd=self.folder, env=os.environ | environment):
                return f"{' '.join(environment.values())} {why}".strip()
        return None


NUMBERS = itertools.count()
IDLE = []  # trees


def noticed(folder, _, mutant):
    """The first test that fails in a tree that no other mutant uses, beside the folder."""
    tree = IDLE.pop() if IDLE else Tree(folder.parent / f"tree{next(NUMBERS)}")
    tree.change(mutant)
    found = tree.first_failure(mutant)
    IDLE.append(tree)
    return [found] if found else []


def print_totals(results):
    """Of each engine: by counts derived by hand, not by comparison with another engine."""
    by_comparison = ("timing-engines", "timing-state", "timing-epochs", "timing-checkpoint")
    for kind in sorted({mutant.file.split("/")[0] for mutant, _ in results}):
        found = [said for mutant, said in results if mutant.file.startswith(kind + "/")]
        by_hand = sum(bool(said) and not said[0].startswith(by_comparison) for said in found)
        print(f"{kind}: {sum(map(bool, found))} of {len(found)} caught, {by_hand} by counts derived by hand")


if __name__ == "__main__":
    sys.exit(main(__doc__, SOURCE, [Mutant(*row) for row in MUTANTS], noticed, totals=print_totals))
