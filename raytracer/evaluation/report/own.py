"""The page of sweeps that do not come with trax: their own questions, what the figures cost, and why runs failed."""

import copy
import pathlib
import re

from trax_eval.sweep import option_of

from . import tables
from .charts import CAUSES, STYLES, shares
from .markup import el, join, table
from .plots import Bars, Lines, Series, draw
from .results import Results, ratio, shown
from .sweeps import TITLES, interval_text
from .table import Cell, Table, figure, words

COME_WITH_TRAX = pathlib.Path(__file__).resolve().parent.parent / "sweeps"
# Names of axes, with units. Keys of the machine have theirs in their names.
LABELS = {
    "mrps": "million rays per second", "gflops": "billion FLOPs per second", "cycles": "cycles", "threads": "threads",
    "values.bytes_per_ray": "bytes a ray", "values.flops_per_ray": "FLOPs a ray", "values.area_units": "area (mm²)",
    "area_mm2": "area (mm²)", "energy.average_power": "power of chip and caches (W)", "energy.total": "energy (J)",
    "energy.per_ray": "energy a ray (J)", "memory.bandwidth_gbps": "off-chip bandwidth (GB/s)",
    "memory.utilisation": "share of the bandwidth in use", "values.frames_per_second": "pictures per second",
    "seconds": "simulated time (s)", "host.processor_seconds": "processor time of the host (s)",
    "kind.mrps": "million rays per second", "kind.bytes_per_ray": "bytes a ray",
    "kind.energy_per_ray": "energy a ray (nJ)", "issue.utilisation": "share of the thread-cycles with an instruction",
    "values.scene.bvh.sah_nodes": "visits of nodes that SAH expects",
    "values.rebuild_pays_below": "cycles below which a new tree pays", "trax-scene --at": "moment"
}
# Costs of a rate: identity, statistic, title.
COSTS = [("area", "values.area_units", "Rays and area"), ("power", "energy.average_power", "Rays and power"),
         ("bandwidth", "memory.bandwidth_gbps", "Rays and off-chip bandwidth in use")]
MOST_BARS, MOST_LETTERS, LEAST_LETTERS, MOST_FRONTS = 40, 24, 5, 16
# Options of trax-scene and trax-render that change how a picture is made, but none of its rays; "sample-" begins some.
DESIGN = re.compile("nodes|leaf|splits|passes|depth|traversal-cost|cache-lines|tree|tree-triangles|tree-boxes|refit"
                    "|refit-from|instances|flatten|unpack-limit|ray-order|queues|no-specialise|mark-rays|sample-.*")


def sweeps(results):
    """The sweeps if none of them comes with trax; else none: then the page is about the paper."""
    found = [sweep for sweep in results.sweeps if isinstance(sweep.get("name"), str)]
    known = {path.stem for path in COME_WITH_TRAX.glob("*.json")}
    theirs = any(sweep["name"] in known for sweep in found)
    return [] if theirs or len(found) < len(results.sweeps) else found


def title_of(sweep):
    return str(sweep.get("title") or sweep["name"])


def title(own):
    return " · ".join(map(title_of, own))


def label(name, per=None):
    """Returns what a statistic is, with its unit."""
    text = LABELS.get(name) or TITLES.get(name) or name.removeprefix("values.").replace("_", " ")
    return f"{text} / {label(per)}" if per else text


def renamed(lines, sweep):
    """The figure of a sweep with axes that name quantities and units."""
    lines.y = label(sweep.get("y") or "mrps", sweep.get("y_per")) if lines.y != "MRPS" else LABELS["mrps"]
    lines.x = LABELS.get(lines.x, lines.x)
    lines.title = f"{lines.y} against {lines.x}"
    return lines


def name_of(run, varying):
    """Returns what tells a run from the others."""
    parts = [run.config, run.variant, *(f"{key}={shown(value)}" for key, value in run.set.items())]
    for axis in ("scene", "program", "workload"):
        if axis in varying and getattr(run, axis):
            parts.insert(0, getattr(run, axis))
    return ", ".join(dict.fromkeys(part for part in parts if part))


