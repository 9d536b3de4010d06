"""Common parts of the programs of this folder: the command line, the seeds, the kept failures."""

import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import sys
import tempfile

from toolchain import HOST_COMPILER, Failure, SetupError, Target, require_host_compiler, require_programs, run

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import interrupts  # noqa: E402
from progress import Progress  # noqa: E402

MAX_CYCLES = 1_000_000_000


class Parser(argparse.ArgumentParser):
    """Ends with status 1 on an error of use, as all programs here do."""

    def error(self, message):
        self.exit(1, f"{self.prog}: error: {message}\n")


def seed_range(text):
    match = re.fullmatch(r"(\d+)-(\d+)", text) or re.fullmatch(r"(\d+)()", text)
    if not match:
        raise argparse.ArgumentTypeError(f"'{text}' is not FIRST-LAST, like 1-500")
    first, last = int(match[1]), int(match[2] or match[1])
    if last < first:
        raise argparse.ArgumentTypeError(f"'{text}' holds no seed")
    return range(first, last + 1)


def natural(text):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number from 1 up")
    return int(text)


def add_options(parser, name, seeds):
    """--seeds, --build, --work, --jobs and --cflags, which all of them have."""
    top = pathlib.Path(__file__).resolve().parents[2]
    parser.add_argument("--seeds", type=seed_range, default=seed_range(seeds), metavar="FIRST-LAST",
                        help=f"default: {seeds}")
    parser.add_argument("--build", type=pathlib.Path, default=top / "build",
                        help="build directory of the toolchain (default: build)")
    parser.add_argument("--work", type=pathlib.Path, help=f"directory of what fails (default: BUILD/fuzz/{name})")
    parser.add_argument("--jobs", type=natural, default=os.cpu_count(), help="default: all processors")
    parser.add_argument("--cflags", default="", help="further flags of the compiler; write --cflags=-...")


def prepare(options, name, packages=None):
    """Completes the options; returns the target. Raises SetupError. From now on a signal ends the tool."""
    interrupts.end_by_signals()
    options.work = (options.work or options.build / "fuzz" / name).resolve()
    require_programs({"gcc": "gcc", **(packages or {})})
    target = Target(options.build, options.cflags.split())
    options.work.mkdir(parents=True, exist_ok=True)
    require_host_compiler(options.work)
    return target


def host(sources, directory, flags):
    """Returns the host's output of a program of C sources in a directory."""
    command = [*HOST_COMPILER, *flags, "-std=gnu17", *(directory / source for source in sources), "-o",
               directory / "host", "-lm"]
    for step in (command, [directory / "host"]):
        result = run(step)
        if result.status != 0:
            raise Failure(f"on the host: {result.reason()} {result.output[:200].decode(errors='replace')}",
                          result.command)
    return result.output


def expect(target, image, output, what):
    result = target.simulate(image, MAX_CYCLES)
    if result.status != 0 or result.output != output:
        lines = [line for line in result.output.splitlines() if line not in output.splitlines()]
        printed = f", prints {lines[0].decode(errors='replace')!r}" if lines else ""
        raise Failure(f"{what}: {result.reason()}{printed}", result.command)


def keep(options, seed, directory, failure):
    """Moves the failed program to the work folder. Returns the failure and the command with the new paths."""
    kept = options.work / "failures" / f"seed-{seed}"
    shutil.rmtree(kept, ignore_errors=True)
    kept.parent.mkdir(exist_ok=True)
    shutil.copytree(directory, kept)
    command = failure.command.replace(str(directory), str(kept))
    (kept / "failure.txt").write_text(f"{failure}\n{command}\n")
    return str(failure).replace(str(directory), str(kept)), command


def main(name, description, check, default):
    """Runs check(target, seed, directory, options), which raises Failure, for every seed. Returns the exit status."""
    parser = Parser(description=description)
    add_options(parser, name, default)
    parser.add_argument("--rounds", type=natural, default=6,
                        help="how many choices of levels for each seed (default: 6)")
    options = parser.parse_args()
    try:
        target = prepare(options, name)
    except SetupError as error:
        print(f"{name}.py: error: {error}", file=sys.stderr)
        return 1

    def run_seed(seed):
        with tempfile.TemporaryDirectory(prefix=f"seed-{seed}-", dir=options.work) as temporary:
            directory = pathlib.Path(temporary)
            try:
                check(target, seed, directory, options)
            except Failure as failure:
                return keep(options, seed, directory, failure)
        return None

    failed = 0
    progress = Progress(len(options.seeds))
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for done, (seed, found) in enumerate(zip(options.seeds, pool.map(run_seed, options.seeds)), 1):
            if found:
                failed += 1
                progress.clear()
                print(f"seed {seed}: {found[0]}\n  {found[1]}", flush=True)
            progress.show(done, f"programs, {failed} failed")
    progress.clear()
    print(f"{name}: {len(options.seeds)} programs, {failed} failed")
    return 1 if failed else 0
