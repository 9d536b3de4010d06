"""trax-eval report: the page of one file of results.

    trax-eval report RESULTS.json -o REPORT.html

The page holds all that it shows, pictures and figures included, and asks no network for anything; only its links lead
to the runs' files. The same results give the same bytes."""

import base64
import os
import pathlib
import sys
import urllib.parse

from trax_eval.outputs import IsInput, read, write_output
from trax_eval.util import Once, Parser, Problem, check_files, complain

from . import choices, estimates, machines, own, rays, simd, tables
from .charts import all_figures, sweep_figure
from .claims import AGREES, DIFFERS, FITTED, NOT_MEASURED, UNKNOWN, claims, median, table2_deviations
from .markup import Html, el, join, table
from .paper import Paper
from .plots import draw, shapes
from .results import number, read_results, shown
from .table import seconds

MOST_MOMENTS = 8  # of a scene, whose pictures the page has

HERE = pathlib.Path(__file__).resolve().parent
PAPERS_TITLE = "A mobile accelerator for ray tracing: our figures beside the paper's"
SHORT = {
    "tables": "Tables", "rays": "Rays by kind", "simd": "SIMD", "stalls": "Time", "units": "Hardware",
    "error": "Error and run time"
}  # in the page's head


def summary(results, paper, judged):
    """The summary in plain words: what was measured, and what agrees."""
    done, failed = [run for run in results.runs if run.done], [run for run in results.runs if run.status == "failed"]
    sentences = [
        f"{len(done)} of {len(results.runs)} runs {'is' if len(done) == 1 else 'are'} there" +
        (f", {len(failed)} failed." if failed else ".")
    ]
    cells = {
        run.size for program in results.programs() for scene in results.papers for chip in paper.chips
        if (run := results.cell(program, scene, chip)) and run.done and run.size
    }
    others = {run.size for run in done if run.size} - cells

    def named(sizes):
        return ", ".join(f"{width}x{height}" for width, height in sorted(sizes, reverse=True))

    if cells:
        sentences.append(f"The pictures of the paper's tables have {named(cells)} pixels" +
                         (f", those of other sweeps {named(others)}" if others else "") +
                         "; the paper's have 1280x720.")
        if min(cells) < (1280, 720):
            sentences.append("In a smaller picture neighbouring rays share less, so each moves more bytes, "
                             "and large chips run out of bandwidth sooner. "
                             "Verdicts on small pictures are therefore weak.")
    times = [run.host_seconds for run in done if run.host_seconds]
    if times:
        sentences.append(f"The runs took {seconds(sum(times))} of the host's time together.")
    items = [el("p", " ".join(sentences))]
    for program in results.programs():
        deviations = table2_deviations(results, paper, program)
        said, not_said, fitted = (sum(claim.verdicts[program][0] == verdict for claim in judged)
                                  for verdict in (AGREES, DIFFERS, FITTED))
        text = [
            el(
                "b", f"{program}: {title}" if
                (title := results.title("programs", program)) != program else f"Program “{program}”"), ": "
        ]
        if deviations:
            middle, single = median(deviations), len(deviations) == 1
            cells = "the one measured cell" if single else f"the {len(deviations)} measured cells"
            text.append(f"Against {cells} of Table 2 it has {100 * abs(middle):.0f} % "
                        f"{'more' if middle >= 0 else 'fewer'} rays per second{'' if single else ' (median)'}. ")
        text.append(tables.own_machine(results, program))
        text.append(
            f"Agrees with the paper in {said} of {len(judged)} claims, differs in {not_said}; fitted: {fitted}; "
            f"not known: {len(judged) - said - not_said - fitted}."
            if said + not_said + fitted else f"These runs judge none of the paper's {len(judged)} claims."
        )
        items.append(el("p", *text))
    return join(items)


