"""The driver of the lists of mutants: changed lines of the sources, each of which some test must notice.

    mutants.py [SCRATCH] [--build build] [--only EXPRESSION]    tries those in whose name, file or lines it is found
    mutants.py --stale                                          lists texts that are not exactly once in their file

Needs a finished build, which is not changed. Exit status 0 if every mutant is noticed.
"""

import argparse
import collections
import concurrent.futures
import functools
import itertools
import os
import pathlib
import re
import shlex
import shutil
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
    """How ninja makes the output, as words, without a cache of the compiler: it would only be filled."""
    last = subprocess.run(["ninja", "-C", str(build), "-t", "commands", output], check=True, capture_output=True,
                          text=True).stdout.splitlines()[-1]
    words = shlex.split(next(part for part in last.split(" && ") if part.split()[0] not in ("cd", ":")))
    return words[os.path.basename(words[0]) == "ccache":]


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


@functools.cache
def dependents(build):
    """The outputs that ninja has compiled from each source or header."""
    found = collections.defaultdict(list)
    for line in subprocess.run(["ninja", "-C", str(build), "-t", "deps"], check=True, capture_output=True,
                               text=True).stdout.splitlines():
        if not line.startswith(" "):
            output = line.split(":")[0]
        elif line.strip():
            found[os.path.normpath(build / line.strip())].append(output)
    return found


def relinked(folder, build, objects, source, text, tests, *options):
    """Links one test after the other with the text in the place of a source or header: with what is compiled from it
    to the folder `objects` of the build. The rest of its part of the project is linked to from a copy, so that headers
    find one another."""
    part = ROOT / source.relative_to(ROOT).parts[0]
    shutil.rmtree(folder)
    folder.mkdir()
    subprocess.run(["cp", "-rs", part, folder], check=True)
    changed = folder / source.relative_to(ROOT)
    changed.unlink()
    changed.write_text(text)
    made = []
    for output in filter(re.compile(objects).match, dependents(build)[str(source)]):
        words = [word.replace(str(part), str(folder / part.name)) for word in command(build, output)]
        words[words.index("-MF") + 1] = os.devnull
        made.append(folder / f"{len(made)}.o")
        words[words.index("-o") + 1] = made[-1]
        subprocess.run([*words, *options, "-w"], check=True, cwd=build)
    if not made:
        sys.exit(f"{source}: nothing in {objects} is compiled from it")
    yield from linked(folder, build, tests, made)


def linked(folder, build, tests, made):
    """Links one test after the other with these objects: by its name, or another program by its path in the build."""
    for test in tests:
        if not (folder / test).exists():
            (folder / test).parent.mkdir(exist_ok=True)
            link_as(build, test if "/" in test else f"tests/bin/{test}", folder / test, made)
        yield folder / test


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
    """Prints mutants whose text is not exactly once in its file, and those that make the same change as another one."""
    stale, known = 0, {}
    for one in mutants:
        key = one.file, one.changed(sources)
        if (count := (sources / one.file).read_text().count(one.text)) != 1:
            why = f"{count} times there: {one.text}"
        elif key in known:
            why = f"the same as {known[key]}"
        else:
            known[key] = one
            continue
        stale += 1
        print(f"{one}: {one.file}: {why}")
    print(f"{stale} of {len(mutants)} mutants are stale")
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
            found = noticed(folder, options.build.resolve(), one)
            if not options.scratch and number != "unchanged":
                shutil.rmtree(folder)
            return found

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
