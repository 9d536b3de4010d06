#!/usr/bin/env python3
"""Csmith's programs on the TP against the host: their output must be equal at every optimisation level.

    tests/fuzz/csmith.py --seeds 1-500                          as many programs, in BUILD/fuzz/csmith
    tests/fuzz/csmith.py --seeds 77-77 --levels=-O2 --again     one program once more

A program that runs for too long, or that the host's sanitizer finds undefined when it fails here, is replaced by that
of a further seed. Every --sample-th seed is also checked otherwise (see checks.py): -Oz, -g, sanitizers, assembler,
engines. A second run with the same toolchain goes on where the first stopped. Exit status: 0 if as many programs were
equal as asked for, 1 if any differs (each with the command to reproduce it; its files are in failures/seed-N) or
something is missing.
"""

import collections
import concurrent.futures
import hashlib
import json
import pathlib
import shutil
import sys
import tempfile
import threading

import checks
import programs
import runner
from progress import Progress
from toolchain import Failure, SetupError

LEVELS = "-O0,-O1,-O2,-O3,-Os"
# Times --max-cycles: how long a program may run that the host runs in no time, before it counts as hanging.
LONG_RUN = 40


def parse_arguments():
    parser = runner.Parser(description="Compare Csmith's programs on the TP with the host.")
    runner.add_options(parser, "csmith", "1-500")
    parser.add_argument("--levels", default=LEVELS, help=f"comma separated; write --levels=-O0,... (default: {LEVELS})")
    parser.add_argument("--sample", type=int, default=5, help="every N-th seed gets all checks; 0: none (default: 5)")
    parser.add_argument("--max-cycles", type=runner.natural, default=30_000_000,
                        help="programs that run longer at the first level are skipped (default: 30000000)")
    parser.add_argument("--again", action="store_true", help="forget earlier results")
    options = parser.parse_args()
    options.levels = [level for level in options.levels.split(",") if level]
    if not options.levels:
        parser.error("--levels: no level")
    return options


class Results:
    """A line of JSON for each seed, of one toolchain and one choice of levels and checks."""

    def __init__(self, path, key, again):
        self.path, self.seeds, self.lock = path, {}, threading.Lock()
        lines = path.read_text().splitlines() if path.exists() and not again else []
        if lines and lines[0] == json.dumps({"key": key}):
            for line in lines[1:]:
                try:
                    record = json.loads(line)
                except ValueError:
                    continue  # the last line of a run that was killed
                self.seeds[record["seed"]] = record
        temporary = path.with_suffix(".new")
        temporary.write_text("".join(json.dumps(entry) + "\n" for entry in [{"key": key}, *self.seeds.values()]))
        temporary.replace(path)

    def add(self, record):
        with self.lock:
            self.seeds[record["seed"]] = record
            with self.path.open("a") as file:
                file.write(json.dumps(record) + "\n")


def check_output(result, output, what):
    if result.status is None:
        raise Failure(f"{what}: does not end", result.command, undefined=True)
    if result.status != 0:
        raise Failure(f"{what}: {result.reason()}", result.command, undefined=True)
    if result.output != output:
        raise Failure(f"{what}: prints {result.output[:60]!r}, not {output[:60]!r}", result.command, undefined=True)


def simulate_first(target, image, max_cycles, host_seconds, what):
    """The run at the first level: a program may be too long, unless the host says that it is short."""
    result = target.simulate(image, max_cycles)
    if result.status is not None:
        return result
    if host_seconds < 0.05:
        result = target.simulate(image, LONG_RUN * max_cycles)
        if result.status is None:
            raise Failure(f"{what}: does not end within {LONG_RUN * max_cycles} cycles", result.command, undefined=True)
    raise programs.Skip("takes too long here")


def check_seed(target, seed, options, directory):
    """Compiles and runs one program at all levels. Returns how often its stack was local and global."""
    program, output, host_seconds = programs.obtain(seed, options.work / "programs", directory)
    stacks = collections.Counter()
    try:
        for level in options.levels:
            checked = f"{level}"
            compiled = directory / f"program{level}.o"
            image = directory / f"program{level}"
            target.compile([level, *program.flags, "-c", program.source, "-o", compiled], program.language)
            stacks[target.link([compiled], image)] += 1
            if level == options.levels[0]:
                result = simulate_first(target, image, options.max_cycles, host_seconds, checked)
            else:
                result = target.simulate(image, LONG_RUN * options.max_cycles)
            check_output(result, output, checked)
        if options.sample and seed % options.sample == 0:
            for name, check in checks.CHECKS.items():
                result = check(target, program, directory, LONG_RUN * options.max_cycles)
                if result is not None:
                    check_output(result, output, name)
    except Failure as failure:
        if failure.undefined and programs.undefined_behaviour(program, directory):
            raise programs.Skip("undefined behaviour") from failure
        raise
    return stacks


