"""The command line."""

import contextlib
import math
import os
import pathlib
import re
import shlex
import shutil
import sys
import time

from report.table import seconds
from trax_eval import runners
from trax_eval.estimate import estimate
from trax_eval.finished import forget_damaged, is_intact
from trax_eval.interrupts import Interrupted, catch_interrupts, end_by_signal
from trax_eval.planner import Planner, check_machines, check_names, label
from trax_eval.programs import find_programs
from trax_eval.results import collect, plan_file, write_plan
from trax_eval.scratch import clean_scratch, new_scratch
from trax_eval.sweep import parse_size, read_sweep
from trax_eval.tools import Tools
from trax_eval.util import Problem, check_files, complain, nearest, remark
from trax_eval.values import Areas

from .options import OPTIONS, described, job_parser, new_parser

COMMANDS = ("space", "report", "docs", "fetch-scenes")  # the first word
HELP = """\
usage: trax-eval [OPTION...] EXPERIMENT... [SCENES]
       trax-eval [OPTION...] --all [SCENES]
       trax-eval space [OPTION...] SWEEP.json [SCENES]
       trax-eval report RESULTS.json -o PAGE.html
       trax-eval docs [--check] [RESULTS.json...] PAGE.md...
       trax-eval fetch-scenes [OPTION...] [SCENE...]

Repeats what the paper measured, and shows our figures beside the paper's. Finished runs are kept: the same
command makes only what is missing, whenever and however the one before it ended.

EXPERIMENT is one of those below, or a sweep file of your own (NAME.json): copy lib/trax/evaluation/example.json, and
change it; README.md beside it has the format. SCENES is the folder with the scenes' meshes (default: the variable
TRAX_SCENES, or else ./scenes); `trax-eval fetch-scenes` fetches them, and has a --help of its own.

%s
%s

Exit status: 0 if all runs that were asked for are there, 1 if some are not. Interrupts end it and what it has started.
"""


def experiments(data):
    """The sweep files that come with trax, the paper's tables first."""
    return sorted((data / "sweeps").glob("*.json"), key=lambda path: (not path.stem.startswith("table"), path.stem))


def help_text(data):
    lines = []
    for path in experiments(data):
        sweep = read_sweep(path)
        lines.append(f"  {sweep.name:21} {sweep.title} ({len(sweep.points)} runs)")
    return HELP % ("Experiments:\n" + "\n".join(lines) + "\n", described())


def parse(arguments):
    options = new_parser().parse_intermixed_args(arguments)
    options.programs = None if options.program is None else [
        find_programs(name, ".", False)[0] if name.endswith(".json") else name for name in options.program.split(",")
    ]
    for option in OPTIONS:
        given = getattr(options, option.name, None) if option.mark and option.name != "program" else None
        if given is not None:
            setattr(options, option.name, [word.strip() for word in given.split(option.mark)])
            if not all(getattr(options, option.name)):
                raise Problem(f"--{option.name}: the value is empty")
    if options.size is not None and not parse_size(options.size):
        raise Problem(f"--size {options.size}: expected WIDTHxHEIGHT, each 1 to 16384")
    check_threads("--jobs", options.jobs)
    return options


def check_threads(option, value):
    if not 1 <= value <= 4096:
        raise Problem(f"{option} {value}: expected a number from 1 to 4096")


def choose(options, data):
    """Returns the sweep files and the folder of scenes that the words name. If the last of several words may name
    both, it is the folder."""
    known = {path.stem: path for path in experiments(data)}
    files, folder = [path for path in known.values() if read_sweep(path).in_all] if options.all else [], None
    words = options.words
    if len(words) > 1 and not options.all and words[-1] in known and os.path.isdir(words[-1]):
        remark(f"{words[-1]} is taken for the folder; the experiment of this name comes before other words")
        words, folder = words[:-1], pathlib.Path(words[-1])
    for word in words:
        if word in known and not options.all:
            files.append(known[word])
        elif word.endswith(".json") and not options.all:
            files.append(pathlib.Path(word))
        elif pathlib.Path(word).is_dir() and folder is None:
            folder = pathlib.Path(word)
        else:
            raise Problem(unfit(word, known, options.all, folder))
    if not files:
        raise Problem("no experiment was named; trax-eval --help lists them, --all is all of them")
    return files, folder or pathlib.Path(os.environ.get("TRAX_SCENES", "scenes"))


