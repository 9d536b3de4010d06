"""The tables of any sweep: as its file's member `table` says, or else a row for everything in which its runs differ
(../README.md, "Tables")."""

import copy
import functools
import itertools
import math

from trax_eval.table_spec import AS, descriptions

from .results import deviation, mean, number, ratio, shown
from .table import Cell, Table, between, duration, figure, percent, share


def geometric_mean(values):
    return math.exp(math.fsum(map(math.log, values)) / len(values)) if min(values) > 0 else None


SUMMARIES = {"geometric mean": geometric_mean, "least": min, "greatest": max}
NAMED = ("program", "workload", "kind", "variant", "chip", "size", "mode", "scene")
# Titles of figures; those that are shares are shown in per cent.
TITLES = {
    "mrps": "MRPS", "cycles": "cycles", "rays": "rays", "memory.bandwidth_gbps": "GB/s",
    "values.bytes_per_ray": "bytes/ray", "values.flops_per_ray": "FLOPs/ray", "gflops": "GFLOPS", "kind.count": "rays",
    "kind.mrps": "MRPS", "kind.bytes_per_ray": "bytes/ray", "kind.energy_per_ray": "nJ/ray"
}
SHARES = {
    "memory.utilisation": "bandwidth in use", "issue.utilisation": "issued", "kind.utilisation": "issued",
    "kind.fetch": "fetch", "kind.memory": "memory", "kind.dcache": "data cache", "kind.units": "units",
    "kind.rest": "other"
}
OF_KINDS = [
    "kind.count", "kind.mrps", "kind.bytes_per_ray", "kind.energy_per_ray", "kind.utilisation", "kind.fetch",
    "kind.memory", "kind.dcache", "kind.units", "kind.rest"
]


class Value:
    """A figure of a run in a table: a statistic, or an object with its `name` and its divisor (`per`), `title`,
    `digits`, `percent`, how it is compared (`as`), and with `paper` also the rate in the paper's Table 2."""
    def __init__(self, given, compared=AS[0]):
        given = {"name": given} if isinstance(given, str) else given
        self.name, self.per = given["name"], given.get("per")
        plain = self.name.removeprefix("values.").removeprefix("kind.")
        known = TITLES.get(self.name) or SHARES.get(self.name) or plain
        self.title = given.get("title") or known + (f" / {self.per.removeprefix('values.')}" if self.per else "")
        self.percent = given.get("percent", self.name in SHARES)
        self.digits, self.paper = given.get("digits", 3), given.get("paper", False)
        self.compared = given.get("as", compared)

    def of(self, run):
        def one(name):
            return run.get(f"values.rays.{run.kind}.{name[len('kind.'):]}" if name.startswith("kind.") else name)

        return ratio(one(self.name), one(self.per)) if self.per else one(self.name)

    def half(self, run):
        """Half the width of the figure's interval, if the run is an estimate; else None."""
        if self.name.startswith("kind.") and not self.per:
            return run.get(f"values.rays.{run.kind}.{self.name[len('kind.'):]}_half")
        interval = run.interval() if self.name == "mrps" and not self.per else None
        return (interval[1] - interval[0]) / 2 if interval and interval[0] != interval[1] else None

    @property
    def is_relative(self):
        return self.compared in ("times", "percent")

    def cell(self, value, digits=None, **more):
        if self.percent:
            return share(value, 1 if value and abs(value) < 0.01 else 0, **more)
        return figure(value, digits or self.digits, **more)


def interval_text(run, per=None):
    """The interval of a run's rate as text, divided by `per` as the rate is."""
    interval = run.interval()
    if interval and per:
        interval = tuple(ratio(end, run.get(per)) for end in interval)
    if not interval or None in interval:
        return ""
    return "[{}, {}]".format(*between(interval)) if run.is_estimate() else "exact"