def some_of(moments):
    """The moments in order, without one first; of many some, evenly, with the first and the last."""
    found = sorted(moments, key=lambda moment: (moment is not None, moment or 0))
    last, steps = len(found) - 1, min(len(found), MOST_MOMENTS) - 1
    return [found[last * i // max(steps, 1)] for i in range(steps + 1)]


def pictures(results, base):
    """One picture of a scene, or of each of its moments, and program, inlined: the largest."""
    chosen = {}
    for run in results.runs:
        if run.done and run.picture and run.size:
            moments = chosen.setdefault((run.scene, run.program), {})
            moment = number(run.set.get("trax-scene --at"))
            best = moments.get(moment)
            if best is None or run.size > best.size:
                moments[moment] = run
    shown = []
    for scene, program, moment, run in (
            (*key, moment, moments[moment]) for key, moments in sorted(chosen.items()) for moment in some_of(moments)):
        path = base / run.picture
        name = scene if moment is None else f"{scene} at {moment:g}"
        caption = el("figcaption", f"{name}, {program}, {run.size[0]}x{run.size[1]}")
        try:
            data = path.read_bytes()
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            shown.append(el("figure", caption, el("p", f"{run.picture}: {reason}", class_="missing")))
            continue
        if not data.startswith(b"\x89PNG\r\n\x1a\n"):
            shown.append(el("figure", caption, el("p", f"{run.picture}: is not a PNG file", class_="missing")))
            continue
        shown.append(
            el(
                "figure", caption,
                el("img", src="data:image/png;base64," + base64.b64encode(data).decode(),
                   alt=f"{name} rendered by {program}", width=run.size[0], height=run.size[1])))
    return el("div", *shown, class_="pictures") if shown else el("p", "No run has a picture.", class_="missing")


def linker(base, folder):
    """Links to the runs' files, from the place of the page."""
    def link(path):
        return urllib.parse.quote(os.path.relpath(base / path, folder).replace(os.sep, "/")) if path else ""

    return link


def flat(value, prefix=""):
    """The keys of a configuration, dotted."""
    for key, inner in value.items():
        if isinstance(inner, dict):
            yield from flat(inner, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", inner


def configurations(results):
    """The distinct configurations, and for each run the number of its own."""
    numbers, of_run, listed = {}, {}, []
    for run in results.runs:
        configuration = run.stats.get("configuration")
        if not isinstance(configuration, dict):
            continue
        items = tuple(
            (key, f"{value:g}" if isinstance(value, float) and number(value) is not None else shown(value))
            for key, value in flat(configuration))
        if items not in numbers:
            numbers[items] = len(numbers) + 1
            listed.append((numbers[items], dict(items), run.config))
        of_run[run.index] = numbers[items]
    if not listed:
        return el("p", "No run has a record of its configuration.", class_="missing"), of_run
    first = listed[0][1]
    blocks = []
    for place, items, chip in listed:
        other = [f"{key} = {value}" for key, value in items.items() if first.get(key) != value]
        summary = "every key" if place == 1 else "C1 but for " + ", ".join(other)
        body = el("dl", *(join([el("dt", key), el("dd", value)]) for key, value in items.items()), class_="keys")
        blocks.append(
            el("details", el("summary", el("b", f"C{place}"), f" ({chip}): {summary}"), body,
               id=f"configuration-{place}"))
    return join(blocks), of_run


class Page:
    """The page of one file of results. folder: the page's; base: the results'."""
    def __init__(self, results, paper, base, folder):
        self.results, self.paper, self.base, self.folder = results, paper, base, folder
        self.programs = results.programs()
        self.own = own.sweeps(results)
        figures = self.own_figures() if self.own else all_figures(results, paper)
        figures = (*figures, *rays.figures(results, paper), *simd.figures(results))
        self.made = {figure.identity: figure for figure in figures}
        self.drawn = {identity: draw(figure) for identity, figure in self.made.items()}

    def figures(self, prefix):
        """The figures whose names begin with the prefix; None if nothing was measured for any of them."""
        shown = [identity for identity in self.made if identity.startswith(prefix)]
        if all(self.made[identity].empty() for identity in shown):
            return None
        return el("div", *(self.drawn[identity] for identity in shown), class_="figures")

    def has_papers(self):
        """Whether a cell of the paper's tables has a run, be it a failed one."""
        cells = (self.results.cell(program, scene, chip) for program in self.programs for scene in self.results.papers
                 for chip in self.paper.chips)
        return any(run is not None for run in cells)

    def of_programs(self, make):
        return [table(make(self.results, self.paper, program)) for program in self.programs]

    def own_figures(self):
        results = own.one_of_each(self.results)
        for sweep in self.own:
            drawn = sweep_figure(results, self.paper, sweep, f"sweep-{results.sweeps.index(sweep)}")
            if drawn:
                yield own.renamed(drawn, sweep)

    def sections(self):
        """Yields (identity, title, content)."""
        if self.own:
            yield from own.sections(self.own, self)
            yield from self.kinds_sections()
        else:
            yield from self.papers_sections()
        if not self.own or any(run.done and run.picture and run.size for run in self.results.runs):
            yield "pictures", "Pictures", [pictures(self.results, self.base)]
        listed, of_run = configurations(self.results)
        runs = tables.run_table(self.results, self.paper, linker(self.base, self.folder), of_run)
        yield "all-runs", "Runs", [table(runs.without_empty() if self.own else runs)]
        yield "configurations", "Configurations", [listed]

    def kinds_sections(self):
        results = self.results
        if rays.groups(results):
            yield "rays", "Rays by kind", [
                el("p", rays.EXPLAINED), self.figures("rays-"),
                el("details", el("summary", "Every kind of ray on every machine"), table(rays.kinds_table(results)))
            ]
        if machines.machines(results):
            yield "simd", "MIMD against SIMD", [
                el("p", simd.EXPLAINED), self.figures("simd-"), table(simd.best_table(results)),
                el("details", el("summary", "By kind of ray"), table(simd.kinds_table(results)))
            ]

    def papers_sections(self):
        results, paper = self.results, self.paper
        judged = claims(results, paper, self.programs)
        known = any(verdict != (UNKNOWN, NOT_MEASURED) for claim in judged for verdict in claim.verdicts.values())
        verdicts = table(tables.claims_table(results, judged, self.programs)) if known else None
        by_choice = choices.table(results, paper)
        yield "summary", "Summary", [
            summary(results, paper, judged), verdicts, *([table(by_choice)] if by_choice else [])
        ]
        if self.has_papers():
            yield "tables", "The paper's tables", [
                table(tables.table1(results, paper)), *self.of_programs(tables.table2),
                table(tables.table3(results, paper))
            ]
        yield from self.kinds_sections()
        if self.has_papers():
            text = ("Speed-up over the same program on 1x32. Where chips have as many threads, each is a mark of its "
                    "own.")
            yield "scaling", "Scaling", [
                el("p", text), self.figures("scaling-"),
                el("details", el("summary", "As tables"), *self.of_programs(tables.speedups),
                   *self.of_programs(tables.table1_scenes))
            ]
        if stalls := self.figures("stalls-"):
            text = "Every thread is charged every cycle to one cause (docs/timing.md)."
            yield "stalls", "Where the time goes", [el("p", text), stalls]
        yield "units", "Hardware and bandwidth", [
            self.figures("memory-"), table(tables.hardware(results, paper)) if self.has_papers() else None,
            table(tables.described(results, paper))
        ]
        sampled, errors = estimates.every(results), self.figures("error-")
        if sampled or errors:
            yield "error", "Error and run time", [errors, table(sampled) if sampled else None]
        if results.series:
            text = ("Shares of the thread-cycles of each interval. fetch_refused is the share of instruction fetches "
                    "that a bank conflict refused.")
            yield "time", "Over time", [el("p", text), self.figures("series-")]
        if shown := list(self.sweeps()):
            yield "sweeps", "Sweeps", [el("div", *shown, class_="sweeps")]

    def sweeps(self):
        """A section for each sweep; the paper's tables have their own."""
        for index, sweep in enumerate(self.results.sweeps):
            name = sweep.get("name")
            if name in ("table1", "table2", "table3"):
                continue
            made = tables.of_sweep(self.results, self.paper, sweep)
            parts = [
                el("h3", str(sweep.get("title") or name or f"sweep {index}")),
                el("p", str(sweep["claim"])) if sweep.get("claim") else None,
                self.drawn.get(f"sweep-{index}"),
                el("details", el("summary", "As a table"), *(table(one, f"sweep-{index}-") for one in made))
            ]
            yield el("section", *(part for part in parts if part is not None), class_="sweep")

    def about(self):
        """The command, the version, the day and the host."""
        results = self.results
        yield el("code", results.text("command") or "trax-eval")
        yield f"trax {results.text('trax')}" if results.text("trax") else None
        yield results.text("created")
        host = results.document.get("host")
        if isinstance(host, dict):
            yield ", ".join(f"{key}: {value}" for key, value in host.items() if isinstance(value, (str, int, float)))

    def html(self):
        style, script = ((HERE / name).read_text(encoding="utf-8") for name in ("page.css", "page.js"))
        head = el("head", el("meta", charset="utf-8"),
                  el("meta", name="viewport", content="width=device-width, initial-scale=1"),
                  el("meta", name="color-scheme", content="light dark"),
                  el("title", own.title(self.own) or "Evaluation of trax"), el("style", Html(style)))
        sections = list(self.sections())
        links = (el("a", SHORT.get(identity, title), href="#" + identity) for identity, title, _ in sections)
        body = el(
            "body", el("svg", shapes(), width="0", height="0", aria_hidden="true", class_="shapes"),
            el("header", el("h1", own.title(self.own) or PAPERS_TITLE),
               el("p", join([part for part in self.about() if part], " · "), class_="about"),
               el("nav", *links, el("button", "Light or dark", type="button", id="theme"))),
            el("main",
               *(el("section", el("h2", title), join(content), id=identity) for identity, title, content in sections)),
            el("script", Html(script)))
        return "<!DOCTYPE html>\n" + el("html", head, body, lang="en") + "\n"


def new_parser():
    parser = Parser(prog="trax-eval report", description="Makes one HTML page of a file of results.")
    parser.add_argument("results", type=pathlib.Path, metavar="RESULTS.json")
    parser.add_argument("-o", "--output", action=Once, metavar="FILE.html",
                        help="the page (default: report.html beside the results)")
    parser.add_argument("--paper", type=pathlib.Path, default=HERE.parent / "paper", metavar="DIR",
                        help="the paper's tables (default: those that come with trax)")
    return parser


def main(arguments=None):
    read.clear()
    output = pathlib.Path("report.html")
    try:
        options = new_parser().parse_args(arguments)
        output = pathlib.Path(options.output or output)
        if not options.results.name:
            raise Problem("the name of the results is empty")
        if not options.output:
            output = options.results.with_name("report.html")
        check_files([options.results], [output])
        results, paper = read_results(options.results), Paper(options.paper)
        folder = output.absolute().parent
        text = Page(results, paper, options.results.absolute().parent, folder).html()
        write_output(output, text.encode("utf-8", errors="backslashreplace"), foreign=True)
    except (Problem, IsInput) as error:
        complain("trax-eval report", error)
        return 1
    except OSError as error:
        complain("trax-eval report", f"{output}: cannot be written: {error.strerror}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