def unfit(word, known, everything, folder):
    """Why a word is none of those that a command takes."""
    if pathlib.Path(word).is_dir():
        return f"{word}: {folder} is the folder of scenes already"
    if everything and (word in known or word.endswith(".json")):
        return f"{word}: --all is the paper's experiments, and takes no other"
    if word in COMMANDS:
        return f"{word} is a command, and comes first: trax-eval {word} ..."
    return (f'"{word}" is neither an experiment (trax-eval --help lists them), nor a sweep file (NAME.json), nor a '
            f'folder of scenes{nearest(word, [*known, *COMMANDS])}')


def evaluate(options, tools, data, command):
    begin = time.monotonic()
    files, folder = choose(options, data)
    whole = [read_sweep(path, size=options.size, mode=options.mode, programs=options.programs) for path in files]
    check_names(options, whole)
    sweeps = whole if (options.scene, options.variant, options.chip) == (None, None, None) else [
        read_sweep(path, size=options.size, mode=options.mode, programs=options.programs, chips=options.chip,
                   only_scenes=options.scene, only_variants=options.variant) for path in files
    ]
    return make_runs(options, tools, data, command, begin, files, folder, sweeps)[0]


def make_runs(options, tools, data, command, begin, files, folder, sweeps):
    """Returns the exit status, the value of results.json (None: nothing was run), and (sweep, keys of its points)."""
    check_machines(sweeps, tools)
    check_files(files, [
        *(plan_file(options.output, sweep)
          for sweep in sweeps), options.output / "results.json", options.output / "report.html"
    ])
    out = options.output.resolve()
    if out.exists() and not out.is_dir():
        raise Problem(f"{out}: is no folder")
    clean_scratch(None)
    if not options.dry_run:
        out.mkdir(parents=True, exist_ok=True)
        clean_scratch(out)
    plans, labels, statistics, without = [], {}, [], 0
    with contextlib.ExitStack() as stack:
        scratch = new_scratch(None if options.dry_run else out)
        stack.callback(shutil.rmtree, scratch, ignore_errors=True)
        planner = Planner(out, tools, folder, options.quiet, options.dry_run, scratch)
        if not options.dry_run:
            planner.import_all(sweeps, options.jobs)
        planner.prepare_all(sweeps, options.jobs)
        for sweep in sweeps:
            keys = {point: planner.key(sweep, point) for point in sweep.points}
            plans.append((sweep, keys))
            statistics.append({point: planner.statistics(sweep, point) for point in sweep.points})
            labels |= {key: label(point) for point, (key, _) in keys.items() if key}
            without += sum(key is None for key, _ in keys.values())
    if options.dry_run:
        missing = [
            f"{'(new)' if key.startswith('-') else key} {name}" for key, name in labels.items()
            if not is_intact(out, key)
        ]
        print("\n".join([*missing, f"{len(missing)} of {len(labels)} runs are missing"]))
        if known := estimate(out, plans):
            print("they take about {} of a processor, by the {} that are there".format(seconds(known[0]), known[1]))
        return 0, None, plans
    for (sweep, keys), known in zip(plans, statistics):
        write_plan(out, sweep, keys, tools, known)
    forget_damaged(out, labels)
    if options.prepare:
        print("".join(f"{key}\n" for key in labels if not is_intact(out, key)), end="")
        return 1 if without else 0, None, plans
    failed = runners.run_all(out, tools, labels, options)
    results = collect(out, tools, Areas(data / "paper"), command, time.monotonic() - begin)
    if not options.quiet:
        from report.paper import Paper
        from report.results import Results
        from report.tables import print_tables
        spent = math.fsum(run["host"]["processor_seconds"] for run in results["runs"]
                          if run["key"] in labels and (run.get("host") or {}).get("processor_seconds"))
        print_tables(Results(results), Paper(data / "paper"), [sweep.name for sweep in sweeps], sys.stdout)
        print(
            f"{len(labels) - failed} runs are there, {failed} failed, {without} could not be prepared; "
            f"they took {seconds(spent) or '0 s'} of a processor; {out / 'results.json'}"
        )
    if options.all or options.report:
        from report import make
        failed += make.main([str(out / "results.json"), "-o", str(out / "report.html")])
    return 1 if failed or without else 0, results, plans