def by_kind(runs):
    """Yields each run once for each kind of its rays. An unfinished run has the kinds of the other runs of its
    workload, so that a mean with it is missing."""
    kinds = {}
    for run in runs:
        kinds.setdefault((run.program, run.workload), {}).update(dict.fromkeys(run.kinds()))
    for run in runs:
        for kind in run.kinds() if run.done else kinds[run.program, run.workload]:
            named = copy.copy(run)
            named.kind = kind
            yield named


class Axes:
    """The axes in which the runs of a table differ, and the order of each axis's values."""
    def __init__(self, results, paper, runs, sweep):
        self.runs, self.order = runs, {}
        keys = dict.fromkeys([
            *NAMED, *([sweep["x"]] if sweep.get("x") and sweep["x"] != "threads" else []),
            *(key for run in runs for key in run.set)
        ])
        known = {
            "program": results.programs(), "scene": results.scenes(), "chip": paper.chips,
            "workload": list(results.named("workloads")), "variant": sweep.get("variants") or []
        }
        for key in keys:
            values = list(dict.fromkeys(self.value(run, key) for run in runs))
            if all(number(value) is not None for value in values):
                values.sort()
            elif key == "size":
                values.sort(key=lambda value: [int(side) for side in value.split("x")] if value else [])
            elif key in known:
                values.sort(key=lambda value: known[key].index(value) if value in known[key] else len(known[key]))
            self.order[key] = values
        self.varying = [key for key, values in self.order.items() if len(values) > 1]
        if "variant" in self.varying:  # it says what else is different, if that depends on it alone
            pairs = {key: len({self.place(run, ("variant", key)) for run in runs}) for key in self.varying}
            self.varying = [
                key for key in self.varying
                if key in ("variant", "scene", "workload", "kind") or pairs[key] > len(self.order["variant"])
            ]

    @staticmethod
    def value(run, key):
        value = getattr(run, "kind", "") if key == "kind" else run.axis(key)
        if isinstance(value, bool):
            return shown(value)
        if isinstance(value, float) and value.is_integer():
            return int(value)  # as a sweep has it
        return value if isinstance(value, (str, int, float)) else ""

    def place(self, run, keys):
        return tuple(self.value(run, key) for key in keys)

    def sorted(self, places, keys):
        order = {
            key: self.order.get(key) or list(dict.fromkeys(self.value(run, key) for run in self.runs)) for key in keys
        }
        return sorted(places, key=lambda place: [order[key].index(value) for key, value in zip(keys, place)])


def plus_minus(half, cell):
    """Half the width of an interval as text, in the unit of the cell, which `cell` makes of a value."""
    return "" if half is None else f"± {cell(half).shown}"


def relation(value, times, half=None):
    """A cell with the ratio of a figure to another, instead of both."""
    if value.compared == "times":
        return figure(times, value.digits, below=plus_minus(half, lambda part: figure(part, 2)))
    change = None if times is None else times - 1
    return Cell(percent(change, signed=True, digits=1), change)


def _is_one(value, wanted):
    return str(value).lower() in [str(one).lower() for one in (wanted if isinstance(wanted, list) else [wanted])]