def run_seed(target, seed, options):
    """Checks one seed; returns its record."""
    record = {"seed": seed, "profile": programs.PROFILES[seed % len(programs.PROFILES)][0]}
    directory = pathlib.Path(tempfile.mkdtemp(prefix=f"seed-{seed}-", dir=options.work))
    try:
        stacks = check_seed(target, seed, options, directory)
        record.update(outcome="equal", stacks=stacks)
    except programs.Skip as skip:
        record.update(outcome="skipped", reason=str(skip))
    except Failure as failure:
        reason, command = runner.keep(options, seed, directory, failure)
        record.update(outcome="failed", reason=reason, command=command)
    finally:
        shutil.rmtree(directory, ignore_errors=True)
    return record


def report_failure(record):
    print(f"seed {record['seed']} ({record['profile']}): {record['reason']}\n  {record['command']}", flush=True)


def run_all(target, options, results):
    """Goes through the seeds, and further ones for those skipped, until as many are compared as asked for."""
    wanted = len(options.seeds)
    counts = collections.Counter()
    skipped = collections.Counter()
    progress = Progress(wanted)
    next_seed = options.seeds.start
    give_up = options.seeds.start + 4 * wanted + 100
    running = set()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        while True:
            # Never more under way than still needed, so that the seeds compared do not depend on the number of jobs.
            while counts["equal"] + counts["failed"] + len(running) < wanted and len(
                    running) < 2 * options.jobs and next_seed < give_up:
                seed, next_seed = next_seed, next_seed + 1
                earlier = results.seeds.get(seed)
                if earlier:
                    future = concurrent.futures.Future()
                    future.set_result(earlier)
                else:
                    future = pool.submit(run_seed, target, seed, options)
                running.add(future)
            if not running:
                break
            done, running = concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED)
            for future in done:
                record = future.result()
                if record["seed"] not in results.seeds:
                    results.add(record)
                counts[record["outcome"]] += 1
                if record["outcome"] == "failed":
                    progress.clear()
                    report_failure(record)
                elif record["outcome"] == "skipped":
                    skipped[record["reason"]] += 1
                else:
                    counts.update({f"{stack} stack": times for stack, times in record["stacks"].items()})
            progress.show(counts["equal"] + counts["failed"],
                          f"compared, {counts['failed']} failed, {counts['skipped']} skipped")
    progress.clear()
    return counts, skipped, next_seed - 1


def main():
    options = parse_arguments()
    try:
        target = runner.prepare(options, "csmith",
                                {"csmith": "csmith", programs.INCLUDE + "/csmith.h": "libcsmith-dev"})
    except SetupError as error:
        print(f"csmith.py: error: {error}", file=sys.stderr)
        return 1
    (options.work / "programs").mkdir(exist_ok=True)
    settings = repr((programs.PROFILES, options.levels, options.sample, options.max_cycles, list(checks.CHECKS)))
    key = f"{target.fingerprint()} {hashlib.sha256(settings.encode()).hexdigest()[:16]}"
    results = Results(options.work / "results.jsonl", key, options.again)
    counts, skipped, last = run_all(target, options, results)

    wanted = len(options.seeds)
    compared = counts["equal"] + counts["failed"]
    print(
        f"seeds {options.seeds.start}-{last} at {' '.join(options.levels)}: {compared} programs compared, "
        f"{counts['failed']} failed; "
        f"stack in local memory {counts['local stack']} times, in global memory {counts['global stack']} times")
    if skipped:
        print("skipped: " + ", ".join(f"{count} {reason}" for reason, count in skipped.most_common()))
    if compared < wanted:
        print(f"csmith.py: error: only {compared} of {wanted} programs could be compared", file=sys.stderr)
    return 1 if counts["failed"] or compared < wanted else 0


if __name__ == "__main__":
    sys.exit(main())
