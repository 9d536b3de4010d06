#!/usr/bin/env python3
"""Damaged input of every kind, given to the programs: each run ends by itself, works or refuses, and loses nothing.

    damage.py --bin BIN [--seed N] [--count N | --whole] [KIND...]

A case follows from the seed, the kind and its number. Each run has 4 GiB of memory and a minute of processor time. It
must end with status 0, or 1 and a message; a program for the TPs may have its own status. A refusal leaves the former
output as it was. Without damage every command works. Two kinds are others:

    calls        host calls by chance, of a program that was given a folder: nothing outside is read or written
    environment  a run with other variables, or closed standard streams: the usual output, or a refusal

Exit status: 0 if all cases do, 1 otherwise; what failed is kept in the folder of --keep."""
import argparse
import concurrent.futures
import os
import pathlib
import random
import shutil
import stat
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import calls  # noqa: E402
import environment  # noqa: E402
import inputs  # noqa: E402
from kinds import KINDS, OWN_STATUS, SAME_NAME  # noqa: E402
from runs import CRASHED, run, with_message  # noqa: E402
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import interrupts  # noqa: E402

OLD = b"the former output\n"


def fault_of(kind, result, output):
    """Returns None, or what is wrong with a run."""
    said = result.stderr
    if result.returncode < 0:
        return f"ended by signal {-result.returncode}"
    if CRASHED.search(said):
        return "prints a library's or an interpreter's last words"
    if kind not in OWN_STATUS and result.returncode not in (0, 1):
        return f"status {result.returncode}"
    if result.returncode == 1 and kind not in OWN_STATUS and not said.strip() and not result.stdout.strip():
        return "refuses without a message"
    if len(said) > 200000:
        return f"prints {len(said)} bytes of messages"
    if result.returncode == 1 and kind not in OWN_STATUS and (not output.exists() or output.read_bytes() != OLD):
        return "a refusal changes the former output"
    return None


def case(binaries, good, kind, number, seed, whole=None):
    """Runs a case: (fault or None, folder, command, status). `whole`: the (input, command) of a case without damage."""
    _, names, damage, commands = KINDS[kind]
    rng = random.Random(f"{seed} {kind} {number}")
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"{kind}-{number}-"))
    name, command = whole or (rng.choice(names), rng.choice(commands))
    directory = good
    if kind in SAME_NAME:
        directory = folder / "in"
        shutil.copytree(good, directory)
    damaged = directory / name if kind in SAME_NAME else folder / name
    original = (good / name).read_bytes()
    damaged.write_bytes(original if whole else damage(rng, original))
    output = folder / "output"
    output.write_bytes(OLD)
    obj = damaged if name.endswith((".obj", ".ply")) else directory / "mesh.obj"
    words = [word.format(x=damaged, o=output, d=directory, obj=obj) for word in command]
    try:
        result = run(binaries, words, folder)
    except subprocess.TimeoutExpired:
        return "does not end", folder, words, None
    fault = fault_of(kind, result, output)
    if whole and result.returncode not in ((0, 124) if kind in OWN_STATUS else (0,)):
        fault = f"status {result.returncode} without damage"
    return with_message(fault, result) if fault else None, folder, words, result.returncode


def special(folder, names):
    """Pipes and devices, which cannot be copied."""
    return [name for name in names if not any(
        test(os.lstat(os.path.join(folder, name)).st_mode) for test in (stat.S_ISREG, stat.S_ISDIR, stat.S_ISLNK))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=10, help="cases of each kind (default: 10)")
    parser.add_argument("--whole", action="store_true", help="as many as the table says, from 66 to 2,000")
    parser.add_argument("--first", type=int, default=0, help="the number of the first case")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep", type=pathlib.Path, help="the folder of failed cases (default: a new one)")
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=f"of {' '.join(KINDS)}")
    options = parser.parse_args()
    unknown = set(options.kinds) - set(KINDS)
    if unknown:
        print(f"damage.py: error: there is no kind {' '.join(sorted(unknown))}", file=sys.stderr)
        return 1
    binaries = options.bin.resolve()
    keep = options.keep or pathlib.Path(tempfile.gettempdir())
    interrupts.end_by_signals()
    failed = 0
    with tempfile.TemporaryDirectory(dir=options.keep) as scratch:
        tempfile.tempdir = scratch
        good = pathlib.Path(scratch) / "good"
        good.mkdir()
        inputs.make(binaries, good)
        for kind in options.kinds or KINDS:
            count = KINDS[kind][0] if options.whole else options.count
            statuses = {}
            with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:

                def one(number, kind=kind):
                    if kind == "calls":
                        return calls.calls(binaries, good, number, options.seed)
                    if kind == "environment":
                        return environment.environment(binaries, good, number, options.seed)
                    whole = undamaged[-number - 1] if number < 0 else None
                    return case(binaries, good, kind, number, options.seed, whole)

                undamaged = [(name, command) for name in KINDS[kind][1] for command in KINDS[kind][3]]
                numbers = [*range(-len(undamaged), 0), *range(options.first, options.first + count)]
                for number, (fault, folder, words, status) in zip(numbers, pool.map(one, numbers)):
                    if number >= 0:
                        statuses[status] = statuses.get(status, 0) + 1
                    if fault:
                        failed += 1
                        kept = keep / folder.name
                        shutil.copytree(folder, kept, symlinks=True, ignore=special, dirs_exist_ok=True)
                        command = " ".join(map(str, words))
                        print(f"FAILED: {kind} {number}: {fault}\n  {command}\n  kept in {kept}", flush=True)
                    shutil.rmtree(folder, ignore_errors=True)
            counts = ", ".join(f"{status}: {n}" for status, n in sorted(statuses.items(), key=str))
            print(f"{kind}: {count} cases, status {counts}", flush=True)
    print(f"damage: {failed} failed")
    return failed != 0


if __name__ == "__main__":
    sys.exit(main())
