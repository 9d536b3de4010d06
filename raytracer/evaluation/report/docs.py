"""trax-eval docs: the tables and plots of the pages of docs, written from files of results.

    trax-eval docs [RESULTS.json...] PAGE.md...
    trax-eval docs --check PAGE.md...

What stands in a page between `<!-- trax-eval NAME: begin -->` and `<!-- trax-eval NAME: end -->` is the table of that name, or with `plot NAME` the plot, an SVG
file beside the page. Names are those of the report's tables and of sweeps; a sweep's plot has the sweep's name. The figures are those of PAGE.json (another file if
the page has `<!-- trax-eval data: FILE -->`), which holds what the tables need and nothing else. Runs of RESULTS.json take the
place of those of the same sweep, program, workload, size and mode in that file; with --anew of the same sweep. Pages that share a file are given together. --check writes nothing, and ends with status 1 if a block or a plot is not what the file gives."""

import argparse
import itertools
import json
import pathlib
import re
import sys

from trax_eval.util import Problem, check_files, read_json, write_file

from . import rays, tables
from .charts import all_figures, sweep_figure
from .claims import claims
from .plots import PlotError, standalone
from .results import ASKED, HERE, Paper, Results, ResultsError, read_results

MARK = re.compile(r"<!-- trax-eval ((?:plot )?[\w.+-]+): begin -->\n(.*?)<!-- trax-eval \1: end -->", re.DOTALL)
ANY = re.compile(r"<!-- trax-eval ([^:>]*): (begin|end) -->")
DATA = re.compile(r"<!-- trax-eval data: (\S+) -->")
LIMIT = 1 << 24  # bytes of a page
DIGITS = 6  # of what is no whole number