def varying(runs):
    return [axis for axis in ("scene", "program", "workload") if len({getattr(run, axis) for run in runs}) > 1]


# --- what a rate costs ---


def design(run):
    """Identifies a design: an estimate and an exact run of it have the same one."""
    return run.scene, run.workload, run.size, run.program, run.config, run.variant, repr(sorted(run.set.items()))


def best_known(runs):
    """Returns each design's exact run, or its estimate until there is one."""
    exact = {design(run) for run in runs if run.done and not run.is_estimate()}
    return [run for run in runs if not (run.is_estimate() and design(run) in exact)]


def one_of_each(results):
    """The results of the runs that are best known. Their mode tells no runs apart."""
    runs = [copy.copy(run) for run in best_known(results.runs)]
    for run in runs:
        run.mode = ""
    return Results(results.document, runs)


def content(run):
    """The options of a run that decide what is rendered, as texts."""
    options = {key: option_of(key) for key in run.set}
    return tuple(f"{key}={shown(run.set[key])}" for key, option in sorted(options.items())
                 if option and not DESIGN.fullmatch(option[1]))


def groups(runs):
    """The runs that are best known and render the same: by scene, workload, options and size."""
    found = {}
    for run in best_known(runs):
        if run.get("mrps") is not None:
            found.setdefault((run.scene, run.workload, *content(run), run.size), []).append(run)
    return found


def front(runs, cost):
    """The runs that no other run beats, by more rays at no higher cost or as many at a lower one; by increasing
    cost."""
    known = [run for run in runs if run.get(cost) is not None]
    best, chosen = None, []
    for run in sorted(known, key=lambda run: (run.get(cost), -run.get("mrps"))):
        place = run.get(cost), run.get("mrps")
        if best is None or place[1] > best[1] or place == best:
            best = place
            chosen.append(run)
    return chosen


def front_figures(runs):
    axes, found = varying(runs), groups(runs)
    for identity, cost, heading in COSTS if len(found) <= MOST_FRONTS else ():
        series = []
        for place, (group, some) in enumerate(found.items()):
            points = sorted((run.get(cost), run.get("mrps"), f"{name_of(run, axes)}: {run.get('mrps'):.4g} MRPS, "
                             f"{run.get(cost):.4g}") for run in some if run.get(cost) is not None)
            if len({point[0] for point in points}) < 2:
                continue
            style, mark = STYLES[place % len(STYLES)]
            named = ", ".join(part for part in group[:-1] if part)
            series.append(Series(named, style, points, mark, line=False))
            best = [(run.get(cost), run.get("mrps"), name_of(run, axes)) for run in front(some, cost)]
            series.append(Series(f"front of {named} (dashed)", style, best, mark, dashed=True))
        if series:
            yield Lines(f"front-{identity}", heading, label(cost), LABELS["mrps"], series)


def front_table(runs):
    axes, rows = varying(runs), []
    for some in groups(runs).values():
        fronts = {identity: front(some, cost) for identity, cost, _ in COSTS}
        for run in some:
            on = ", ".join(identity for identity, chosen in fronts.items() if run in chosen)
            rows.append([
                words(name_of(run, axes)),
                figure(run.get("mrps"), below=interval_text(run) if run.is_estimate() else ""),
                *(figure(run.get(cost)) for _, cost, _ in COSTS),
                *(figure(ratio(run.get("mrps"), run.get(cost))) for _, cost, _ in COSTS),
                Cell(on, on)
            ])
    columns = [("run", "t"), ("MRPS", "n"), ("mm²", "n"), ("W", "n"), ("GB/s", "n"), ("MRPS/mm²", "n"),
               ("MRPS/W", "n"), ("rays/kB", "n"), ("on the front of", "t")]
    return Table(
        "fronts", "Rays for area, power and bandwidth", columns, rows,
        "On the front: no other run of the same scene and rays has more rays for less. GB/s: the bandwidth in use.")


