"""trax-eval docs: the tables and plots of the pages of docs, written from files of results.

    trax-eval docs [--anew] [RESULTS.json...] PAGE.md...
    trax-eval docs --check PAGE.md...

What stands in a page between `<!-- trax-eval NAME: begin -->` and `<!-- trax-eval NAME: end -->` is the table of that
name, or with `plot NAME` the plot, an SVG file beside the page. Names are those of the report's tables and of sweeps; a
sweep's plot has the sweep's name. The figures are those of PAGE.json (another file if the page has `<!-- trax-eval
data: FILE -->`), which holds what the tables need and nothing else. Runs of RESULTS.json take the place of those of the
same sweep, program, workload, size and mode in that file; with --anew of the same sweep and program. Pages that share a
file are given together; a folder stands for its pages that have blocks. --check writes nothing, and ends with status 1
if a block or a plot is not what the file gives."""

import argparse
import itertools
import os
import pathlib
import re
import sys

from trax_eval.util import Parser, Problem, check_files, complain, write_file

from . import choices, estimates, fronts, rays, simd, tables
from .charts import all_figures, sweep_figure
from .claims import UNKNOWN, claims
from .data import compact, merged, read_data, results_of, without
from .paper import Paper
from .picture import standalone
from .results import HERE, read_results

MARK = re.compile(r"<!-- trax-eval ((?:plot )?[\w.+-]+): begin -->\n(.*?)<!-- trax-eval \1: end -->", re.DOTALL)
ANY = re.compile(r"<!-- trax-eval ([^:>]*): (begin|end) -->")
DATA = re.compile(r"<!-- trax-eval data: (\S+) -->")
LIMIT = 1 << 24  # bytes of a page


