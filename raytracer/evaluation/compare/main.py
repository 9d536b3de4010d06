"""trax-sim compare: what differs between two runs (docs/compare.md)."""

import itertools
import json
import math
import os
import pathlib
import sys

from trax_eval.outputs import IsInput, write_output
from trax_eval.util import Once, Parser, Problem, check_files

from .difference import compare, shaded
from .figures import Figures
from .page import add_to_page, page
from .runs import Run, runs_of
from .text import print_comparison, print_folders

HELP = """\
usage: trax-sim compare [OPTION...] A B

Compares two runs: configuration, cycles by cause, function, line and kind of ray, units, caches, energy, pictures.
What contributes most to the difference of cycles comes first. A and B are files of --stats, pages of --explore, or
folders with them, whose runs of equal names are compared. Beside NAME.json, its page NAME.html (--explore) and its
picture NAME.png are read, too.

  --json               print the comparison as JSON
  --html FILE          write it as a page for a browser
  --add                add it to B, a page of --explore, as trax-sim --explore-against A does
  --picture FILE       write where the pictures differ, as a PNG
  --cost-picture FILE  write where the pixels' thread-cycles differ: orange where B takes more, blue where it takes less
  --all                print all rows of all tables
  --help               print this, and end

Exit status: 0, also if the runs differ; 1 for an error. docs/compare.md explains the tables.
"""


def new_parser():
    parser = Parser(prog="trax-sim compare", add_help=False, allow_abbrev=False)
    parser.add_argument("a")
    parser.add_argument("b")
    for name in ("html", "picture", "cost-picture"):
        parser.add_argument(f"--{name}", action=Once)
    for name in ("json", "all", "add", "help"):
        parser.add_argument(f"--{name}", action="store_true")
    return parser


def parse(arguments):
    options = new_parser().parse_intermixed_args(arguments)
    outputs = [path for path in (options.html, options.picture, options.cost_picture) if path is not None]
    for path in (options.a, options.b):
        if not os.path.exists(path):
            raise Problem(f"{path}: {os.strerror(2)}")
    if options.add and (outputs or options.json or options.all):
        raise Problem("--add excludes other outputs")
    if options.add and pathlib.Path(options.b).suffix.lower() not in (".html", ".htm"):
        raise Problem(f"{options.b}: --add needs a page of --explore")
    check_files([options.a, options.b], outputs)
    return options


def pair(a, b):
    """The runs of two folders that belong together: those of equal names, or the only ones."""
    if len(a) == len(b) == 1:
        return [(*a, *a.values(), *b.values())], [], []
    return ([(name, a[name], b[name]) for name in a if name in b], [name for name in a if name not in b],
            [name for name in b if name not in a])


def compare_folders(options, figures):
    both, *only = pair(runs_of(options.a), runs_of(options.b))
    if not both:
        raise Problem(f"{options.a} and {options.b} have no runs of equal names: {', '.join(only[0])} and "
                      f"{', '.join(only[1])}")
    made = {name: compare(a, b, figures) for name, a, b in both}
    made = dict(sorted(made.items(), key=lambda one: -abs(one[1][0]["cycles"]["relative"] or 0)))
    ratios = [one["cycles"]["b"] / one["cycles"]["a"] if one["cycles"]["a"] else 0 for one, _ in made.values()]
    return {
        "a": options.a, "b": options.b, "runs": {name: one for name, (one, _) in made.items()},
        "only_a": only[0], "only_b": only[1],
        "ratio": math.exp(math.fsum(map(math.log, ratios)) / len(ratios)) if all(each > 0 for each in ratios) else None
    }, {name: pictures for name, (_, pictures) in made.items()}


def write(path, data):
    try:
        write_output(path, data, foreign=True)
    except IsInput as error:
        raise Problem(str(error)) from error
    except OSError as error:
        raise Problem(f"{path}: {error.strerror}") from error


def add(options, result, pictures, data):
    """Adds the comparison to B, the only file that is both read and written."""
    text = pathlib.Path(options.b).read_bytes().decode(errors="surrogateescape")
    made = add_to_page(text, pathlib.Path(options.a).name, result, pictures, data)
    try:
        write_output(options.b, made.encode(errors="surrogateescape"))
    except OSError as error:
        raise Problem(f"{options.b}: {error.strerror}") from error


def picture_of(name, path, run, result, pictures):
    """The picture of the differences of `name`: where nothing differs it is transparent."""
    missing = [result["missing"][part] for part in ("picture", *(["costs"] if name == "cost" else []))
               if part in result["missing"]]
    if "sizes" in result.get("pictures", {}):
        missing.append("the runs' are of {}x{} and {}x{} pixels".format(*itertools.chain(*result["pictures"]["sizes"])))
    if missing:
        raise Problem(f"{path}: no picture of differences: {missing[0]}")
    width, height, _ = run.picture
    return pictures.get(name) or shaded([0] * (width * height), width, height)


def main(arguments, tools, data):
    if "--help" in arguments or "-h" in arguments:
        print(HELP, end="")
        return 0
    options = parse(arguments)
    figures = Figures(tools)
    if pathlib.Path(options.a).is_dir() != pathlib.Path(options.b).is_dir():
        raise Problem(f"{options.a} and {options.b}: one is a folder, and the other is none")
    folders = pathlib.Path(options.a).is_dir()
    asked = {name: path for name, path in (("pixels", options.picture), ("cost", options.cost_picture)) if path}
    if folders:
        if asked:
            raise Problem("--picture and --cost-picture are for two runs, not for folders")
        result, pictures = compare_folders(options, figures)
    else:
        run = Run(options.a)
        result, pictures = compare(run, Run(options.b), figures)
    if options.add:
        add(options, result, pictures, data)
        return 0
    outputs = [(path, picture_of(name, path, run, result, pictures)) for name, path in asked.items()]
    if options.html is not None:
        outputs.append((options.html, page(result if folders else {"runs": {"": result}},
                                           pictures if folders else {"": pictures}, data)))
    for output in outputs:
        write(*output)
    if options.json:
        json.dump(result, sys.stdout, indent=1, allow_nan=False)
        print()
    elif folders:
        print_folders(result)
    else:
        print_comparison(result, options.all)
    return 0