class SweepTable:
    """One table of a sweep, of the runs that it is about."""
    def __init__(self, results, paper, sweep, spec, runs):
        self.results, self.paper, self.spec, self.runs = results, paper, spec, runs
        self.axes, self.reference = Axes(results, paper, runs, sweep), spec.get("relative")
        self.mean, self.each = spec.get("mean", []), spec.get("each", [])
        self.rows, self.columns = self.sides()
        compared = spec.get("as", AS[0]) if self.reference else "figure"
        self.values = [Value(given, compared) for given in spec["values"]]
        for value in self.values:
            if value.name == "values.picture.pixels_that_differ" and sweep.get("reference"):
                value.title = f'pixels that differ from "{sweep["reference"]}"'
        self.groups = {}
        for run in runs:
            place = self.axes.place(run, self.rows), self.axes.place(run, self.columns)
            self.groups.setdefault(place, []).append(run)
        self.row_places, self.column_places = self.places(0, self.rows), self.places(1, self.columns)

    def sides(self):
        """The axes of rows and of columns. An axis in which runs differ and that is not named has rows."""
        rows, varying = self.spec.get("rows", []), self.axes.varying
        default = ["scene"] if "scene" in varying and "scene" not in (*self.mean, *rows) else []
        columns = self.spec.get("columns", default)
        rows = [key for key in rows if key not in columns]
        rows += [key for key in varying if key not in (*rows, *columns, *self.mean, *self.each)]
        return (rows, columns) if rows else (["scene"], [key for key in columns if key != "scene"])

    def places(self, side, keys):
        """The values of the axes of one side, those that `only` names."""
        only = self.spec.get("only", {})

        def shown(place):
            return all(_is_one(part, only[key]) for key, part in zip(keys, place) if key in only)

        return self.axes.sorted({place[side] for place in self.groups if shown(place[side])}, keys)

    def of(self, row, column):
        return self.groups.get((row, column), [])

    def found(self, row, column, value):
        return mean(value.of(run) for run in self.of(row, column))

    def half(self, row, column, value):
        """Half the width of the interval of a figure, or of the mean of several, whose errors are independent."""
        halves = [value.half(run) for run in self.of(row, column)]
        known = [half for half in halves if half is not None]
        return math.sqrt(math.fsum(half**2 for half in known)) / len(halves) if known else None

    def half_of_times(self, row, column, value):
        """Returns the half width of `times`: relative errors add up as squares."""
        sides = [(row, column), self.base(row, column)]
        parts = [ratio(self.half(*side, value), self.found(*side, value)) for side in sides]
        known = [part for part in parts if part is not None]
        times = self.times(row, column, value)
        if not known or times is None or sides[0] == sides[1]:
            return None
        return times * math.sqrt(math.fsum(part**2 for part in known))

    def base(self, row, column):
        """The place of the runs that have the values of `relative` and are otherwise the same."""
        def at(place, keys):
            return tuple(self.reference.get(key, one) for key, one in zip(keys, place))

        return at(row, self.rows), at(column, self.columns)

    def times(self, row, column, value):
        """The figure by that of the runs at its base."""
        if not self.reference:
            return None
        return ratio(self.found(row, column, value), self.found(*self.base(row, column), value))

    def cell(self, row, column, value):
        some = self.of(row, column)
        if value.is_relative:
            half = self.half_of_times(row, column, value)
            return relation(value, self.times(row, column, value), half)
        quotient = self.times(row, column, value) if value.compared == "change" else None
        below = interval_text(some[0], value.per) if value.name == "mrps" and len(some) == 1 else ""
        if not below:
            below = plus_minus(self.half(row, column, value), lambda part: value.cell(part, digits=2))
        below = below if quotient is None else percent(quotient - 1, signed=True, digits=1)
        link = f"#run-{some[0].index}" if len(some) == 1 else ""
        return value.cell(self.found(row, column, value), below=below, link=link)

    def beside_paper(self, row, column, value):
        """The rate of the paper's Table 2, and the deviation from it."""
        scene, config = next(((run.scene, run.config) for run in self.of(row, column)), ("", ""))
        wanted = self.results.published(self.paper, scene, config)
        off = deviation(self.found(row, column, value), wanted)
        return [figure(wanted, style="paper"), Cell(percent(off, signed=True, digits=1), off)]

    def summary(self, row, value, name):
        """A summary of the row's cells; missing if one of them is."""
        parts = [(self.times if value.is_relative else self.found)(row, column, value) for column in self.column_places]
        whole = None if not parts or None in parts else SUMMARIES[name](parts)
        return relation(value, whole) if value.is_relative else value.cell(whole)

    def head(self):
        several = len(self.values) > 1
        for index, key in enumerate(self.rows):
            yield key, "n" if all(number(place[index]) is not None for place in self.row_places) else "t"
        for column, value in itertools.product(self.column_places, self.values):
            parts = (str(part) if key in NAMED else f"{key} {part}" for key, part in zip(self.columns, column))
            name = ", ".join(parts)
            yield f"{name}: {value.title}" if name and several else name or value.title, "n"
            if value.paper:
                yield from (("paper", "n"), ("deviation", "n"))
        for name, value in itertools.product(self.spec.get("summary", []), self.values):
            yield f"{name}: {value.title}" if several else name, "n"
        yield "host", "n"

    def body(self, row):
        for part in row:
            yield figure(part, 6) if number(part) is not None else Cell(str(part) or "-", str(part))
        for column, value in itertools.product(self.column_places, self.values):
            yield self.cell(row, column, value)
            if value.paper:
                yield from self.beside_paper(row, column, value)
        for name, value in itertools.product(self.spec.get("summary", []), self.values):
            yield self.summary(row, value, name)
        hosts = {run.index: run.host_seconds or 0 for column in self.column_places for run in self.of(row, column)}
        yield duration(sum(hosts.values()) or None)

    def fixed(self):
        """The values that all runs have in common, for the title."""
        shown = (*self.rows, *self.columns, *self.mean, *self.each)
        first = [self.axes.order[key][0] for key in NAMED if key not in shown and len(self.axes.order[key]) == 1]
        return ", ".join(str(value) for value in first if value)

    def made(self, identity, title):
        title += f": {self.values[0].title}" if self.columns and len(self.values) == 1 else ""
        title += f" ({fixed})" if (fixed := self.fixed()) else ""
        notes = [f"Means over {' and '.join(self.mean)}."] if self.mean else []
        if self.reference:
            notes.append(f"Relative to {', '.join(f'{key} {value}' for key, value in self.reference.items())}.")
        rows = [list(self.body(row)) for row in self.row_places]
        return Table(identity, title, list(self.head()), rows, " ".join(notes))