# --- the page ---


def cut(text, most):
    return text if len(text) <= most else text[:most - 1] + "…"


def in_all(some):
    return set(some[0]).intersection(*some[1:]) if len(some) > 1 else set()


def short(names):
    """Returns the part of each name that tells it from the others and fits beside a bar: keys without section or
    program, and without those that every run of a variant has."""
    found = []
    parts = [re.sub(r"[\w.]+\.(\w+=)|[\w-]+ --([\w-]+=)", r"\1\2", name).split(", ") for name in names]
    plain = [[part for part in some if "=" not in part] for some in parts]
    for name, some, own_words in zip(names, parts, plain):
        same = in_all([other for other, others_words in zip(parts, plain) if others_words == own_words])
        keys = ", ".join(part for part in some if "=" in part and part not in same)
        first = ", ".join(part for part in own_words if part not in in_all(plain))
        room = MOST_LETTERS - len(keys) - 2 if keys else MOST_LETTERS
        if len(first) > room:
            first = cut(first, max(room, LEAST_LETTERS))
        text = ", ".join(part for part in (first, keys) if part) or name
        # A key may lose its beginning, which bars have in common, but not its value.
        begin = len(first) + 2 if first and keys else 0
        found.append(text if len(text) <= MOST_LETTERS else
                     f"{text[:begin]}…{text[begin + 1 - MOST_LETTERS:]}" if keys else cut(text, MOST_LETTERS))
    return found


def time_figures(own, results):
    for place, sweep in enumerate(own):
        runs = best_known([run for run in results.of_sweep(sweep["name"]) if run.done])
        axes = varying(runs)
        shown = [(name_of(run, axes), parts) for run in runs[:MOST_BARS] if (parts := shares(run))]
        bars = list(zip(short([name for name, _ in shown]), (parts for _, parts in shown))) if shown else []
        if bars:
            yield Bars(f"time-{place}", f"Where thread-cycles went: {title_of(sweep)}", "share of all thread-cycles",
                       bars, [(style, text) for style, text, _ in CAUSES])


def failures(results):
    failed = [run for run in results.runs if run.status == "failed"]
    axes = varying(results.runs)
    return el("ul", *(el("li", el("b", name_of(run, axes)), ": ", run.error or "no reason is known")
                      for run in failed), class_="failures") if failed else None


def summary(results):
    done = [run for run in results.runs if run.done]
    failed = sum(run.status == "failed" for run in results.runs)
    text = f"{len(done)} of {len(results.runs)} runs {'is' if len(done) == 1 else 'are'} there"
    text += f", {failed} failed." if failed else "."
    titles = {name: results.title("programs", name) for name in results.programs()}
    named = [el("b", f"{name}: {title}") for name, title in titles.items() if title != name]
    return join([el("p", text), el("p", join(named, ", ")) if named else None])


def sections(own, page):
    """Yields (identity, title, content) of each section that has data."""
    results, paper = page.results, page.paper
    first = [summary(results), failures(results)]
    for place, sweep in enumerate(own):
        name = f"sweep-{results.sweeps.index(sweep)}"
        made = [one for one in tables.of_sweep(results, paper, sweep) if one.rows]
        yield f"own-{place}", title_of(sweep), [
            el("p", str(sweep["claim"])) if sweep.get("claim") else None, *first, page.drawn.get(name),
            *(table(one, f"{name}-") for one in made)
        ]
        first = []
    done = [run for run in results.runs if run.done]
    shown = [draw(one) for one in front_figures(done)]
    if shown:
        yield "fronts", "Rays for area, power and bandwidth", [
            el("div", *shown, class_="figures"), table(front_table(done))
        ]
    shown = [draw(one) for one in time_figures(own, results)]
    if shown:
        yield "time", "Where the time goes", [
            el("p", "Every thread is charged every cycle to one cause (docs/timing.md)."),
            el("div", *shown, class_="figures")
        ]