def explore_space(arguments, tools, data):
    from . import space
    begin, options = time.monotonic(), parse(arguments)
    if not options.words:
        raise Problem("space: expected a sweep, NAME.json (trax-eval space --help)")
    files, folder = choose(options, data)
    command = shlex.join(["trax-eval", "space", *arguments])
    return space.explore(
        options, files, lambda sweep: make_runs(options, tools, data, command, begin, files, folder, [sweep]))


def run_one_job(arguments, tools):
    """trax-eval job OUT KEY: one of the jobs that --prepare prints, for other schedulers."""
    options = job_parser().parse_intermixed_args(arguments)
    check_threads("--threads", options.threads)
    if not re.fullmatch("[0-9a-f]{32}", options.key):
        raise Problem(f"{options.key}: is no key of a job, as --prepare prints them")
    if not (options.out / "jobs" / f"{options.key}.json").exists():
        raise Problem(f"{options.out}: has no job {options.key}")
    error = runners.try_job(options.out.resolve(), tools, options.key, options.threads)
    if error:
        raise Problem(error)
    return 0


def dispatch(arguments, tools, data):
    """A command imports what it alone needs: otherwise every start would take twice as long."""
    if arguments[:1] == ["compare"]:
        from compare import main as comparison
        return comparison.main(arguments[1:], tools, data)
    if arguments[:1] == ["frames"]:
        from . import frames
        command, begin = shlex.join(["trax-render", *arguments[1:]]), time.monotonic()
        return frames.main(arguments[1:], tools, lambda options, files, sweeps: make_runs(
            options, tools, data, command, begin, files, pathlib.Path("/"), sweeps))
    if arguments[:1] == ["fetch-scenes"]:
        from fetch import main as fetch
        return fetch.main(arguments[1:], tools)
    if arguments[:1] == ["space"]:
        if "-h" in arguments or "--help" in arguments:
            from . import space
            print(space.HELP, end="")
            return 0
        return explore_space(arguments[1:], tools, data)
    if "-h" in arguments or "--help" in arguments:
        print(help_text(data), end="")
        return 0
    if arguments == ["--help-completion"]:
        from . import completion
        print(completion.script(data, [path.stem for path in experiments(data)]))
        return 0
    if "--version" in arguments:
        print(f"trax-eval {tools.version()}")
        return 0
    if arguments[:1] == ["job"]:
        return run_one_job(arguments[1:], tools)
    if arguments[:1] == ["report"]:
        from report import make
        return make.main(arguments[1:])
    if arguments[:1] == ["docs"]:
        from report import docs
        return docs.main(arguments[1:])
    if arguments[:1] == ["new-sweep"]:
        raise Problem(
            f"new-sweep is no longer there; copy {data / 'example.json'}, and change it ({data / 'README.md'})")
    gone = next((word.split("=")[0] for word in arguments
                 if word.split("=")[0] in ("--runner", "--hosts", "--slurm-options")), None)
    if gone:
        raise Problem(f"{gone} is no longer there; GNU parallel, Slurm and others run what --prepare prints "
                      f'({data / "README.md"}, "Other hosts")')
    return evaluate(parse(arguments), tools, data, shlex.join(["trax-eval", *arguments]))


def drop_output():
    """Python flushes standard output again at its end, and would tell its reader of the second failure."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main(arguments, folder, data):
    catch_interrupts()
    # Another program starts this one for these words.
    program = {"compare": "trax-sim", "frames": "trax-render"}.get("".join(arguments[:1]), "trax-eval")
    try:
        status = dispatch(arguments, Tools(folder), data)
        sys.stdout.flush()
        return status
    except Problem as problem:
        complain(program, problem)
        return 1
    except Interrupted as interrupted:
        goes_on = "" if program == "trax-sim" else "; the same command goes on"
        end_by_signal(*interrupted.args, f"{program}: interrupted{goes_on}")
    except BrokenPipeError:
        drop_output()
        return 1
    except OSError as error:  # of a folder or file that cannot be used, as of -o on a full disk
        complain(program, f"{f'{error.filename}: ' if error.filename else ''}{error.strerror}")
        drop_output()
        return 1