def _build(results, paper, sweep, spec, runs, identity, title):
    return SweepTable(results, paper, sweep, spec, runs).made(identity, title)


def default_table(sweep, runs):
    """The table of a sweep that describes none: by kind of ray where runs have kinds."""
    if any(run.kinds() for run in runs):
        return {"mean": ["scene"], "values": OF_KINDS}
    for axis in ("variant", "program"):
        if sweep.get("reference") in {run.axis(axis) for run in runs} - {""}:
            return {"relative": {axis: sweep["reference"]}}
    return {}


def is_of_kinds(value):
    return str(value if isinstance(value, str) else value["name"]).startswith("kind.")


def makers(results, paper, sweep):
    """A function for each table of the sweep, which makes it."""
    name = str(sweep.get("name") or "sweep")
    variants = ["", *(sweep.get("variants") or [])]
    runs = results.of_sweep(sweep.get("name"))
    if len(variants) > 1:  # without those that the sweep no longer has
        runs = [run for run in runs if run.variant in variants]
    y = {"name": sweep.get("y") or "mrps", "per": sweep.get("y_per")}
    made = []
    for place, spec in enumerate(descriptions(sweep) or [default_table(sweep, runs)]):
        spec = {"values": [y], **spec}
        chosen = list(by_kind(runs)) if any(map(is_of_kinds, spec["values"])) else runs
        axes = Axes(results, paper, chosen, sweep)
        for key, wanted in spec.get("where", {}).items():
            chosen = [run for run in chosen if _is_one(axes.value(run, key), wanted)]
        each = spec.get("each", [])
        for part in axes.sorted({axes.place(run, each) for run in chosen}, each):
            some = [run for run in chosen if axes.place(run, each) == part]
            identity = "-".join([spec.get("id") or (name if place == 0 else f"{name}-{place + 1}"), *map(str, part)])
            title = ", ".join([spec.get("title") or str(sweep.get("title") or name), *map(str, part)])
            made.append(functools.partial(_build, results, paper, sweep, spec, some, identity, title))
    return made
