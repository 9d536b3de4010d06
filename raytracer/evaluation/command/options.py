"""The options of trax-eval: one table for help, parser and completion (completion.py)."""

import dataclasses
import os
import pathlib

from trax_eval.sweep import CHIPS, MODES
from trax_eval.util import Once, Parser, Problem

COLUMN = 24  # of the meanings in the help


def path_argument(text):
    if not text:
        raise Problem("--output: the value is empty")
    return pathlib.Path(text)


@dataclasses.dataclass(frozen=True)
class Option:
    name: str
    argument: str  # what the help calls its value; empty: it has none
    meaning: str
    letter: str = ""
    how: dict = dataclasses.field(default_factory=dict)  # for argparse
    mark: str = ""  # between several values
    words: tuple = ()  # for completion: values,
    folder: str = ""  # values in this folder of the data, NAME.json each,
    files: str = ""  # and files (f) or folders (d), as of bash's compgen
    parsed: bool = True  # False: dispatch takes it

    def add_to(self, parser):
        how = self.how if self.argument or "action" in self.how else {"action": "store_true"}
        parser.add_argument(*([f"-{self.letter}"] if self.letter else []), f"--{self.name}", **how)

    def lines(self):
        first, *others = self.meaning.split("\n")
        letter = f"-{self.letter}," if self.letter else "   "
        begin = f"  {letter} --{self.name}{' ' + self.argument if self.argument else ''}"
        return [f"{begin:{COLUMN - 1}} {first}", *(" " * COLUMN + line for line in others)]


def choice(values, **how):
    return {"how": {"choices": tuple(values), **how}, "words": tuple(values)}


GROUPS = {
    "What is run": (
        Option("all", "", "every experiment that is about a figure of the paper, and the page"),
        Option(
            "program", "NAMES",
            "those of a sweep's programs, with commas between (default: all); a file NAME.json takes the place\nof the "
            "sweep's",
            mark=",", folder="programs", files="f"),
        Option("scene", "NAMES", "those of a sweep's scenes", mark=",", folder="scenes"),
        Option("variant", "NAMES", "those of its variants, with semicolons between", mark=";"),
        Option("chip", "NAMES", "instead of the sweep's: presets, files", mark=",", words=tuple(CHIPS), files="f"),
        Option("size", "WxH", "of the pictures (default: what the sweep says, 1280x720)"),
        Option("mode", "WHICH", "exact or quick, instead of what the sweep says", **choice(MODES)),
        Option(
            "quick", "",
            "the same as --mode quick: some parts of each picture are simulated, and figures are estimates\n"
            "with intervals (trax-render --sampled). If --size is not given, pictures have two thirds of\n"
            "their sides; those of less than 640x360 are 80 pixels wide, and all of them is simulated",
            how={"dest": "mode", "action": "store_const", "const": "quick"}),
    ),
    "Where it runs": (
        Option("jobs", "N", "runs at the same time (default: the host's processors)",
               how={"type": int, "default": len(os.sched_getaffinity(0))}),
        Option("prepare", "",
               "prepares the runs that are missing, prints their keys, and ends: GNU parallel, Slurm or another\n"
               "scheduler calls `trax-eval job DIR KEY` for each, and the same command takes the results"),
    ),
    "Results": (
        Option("output", "DIR", "the folder of results (default: out/eval)", "o",
               {"default": "out/eval", "type": path_argument, "action": Once}, files="d"),
        Option("dry-run", "",
               "prints the runs that are missing, and what they take by those that are there, and ends;\n"
               "imports no scene and writes nothing"),
        Option("report", "", "writes the page, too: report.html in the folder of results"),
    ),
    "Other": (
        Option("quiet", "", "neither progress nor tables", "q"),
        Option("help", "", "print this, and end", "h", parsed=False),
        Option("version", "", "print the version, and end", parsed=False),
    ),
}
OPTIONS = [option for group in GROUPS.values() for option in group]


def described():
    """The groups as the help shows them."""
    return "\n\n".join("\n".join([f"{heading}:", *(line for option in group for line in option.lines())])
                       for heading, group in GROUPS.items())


def new_parser():
    parser = Parser(prog="trax-eval", add_help=False, allow_abbrev=False)
    parser.add_argument("words", nargs="*")
    for option in OPTIONS:
        if option.parsed:
            option.add_to(parser)
    return parser


def job_parser():
    """trax-eval job DIR KEY"""
    parser = Parser(prog="trax-eval job", add_help=False, allow_abbrev=False)
    parser.add_argument("out", type=path_argument)
    parser.add_argument("key")
    parser.add_argument("--threads", type=int, default=1)
    return parser
