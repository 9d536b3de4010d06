"""The driver of the lists of mutants: changed lines of the sources, each of which some test must notice.

    mutants.py [SCRATCH] [--build build] [--only EXPRESSION]    tries those in whose name, file or lines it is found
    mutants.py --stale                                          lists texts that are not exactly once in their file

Needs a finished build, which is not changed. Exit status 0 if every mutant is noticed.
"""

import argparse
import concurrent.futures
import itertools
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import tempfile
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parents[1]


class Mutant(NamedTuple):
    file: str  # below the sources of the list
    text: str  # which is there once
    other: str  # what it becomes
    name: str = ""
    case: str = ""  # the only one that is tried

    def __str__(self):
        return ": ".join(filter(None, (self.name or f"{self.file}: {self.text.strip()}  ->  {self.other.strip()}",
                                       self.case)))

    def changed(self, sources):
        return (sources / self.file).read_text().replace(self.text, self.other)


def command(build, output):
    """How ninja makes the output, as words."""
    last = subprocess.run(["ninja", "-C", str(build), "-t", "commands", output], check=True, capture_output=True,
                          text=True).stdout.splitlines()[-1]
    return shlex.split(next(part for part in last.split(" && ") if part.split()[0] not in ("cd", ":")))


def compile_as(build, output, source, other, made, *options):
    """Compiles another source as ninja compiles the source of this output."""
    words = command(build, output)
    words[words.index(str(source))] = other
    words[words.index("-MF") + 1] = os.devnull
    words[words.index("-o") + 1] = made
    subprocess.run([*words, *options, "-w"], check=True, cwd=build)


def link_as(build, output, made, objects, without=()):
    """Links as ninja links the output, with the objects before the archives, so that they take the place of the same
    ones there."""
    words = [word for word in command(build, output) if not word.endswith(tuple(without))]
    at = next(i for i, word in enumerate(words) if word.endswith(".a"))
    words[words.index("-o") + 1] = made
    subprocess.run([*words[:at], *objects, *words[at:]], check=True, cwd=build)


def relinked(folder, build, target, source, text, tests):
    """Programs like these tests, with the text in the place of the source of the target's library, or of a header of
    some of its sources."""
    (folder / source.name).write_text(text)
    units, made = [source], []
    if source.suffix == ".h":
        units = [unit for unit in source.parent.glob("*.c") if f'#include "{source.name}"' in unit.read_text()]
    for unit in units:
        changed = folder / unit.name  # beside a changed header
        if unit != source:
            changed.write_text(unit.read_text())
        made.append(folder / f"{unit.name}.o")
        compile_as(build, f"{target}/{unit.name}.o", unit, changed, made[-1], f"-I{source.parent}")
    for test in tests:
        link_as(build, f"tests/bin/{test}", folder / test, made)
    return [folder / test for test in tests]


def ended(seconds, program, *words, **options):
    """The finished program; None if it does not end. It has so many seconds of a processor, however much others leave
    of the host, and many times as long to wait."""
    try:
        done = subprocess.run(["prlimit", f"--cpu={seconds}", program, *map(str, words)], capture_output=True,
                              text=True, errors="replace", timeout=60 * seconds, check=False, **options)
    except subprocess.TimeoutExpired:
        return None
    return None if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL) else done


def failure(seconds, program, *words, **options):
    """Why the program does not end with status 0; None if it does."""
    done = ended(seconds, program, *words, **options)
    return f"{program.name} does not end" if done is None else program.name if done.returncode else None


def list_stale(sources, mutants):
    stale = [(one, count) for one in mutants if (count := (sources / one.file).read_text().count(one.text)) != 1]
    for one, count in stale:
        print(f"{one}: {one.file}: {count} times there: {one.text}")
    print(f"{len(stale)} of {len(mutants)} mutants are stale")
    return bool(stale)


def main(description, sources, mutants, noticed, unchanged=lambda mutant: "", totals=None):
    """Tries mutants of files below the folder `sources`. noticed(folder, build, mutant) says which tests notice one, in
    a new folder. First it is called with mutants that change nothing, one for each value of unchanged(mutant).
    Several are tried at once, each in its folder. totals(results) prints more about (mutant, said). The exit status."""
    parser = argparse.ArgumentParser(description=description.split("\n")[0])
    parser.add_argument("scratch", type=pathlib.Path, nargs="?", help="a folder that keeps what is made")
    parser.add_argument("--stale", action="store_true", help="only lists mutants of texts that are not there")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build", help="the build folder")
    parser.add_argument("--only", default="", help="mutants in whose name, file or lines it is found")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="mutants at once (default: %(default)s)")
    options = parser.parse_args()
    if options.stale:
        return list_stale(sources, mutants)
    chosen = [one for one in mutants if re.search(options.only, "\n".join(one))]
    if not chosen or list_stale(sources, chosen):
        sys.exit(f"mutants.py: error: {'stale' if chosen else 'no'} mutants")
    with tempfile.TemporaryDirectory() as temporary:
        scratch = (options.scratch or pathlib.Path(temporary)).resolve()

        def said(number, one):
            folder = scratch / str(number)
            folder.mkdir(parents=True, exist_ok=True)
            return noticed(folder, options.build.resolve(), one)

        for key, one in {unchanged(one): one for one in chosen}.items():
            if failed := said("unchanged", one._replace(other=one.text)):
                sys.exit(f"mutants.py: error: without a mutant: {key} {'; '.join(failed)}")
        results = []
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for one, found in zip(chosen, pool.map(said, itertools.count(), chosen)):
                results.append((one, found))
                print(f"{one}: {'; '.join(found) or 'NOT NOTICED'}", flush=True)
    if totals:
        totals(results)
    print(f"{sum(bool(found) for _, found in results)} of {len(chosen)} noticed")
    return not all(found for _, found in results)