class Page:
    def __init__(self, path):
        self.path = pathlib.Path(path)
        try:
            with open(self.path, "rb") as file:
                self.text = file.read(LIMIT).decode("utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise ResultsError(f"{path}: cannot be read: {error}") from None
        if len(self.text.encode()) >= LIMIT:
            raise ResultsError(f"{path}: {LIMIT} bytes or more")
        found = DATA.search(self.text)
        self.data = self.path.parent / found[1] if found else self.path.with_suffix(".json")
        self.names = [match[1] for match in MARK.finditer(self.text)]
        marks = [match[1] for match in ANY.finditer(self.text)]
        for name in marks:
            if self.names.count(name) != 1 or marks.count(name) != 2:
                raise ResultsError(f"{path}: the block \"{name}\" is to begin and end once")
        if not self.names:
            raise ResultsError(f"{path}: has no block (<!-- trax-eval NAME: begin --> and end)")


class Builder:
    """Tables and plots by name. Each is made with what it asked its runs for, by the runs' places."""

    def __init__(self, results, paper):
        self.results, self.paper, self.asked, self.plots = results, paper, {}, {}
        self.known = {}
        for sweep in results.sweeps:
            ASKED.clear()
            makers = tables.makers(results, paper, sweep)
            self.add(makers, sweep, ASKED.copy())
        self.add([lambda: tables.claims_table(claims(results, paper, results.programs()), results.programs()), lambda: tables.described(results, paper),
                  lambda: tables.hardware(results, paper), lambda: rays.gain_table(results), lambda: rays.kinds_table(results)], None, {})

    def add(self, makers, sweep, before):
        """before: what was asked for to know which tables there are; each needs it of its own runs."""
        for make in makers:
            ASKED.clear()
            table = make()
            self.known[table.identity] = table, sweep, {index: names | before.get(index, set()) for index, names in ASKED.items()}

    def plot(self, name):
        for sweep in self.results.sweeps:
            if sweep.get("name") == name:
                ASKED.clear()
                figure = sweep_figure(self.results, self.paper, sweep, name)
                if figure:
                    return figure, sweep, ASKED.copy()
        ASKED.clear()
        for figure in itertools.chain(rays.figures(self.results, self.paper), all_figures(self.results, self.paper)):
            if figure.identity == name and not figure.empty():
                return figure, None, ASKED.copy()
            ASKED.clear()
        raise ResultsError(f"there is no plot \"{name}\"")

    def found(self, name):
        if name.startswith("plot "):
            return self.plot(name.removeprefix("plot "))
        if name not in self.known:
            raise ResultsError(f"there is no table \"{name}\"; there are {', '.join(self.known)}")
        return self.known[name]

    def sweeps_of(self, sweep, asked):
        """Names of the sweeps that the runs come from: as few as have them all."""
        left, names = [set(self.results.runs[index].experiments) for index in asked if self.results.runs[index].experiments], []
        while left and not sweep:
            names.append(max(sorted(set().union(*left)), key=lambda name: sum(name in some for some in left)))
            left = [some for some in left if names[-1] not in some]
        return [sweep["name"]] if sweep else names

    def origin(self, sweep, asked):
        """What made the figures: the command, the size of the pictures, the version and the day."""
        runs = [run for run in self.results.runs if run.index in asked and run.done]
        sources = self.results.document.get("sources") or [{}]
        sizes = sorted({run.size for run in runs if run.size}, reverse=True)
        made = sorted({(str(source.get("trax") or "of an unknown version"), str(source.get("created") or "")[:10]) for run in runs for source in [sources[run.record.get("source", 0)]]})
        return (f"`trax-eval {' '.join(self.sweeps_of(sweep, asked))} SCENES`" + (f" at {', '.join('{}x{}'.format(*size) for size in sizes)}" if sizes else "")
                + "; measured with " + ", ".join(f"trax {version}" + (f" ({day})" if day else "") for version, day in made))

    def block(self, page, name, files):
        """The block's text; a plot's bytes go into files."""
        made, sweep, asked = self.found(name)
        origin = self.origin(sweep, asked)
        if not name.startswith("plot "):
            return f"{origin}:\n\n{made.without_empty().markdown()}"
        path = page.path.parent / f"{page.path.stem}-{made.identity}.svg"
        files[path] = standalone(made)
        return f"**{made.title}.** {origin}:\n\n![{made.title}]({path.name})\n"


def _digits(value):
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def _kept(run, names, source):
    """Of a run's record what says which run it is, and the figures of these names, flat: stats.mrps, values.area_units."""
    record = run.record
    kept = {name: record[name] for name in ("program", "scene", "workload", "variant", "config", "set", "size", "mode", "status") if record.get(name)}
    if any((point["config"], point["set"], point.get("variant", run.variant)) != (run.config, run.set, run.variant) for point in run.points):
        kept["points"] = [{name: point.get(name, "") for name in ("experiment", "variant", "config", "set")} for point in run.points]
    for name in sorted(names):
        part, path = ("values", [name.removeprefix("values.")]) if name.startswith("values.") else ("stats", name.split("."))
        value = record.get(part)
        for key in path:
            value = value.get(key) if isinstance(value, dict) else None
        if value is not None and not isinstance(value, dict) and (value or not name.endswith(".count")):
            kept[f"{part}.{'.'.join(path)}"] = _digits(value)
    return {**kept, "source": source}


def read_data(path):
    """A page's file of results: its runs stand as tables, each with the names of its columns."""
    document, runs = read_json(path), []
    try:
        for table in document["tables"]:
            for row in table["runs"]:
                run = {"experiments": table["experiments"], "stats": {}, "values": {}}
                for name, value in zip(table["names"], row, strict=True):
                    if value is None:
                        continue
                    part, _, rest = name.partition(".")
                    path_of = [part, *([rest] if part == "values" else rest.split(".") if rest else [])]
                    place = run
                    for key in path_of[:-1]:
                        place = place.setdefault(key, {})
                    place[path_of[-1]] = value
                runs.append(run)
        return {**{name: value for name, value in document.items() if name != "tables"}, "runs": runs}
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise ResultsError(f"{path}: is no file that trax-eval docs wrote: {error!r}") from None


def without(document, is_dropped):
    """A page's document without the runs of some sweeps: is_dropped(name of the sweep, run)."""
    runs = []
    for run in document.get("runs", []):
        left = [name for name in run["experiments"] if not is_dropped(name, run)]
        if left:
            points = [point for point in run.get("points", []) if point["experiment"] in left]
            runs.append({**run, "experiments": left, **({"points": points} if points else {})})
    return {**document, "runs": runs}


def merged(old, new):
    """One document with the sweeps of both. The new one's runs take the place of those of the same sweep, program, workload, size and mode."""
    def place(name, run):
        return name, run.get("program"), run.get("workload") or "", str(run.get("size")), run.get("mode")

    taken = {place(name, run) for run in new.get("runs") or [] for name in run.get("experiments") or []}
    old = without(old, lambda name, run: place(name, run) in taken)
    sources, runs = [*old.get("sources", [])], old["runs"]
    shift = len(sources)
    sources += new.get("sources") or [new]
    runs = runs + [{**run, "source": run.get("source", 0) + shift} for run in new.get("runs") or []]
    both = {}
    for kind in ("programs", "scenes", "workloads", "sweeps"):
        entries = {entry.get("name"): entry for document in (old, new) for entry in document.get(kind) or []}
        both[kind] = list(entries.values())
    return {"format": "trax-eval-results", "version": 2, "sources": sources, **both, "runs": runs}


def compact(document, pages, paper):
    """What the pages' blocks need of it, a run in a line."""
    results = Results(document)
    builder = Builder(results, paper)
    needed, sweeps = {}, set()
    for page in pages:
        for name in page.names:
            _, sweep, asked = builder.found(name)
            for index, names in asked.items():
                needed.setdefault(index, set()).update(names)
            sweeps.update(builder.sweeps_of(sweep, asked))
    runs, measured = [], {(run.program, run.workload, run.experiments[0]) for run in results.runs if run.index in needed and run.experiments}
    for run in results.runs:
        if sweeps & set(run.experiments) and (run.index in needed or not run.done and (run.program, run.workload, run.experiments[0]) in measured):
            kept = _kept(run, needed.get(run.index, ()), run.record.get("source", 0))
            if "points" in kept:
                kept["points"] = [point for point in kept["points"] if point["experiment"] in sweeps]
            runs.append(([name for name in run.experiments if name in sweeps], kept))
    sources, grouped = [], {}
    for experiments, kept in runs:
        source = {name: document["sources"][kept["source"]].get(name) for name in ("trax", "created")}
        sources += [] if source in sources else [source]
        kept["source"] = sources.index(source)
        grouped.setdefault(tuple(experiments), []).append(kept)
    names = {kind: set(results.named(kind)) for kind in ("programs", "scenes", "workloads")}
    lists = {"sources": sources,
             **{kind: [entry for entry in document.get(kind) or [] if entry.get("name") in names[kind]] for kind in names},
             "sweeps": [{key: value for key, value in sweep.items() if key != "file" and value not in (None, "", [])} for sweep in results.sweeps if sweep["name"] in sweeps]}

    def text(value):
        return json.dumps(value, ensure_ascii=False, separators=(",", ":"))

    def listed(entries):
        return "[\n" + ",\n".join(entries) + "\n]"

    parts = [f'"{key}": {listed(map(text, entries))}' for key, entries in lists.items()]
    groups = []
    for experiments, rows in grouped.items():
        columns = list(dict.fromkeys(name for kept in rows for name in kept))
        groups.append(f'{{"experiments":{text(experiments)},\n"names":{text(columns)},\n"runs":{listed(text([kept.get(name) for name in columns]) for kept in rows)}}}')
    parts.append(f'"tables": {listed(groups)}')
    return '{"format": "trax-eval-results", "version": 2,\n' + ",\n".join(parts) + "}\n"


def write_pages(pages, paper, check):
    """The pages' blocks from their files of results; what differs if check, else they are written."""
    stale, builders = [], {}
    for page in pages:
        if page.data not in builders:
            builders[page.data] = Builder(Results(read_data(page.data)), paper)
        builder, files = builders[page.data], {}

        def replaced(match):
            text = builder.block(page, match[1], files)
            if check and text != match[2]:
                stale.append(f"{page.path}: the block \"{match[1]}\" is not what {page.data} gives; trax-eval docs {page.path} writes it")
            return f"<!-- trax-eval {match[1]}: begin -->\n{text}<!-- trax-eval {match[1]}: end -->"

        text = MARK.sub(replaced, page.text)
        for path, figure in files.items():
            if not check:
                write_file(path, figure)
            elif not path.exists() or path.read_text(encoding="utf-8") != figure:
                stale.append(f"{path}: is not what {page.data} gives; trax-eval docs {page.path} writes it")
        if not check and text != page.text:
            write_file(page.path, text)
    return stale


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="trax-eval docs", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="RESULTS.json or PAGE.md")
    parser.add_argument("--check", action="store_true", help="write nothing; status 1 if a block is not what the file gives")
    parser.add_argument("--anew", action="store_true", help="earlier runs of the sweeps of RESULTS.json are dropped, whatever their size")
    options = parser.parse_args(arguments)
    try:
        wrong = [name for name in options.files if not name.endswith((".json", ".md"))]
        if wrong:
            raise ResultsError(f"{wrong[0]}: expected RESULTS.json or PAGE.md")
        sources, paper = [name for name in options.files if name.endswith(".json")], Paper(HERE.parent / "paper")
        pages = [Page(name) for name in options.files if name.endswith(".md")]
        if not pages or options.check and sources:
            raise ResultsError("no page was named" if not pages else "--check takes pages only")
        check_files(sources, [page.path for page in pages])
        if sources:
            for data in dict.fromkeys(page.data for page in pages):
                document, added = read_data(data) if data.exists() else {}, [read_results(name).document for name in sources]
                if options.anew:
                    names = {name for new in added for run in new.get("runs") or [] for name in run.get("experiments") or []}
                    document = without(document, lambda name, run: name in names)
                for new in added:
                    document = merged(document, new)
                write_file(data, compact(document, [page for page in pages if page.data == data], paper))
        stale = write_pages(pages, paper, options.check)
    except (Problem, ResultsError, PlotError) as error:
        print(f"trax-eval docs: error: {error}", file=sys.stderr)
        return 1
    for text in stale:
        print(f"trax-eval docs: {text}", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