class Page:
    def __init__(self, path):
        self.path = pathlib.Path(path)
        try:
            with open(self.path, "rb") as file:
                self.text = file.read(LIMIT).decode("utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise Problem(f"{path}: cannot be read: {error}") from None
        if len(self.text.encode()) >= LIMIT:
            raise Problem(f"{path}: {LIMIT} bytes or more")
        found = DATA.search(self.text)
        self.data = self.path.parent / found[1] if found else self.path.with_suffix(".json")
        self.names = [match[1] for match in MARK.finditer(self.text)]
        marks = [match[1] for match in ANY.finditer(self.text)]
        for name in marks:
            if self.names.count(name) != 1 or marks.count(name) != 2:
                raise Problem(f"{path}: the block \"{name}\" is to begin and end once")
        if not self.names:
            raise Problem(f"{path}: has no block (<!-- trax-eval NAME: begin --> and end)")


class Builder:
    """Tables and plots by name. Each is made with what it asked its runs for, by the runs' places."""
    def __init__(self, results, paper):
        self.results, self.paper, self.known = results, paper, {}
        for sweep in results.sweeps:
            self.results.asked.clear()
            makers = tables.makers(results, paper, sweep)
            self.add(makers, sweep, dict(self.results.asked))
            if made := estimates.of_sweep(results, sweep):
                self.add([made], sweep, {})
        self.add([
            self.claims, lambda: tables.described(results, paper), lambda: tables.hardware(results, paper),
            lambda: rays.kinds_table(results), lambda: choices.table(results, paper),
            lambda: simd.best_table(results), lambda: simd.kinds_table(results),
            lambda: fronts.chips_table(results, paper)
        ], None, {})

    def claims(self):
        """The claims table of the programs that are no sweep's variants, without claims that have no figures."""
        programs = [
            name for name in self.results.programs()
            if any(run.program == name and not run.variant for run in self.results.runs)
        ]
        judged = claims(self.results, self.paper, programs)
        known = [claim for claim in judged if any(claim.verdicts[name][0] != UNKNOWN for name in programs)]
        return tables.claims_table(self.results, known, programs)

    def add(self, makers, sweep, before):
        """before: the values that were read to find the tables; each table needs them of its own runs."""
        for make in makers:
            self.results.asked.clear()
            table = make()
            if table is None:
                continue
            self.known[table.identity] = table, sweep, {
                index: names | before.get(index, set()) for index, names in self.results.asked.items()
            }

    def plot(self, name):
        for sweep in self.results.sweeps:
            if sweep.get("name") == name:
                self.results.asked.clear()
                figure = sweep_figure(self.results, self.paper, sweep, name)
                if figure:
                    return figure, sweep, dict(self.results.asked)
        self.results.asked.clear()
        for figure in itertools.chain(rays.figures(self.results, self.paper), simd.figures(self.results),
                                      fronts.figures(self.results, self.paper), all_figures(self.results, self.paper)):
            if figure.identity == name and not figure.empty():
                return figure, None, dict(self.results.asked)
            self.results.asked.clear()
        raise Problem(f"there is no plot \"{name}\"")

    def found(self, name):
        if name.startswith("plot "):
            return self.plot(name.removeprefix("plot "))
        if name not in self.known:
            raise Problem(f"there is no table \"{name}\"; there are {', '.join(self.known)}")
        return self.known[name]

    def sweeps_of(self, sweep, asked):
        """Names of the sweeps that the runs come from: as few as have them all."""
        left, names = [
            set(self.results.runs[index].experiments) for index in asked if self.results.runs[index].experiments
        ], []
        while left and not sweep:
            names.append(max(sorted(set().union(*left)), key=lambda name: sum(name in some for some in left)))
            left = [some for some in left if names[-1] not in some]
        return [sweep["name"]] if sweep else names

    def origin(self, sweep, asked):
        """The origin of the figures: the command, the size of the pictures, the version and the day."""
        runs = [run for run in self.results.runs if run.index in asked and run.done]
        sources = self.results.document.get("sources") or [{}]
        sizes = sorted({run.size for run in runs if run.size}, reverse=True)
        made = sorted({(str(source.get("trax") or "of an unknown version"), str(source.get("created") or "")[:10])
                       for run in runs for source in [sources[run.record.get("source", 0)]]})
        return (f"`trax-eval {' '.join(self.sweeps_of(sweep, asked))} SCENES`" +
                (f" at {', '.join('{}x{}'.format(*size) for size in sizes)}" if sizes else "") + "; measured with " +
                ", ".join(f"trax {version}" + (f" ({day})" if day else "") for version, day in made))

    def block(self, page, name, files):
        """The block's text; a plot's bytes go into files."""
        made, sweep, asked = self.found(name)
        origin = self.origin(sweep, asked)
        if not name.startswith("plot "):
            return f"{origin}:\n\n{made.without_empty().markdown()}"
        path = page.data.with_name(f"{page.data.stem}-{made.identity}.svg")
        files[path] = standalone(made)
        return f"**{made.title}.** {origin}:\n\n![{made.title}]({os.path.relpath(path, page.path.parent)})\n"


def needs(pages, builder):
    """Returns the figures that the pages' blocks show: their names by run, and the names of the sweeps."""
    needed, sweeps = {}, set()
    for page in pages:
        for name in page.names:
            _, sweep, asked = builder.found(name)
            for index, names in asked.items():
                needed.setdefault(index, set()).update(names)
            sweeps.update(builder.sweeps_of(sweep, asked))
    return needed, sweeps


def renew(data, sources, pages, paper, anew):
    """Writes the file of results of some pages, with the runs of the sources."""
    document = read_data(data) if data.exists() else {}
    added = [read_results(name).document for name in sources]
    if anew:
        places = {(name, run.get("program")) for new in added for run in new.get("runs") or []
                  for name in run.get("experiments") or []}
        document = without(document, lambda name, run: (name, run.get("program")) in places)
    for new in added:
        document = merged(document, new)
    results = results_of(document)
    write_file(data, compact(document, results, *needs(pages, Builder(results, paper))))


def pages_of(names):
    """The pages of these names; of a folder those that have blocks."""
    pages = []
    for name in names:
        folder = pathlib.Path(name)
        paths = [path for path in sorted(folder.glob("*.md"))
                 if MARK.search(path.read_text(encoding="utf-8", errors="replace"))] if folder.is_dir() else [name]
        pages += map(Page, paths)
    return pages


def write_pages(pages, paper, check):
    """The pages' blocks from their files of results; what differs if check, else they are written."""
    stale, builders = [], {}
    for page in pages:
        if page.data not in builders:
            builders[page.data] = Builder(results_of(read_data(page.data)), paper)
        builder, files = builders[page.data], {}

        def replaced(match):
            text = builder.block(page, match[1], files)
            if check and text != match[2]:
                stale.append(
                    f"{page.path}: the block \"{match[1]}\" is not what {page.data} gives; trax-eval docs {page.path} "
                    f"writes it"
                )
            return f"<!-- trax-eval {match[1]}: begin -->\n{text}<!-- trax-eval {match[1]}: end -->"

        text = MARK.sub(replaced, page.text)
        for path, figure in files.items():
            if not check:
                write_file(path, figure)
            elif not path.exists() or figure.encode() != path.read_bytes():
                stale.append(f"{path}: is not what {page.data} gives; trax-eval docs {page.path} writes it")
        if not check and text != page.text:
            write_file(page.path, text)
    return stale


def new_parser():
    parser = Parser(prog="trax-eval docs", description=__doc__,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="RESULTS.json or PAGE.md")
    parser.add_argument("--check", action="store_true",
                        help="write nothing; status 1 if a block is not what the file gives")
    parser.add_argument("--anew", action="store_true",
                        help="earlier runs of the sweeps and programs of RESULTS.json are dropped, whatever their size")
    return parser


def main(arguments=None):
    try:
        options = new_parser().parse_args(arguments)
        sources, paper = [name for name in options.files if name.endswith(".json")], Paper(HERE.parent / "paper")
        wrong = [
            name for name in options.files if not name.endswith((".json", ".md")) and not pathlib.Path(name).is_dir()
        ]
        if wrong:
            raise Problem(f"{wrong[0]}: expected RESULTS.json, PAGE.md or a folder of pages")
        pages = pages_of(name for name in options.files if not name.endswith(".json"))
        if not pages or options.check and sources:
            raise Problem("no page was named" if not pages else "--check takes pages only")
        check_files(sources, [page.path for page in pages])
        for data in dict.fromkeys(page.data for page in pages) if sources else ():
            renew(data, sources, [page for page in pages if page.data == data], paper, options.anew)
        stale = write_pages(pages, paper, options.check)
    except Problem as error:
        complain("trax-eval docs", error)
        return 1
    for text in stale:
        print(f"trax-eval docs: {text}", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
