"""What the scripts share that break the device program in a copy: mutants.py here and in extreme."""

import argparse
import pathlib
import shlex
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def command(build, output):
    """How ninja makes the output, as words."""
    last = subprocess.run(["ninja", "-C", str(build), "-t", "commands", output], check=True, capture_output=True,
                          text=True).stdout.splitlines()[-1]
    return shlex.split(next(part for part in last.split(" && ") if part.split()[0] not in ("cd", ":")))


def changed_copy(folder, tests, mutant):
    """A new folder with raytracer/device, changed as the mutant says, and the folder tests of the tree."""
    shutil.rmtree(folder, ignore_errors=True)
    for part in ("raytracer/device", tests):
        shutil.copytree(ROOT / part, folder / part)
    if mutant:
        _, file, text, other = mutant[:4]
        source = folder / "raytracer/device" / file
        if source.read_text().count(text) != 1:
            sys.exit(f"mutants.py: error: {file}: not exactly once there: {text}")
        source.write_text(source.read_text().replace(text, other))


def list_stale(mutants, folder, name_and_text=lambda mutant: mutant[1:3]):
    """Prints the mutants whose text is not exactly once in their file. Returns whether there are any."""
    stale = 0
    for mutant in mutants:
        name, text = name_and_text(mutant)
        count = (folder / name).read_text().count(text)
        stale += count != 1
        if count != 1:
            print(f"{mutant[0]}: {name}: {count} times there: {text}")
    print(f"{stale} of {len(mutants)} mutants are stale")
    return stale > 0


def main(description, tests, mutants, make, said):
    """Tries mutants, tuples (name, file of raytracer/device, text, what it becomes, further values). make(folder,
    build) compiles the tests, which are in the folder of this name, in a changed copy of the tree, and said(folder,
    further values) gives what they say of the mutant, empty if they do not notice it. What they say of a copy that is
    not changed is an error. The exit status."""
    parser = argparse.ArgumentParser(description=description.split("\n")[0])
    parser.add_argument("scratch", type=pathlib.Path, nargs="?")
    parser.add_argument("--stale", action="store_true", help="only lists mutants of texts that are not there")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--only", help="the mutant of this name")
    options = parser.parse_args()
    if options.stale:
        return list_stale(mutants, ROOT / "raytracer/device")
    if options.scratch is None:
        parser.error("SCRATCH is missing")
    chosen = [mutant for mutant in mutants if options.only in (None, mutant[0])]
    if not chosen:
        sys.exit(f"mutants.py: error: no mutant is called {options.only}")
    missed = 0
    for mutant in (None, *chosen):
        folder = (options.scratch / (mutant[0] if mutant else "unchanged")).resolve()
        changed_copy(folder, tests, mutant)
        make(folder, options.build.resolve())
        if not mutant:
            for further in sorted({one[4:] for one in chosen}):
                if noticed := said(folder, *further):
                    sys.exit(f"mutants.py: error: without a mutant: {': '.join(further)}: {'; '.join(noticed)}")
            continue
        noticed = said(folder, *mutant[4:])
        missed += not noticed
        print(f"{': '.join((mutant[0], *mutant[4:]))}: {'; '.join(noticed) if noticed else 'NOT NOTICED'}", flush=True)
    print(f"{len(chosen) - missed} of {len(chosen)} noticed")
    return missed > 0
