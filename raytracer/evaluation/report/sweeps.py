"""The tables of any sweep: as its file's member `table` says, or else a row for everything in which its runs differ (../README.md, "Tables")."""

import copy
import functools
import itertools
import math

from .results import ResultsError, deviation, mean, number, ratio
from .table import Cell, Table, between, duration, figure, percent, share

KEYS = ("id", "title", "each", "rows", "columns", "values", "mean", "where", "only", "relative", "as", "summary")
AS = ("change", "times", "percent", "figure")
SUMMARIES = {"geometric mean": lambda values: math.prod(values) ** (1 / len(values)) if min(values) > 0 else None, "least": min, "greatest": max}
NAMED = ("program", "workload", "kind", "variant", "chip", "size", "mode", "scene")
# Titles of figures; those that are shares are shown in per cent.
TITLES = {"mrps": "MRPS", "cycles": "cycles", "rays": "rays", "memory.bandwidth_gbps": "GB/s", "values.bytes_per_ray": "bytes/ray", "values.flops_per_ray": "FLOPs/ray", "gflops": "GFLOPS",
          "kind.count": "rays", "kind.mrps": "MRPS", "kind.bytes_per_ray": "bytes/ray", "kind.energy_per_ray": "nJ/ray"}
SHARES = {"memory.utilisation": "bandwidth in use", "issue.utilisation": "issued", "kind.utilisation": "issued", "kind.fetch": "fetch", "kind.memory": "memory", "kind.dcache": "data cache",
          "kind.units": "units", "kind.rest": "other"}
OF_KINDS = ["kind.count", "kind.mrps", "kind.bytes_per_ray", "kind.energy_per_ray", "kind.utilisation", "kind.fetch", "kind.memory", "kind.dcache", "kind.units", "kind.rest"]


class Value:
    """What a table shows of a run: a statistic, or an object with its `name` and what it is divided by (`per`), `title`, `digits`, `percent`, how it is compared (`as`),
    and with `paper` also the rate in the paper's Table 2."""

    def __init__(self, given, compared=AS[0]):
        given = {"name": given} if isinstance(given, str) else given
        self.name, self.per = given["name"], given.get("per")
        last = self.name.rsplit(".", 1)[-1]
        lanes = f"{last} lanes" if self.name.startswith(("kind.lanes.", "values.simd_utilisation.")) else f"{last} at most" if self.name.startswith("values.simd_bound.") else None
        known = TITLES.get(self.name) or SHARES.get(self.name) or lanes or self.name.removeprefix("values.").removeprefix("kind.")
        self.title = given.get("title") or known + (f" / {self.per.removeprefix('values.')}" if self.per else "")
        self.percent = given.get("percent", bool(lanes) or self.name in SHARES)
        self.digits, self.paper, self.compared = given.get("digits", 3), given.get("paper", False), given.get("as", compared)

    def of(self, run):
        def one(name):
            return run.get(f"values.rays.{run.kind}.{name[len('kind.'):]}" if name.startswith("kind.") else name)

        return ratio(one(self.name), one(self.per)) if self.per else one(self.name)

    def cell(self, value, **more):
        return share(value, 1 if value and abs(value) < 0.01 else 0, **more) if self.percent else figure(value, self.digits, **more)


def interval_text(run, per=None):
    """Of a run's rate, divided by `per` as the rate is."""
    interval = run.interval()
    if interval and per:
        interval = tuple(ratio(end, run.get(per)) for end in interval)
    if not interval or None in interval:
        return ""
    return "[{}, {}]".format(*between(interval)) if run.is_estimate() else "exact"


def checked(given, where):
    """A description of a table, with lists where a single word stands; what is wrong with it is an error."""
    for key in given:
        if key not in KEYS:
            raise ResultsError(f"{where}: unknown key \"{key}\"; allowed are {', '.join(KEYS)}")
    spec = dict(given)
    for key in ("each", "rows", "columns", "mean", "values", "summary"):
        if key in spec:
            spec[key] = spec[key] if isinstance(spec[key], list) else [spec[key]]
            if not all(isinstance(entry, str) or key == "values" and isinstance(entry, dict) and isinstance(entry.get("name"), str) for entry in spec[key]):
                raise ResultsError(f"{where}.{key}: expected names")
    for key in ("where", "only", "relative"):
        if not isinstance(spec.get(key, {}), dict):
            raise ResultsError(f"{where}.{key}: expected an object of axes and values")
    for compared in [spec.get("as", AS[0]), *(value.get("as", AS[0]) for value in spec.get("values", []) if isinstance(value, dict))]:
        if compared not in AS:
            raise ResultsError(f"{where}.as: allowed are {', '.join(AS)}")
    if [name for name in spec.get("summary", []) if name not in SUMMARIES]:
        raise ResultsError(f"{where}.summary: allowed are {', '.join(SUMMARIES)}")
    if not all(isinstance(spec.get(key, ""), str) for key in ("id", "title")):
        raise ResultsError(f"{where}: id and title are texts")
    return spec


def descriptions(sweep):
    """What a sweep says of its tables: a list, empty if it says nothing."""
    given = sweep.get("table")
    given = given if isinstance(given, list) else [] if given is None else [given]
    where = f"sweep \"{sweep.get('name')}\": table"
    if not all(isinstance(spec, dict) for spec in given):
        raise ResultsError(f"{where}: expected an object or a list of objects")
    specs = [checked(spec, f"{where}[{place}]") for place, spec in enumerate(given)]
    identities = [spec.get("id") for spec in specs if spec.get("id")]
    if len(set(identities)) < len(identities):
        raise ResultsError(f"{where}: two have the same id")
    return specs


def by_kind(runs):
    """Each run by each kind of its rays; one that is not done by those that others of its workload have, so that a mean with it is missing."""
    kinds = {}
    for run in runs:
        kinds.setdefault((run.program, run.workload), {}).update(dict.fromkeys(run.kinds()))
    for run in runs:
        for kind in run.kinds() if run.done else kinds[run.program, run.workload]:
            named = copy.copy(run)
            named.kind = kind
            yield named


class Axes:
    """In what the runs of a table differ, and the order of each axis's values."""

    def __init__(self, results, paper, runs, sweep):
        self.runs, self.order = runs, {}
        keys = dict.fromkeys([*NAMED, *([sweep["x"]] if sweep.get("x") and sweep["x"] != "threads" else []), *(key for run in runs for key in run.set)])
        known = {"program": results.programs(), "scene": results.scenes(), "chip": paper.chips, "workload": list(results.named("workloads")), "variant": sweep.get("variants") or []}
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
            self.varying = [key for key in self.varying if key in ("variant", "scene", "workload", "kind") or pairs[key] > len(self.order["variant"])]

    @staticmethod
    def value(run, key):
        value = getattr(run, "kind", "") if key == "kind" else run.axis(key)
        return str(value).lower() if isinstance(value, bool) else value if isinstance(value, (str, int, float)) else ""

    def place(self, run, keys):
        return tuple(self.value(run, key) for key in keys)

    def sorted(self, places, keys):
        order = {key: self.order.get(key) or list(dict.fromkeys(self.value(run, key) for run in self.runs)) for key in keys}
        return sorted(places, key=lambda place: [order[key].index(value) for key, value in zip(keys, place)])


def relation(value, times):
    """How many times another figure one is, instead of both."""
    if value.compared == "times":
        return figure(times, value.digits)
    return Cell(None if times is None else percent(times - 1, signed=True, digits=1), None if times is None else times - 1)


def _is_one(value, wanted):
    return str(value).lower() in [str(one).lower() for one in (wanted if isinstance(wanted, list) else [wanted])]


def _build(results, paper, sweep, spec, runs, identity, title):
    axes = Axes(results, paper, runs, sweep)
    mean_over = spec.get("mean", [])
    columns = spec.get("columns", ["scene"] if "scene" not in mean_over and "scene" in axes.varying and "scene" not in spec.get("rows", []) else [])
    rows = [key for key in spec.get("rows", []) if key not in columns]
    rows += [key for key in axes.varying if key not in (*rows, *columns, *mean_over, *spec.get("each", []))]  # whatever differs is told apart
    if not rows:
        rows, columns = ["scene"], [key for key in columns if key != "scene"]
    values = [Value(given, spec.get("as", AS[0]) if spec.get("relative") else "figure") for given in spec["values"]]
    for value in values:
        if value.name == "values.picture.pixels_that_differ" and sweep.get("reference"):
            value.title = f'pixels that differ from "{sweep["reference"]}"'
    fixed = [str(axes.order[key][0]) for key in NAMED if key not in (*rows, *columns, *mean_over, *spec.get("each", [])) and len(axes.order[key]) == 1 and axes.order[key][0]]
    title += (f": {values[0].title}" if columns and len(values) == 1 else "") + (f" ({', '.join(fixed)})" if fixed else "")
    groups, reference = {}, spec.get("relative")
    for run in runs:
        groups.setdefault((axes.place(run, rows), axes.place(run, columns)), []).append(run)

    def found(row, column, value):
        return mean(value.of(run) for run in groups.get((row, column), []))

    def times(row, column, value):
        """Of what the runs have that this cell is relative to: the same but for the axes that `relative` names."""
        def at(place, keys):
            return tuple(reference.get(key, one) for key, one in zip(keys, place))

        return ratio(found(row, column, value), found(at(row, rows), at(column, columns), value)) if reference else None

    def cell(row, column, value):
        some = groups.get((row, column), [])
        if value.compared in ("times", "percent"):
            return relation(value, times(row, column, value))
        quotient = times(row, column, value) if value.compared == "change" else None
        below = interval_text(some[0], value.per) if value.name == "mrps" and len(some) == 1 else ""
        below = below if quotient is None else percent(quotient - 1, signed=True, digits=1)
        return value.cell(found(row, column, value), below=below, link=f"#run-{some[0].index}" if len(some) == 1 else "")

    def summary(row, value, name):
        """Of the row's cells; missing if one of them is."""
        is_relative = value.compared in ("times", "percent")
        parts = [(times if is_relative else found)(row, column, value) for column in column_places]
        whole = None if not parts or None in parts else SUMMARIES[name](parts)
        return relation(value, whole) if is_relative else value.cell(whole)

    def shown(place, keys):
        return all(_is_one(part, spec["only"][key]) for key, part in zip(keys, place) if key in spec.get("only", {}))

    row_places, column_places = (axes.sorted({place[index] for place in groups if shown(place[index], keys)}, keys) for index, keys in ((0, rows), (1, columns)))
    head = [(key, "n" if all(number(place[index]) is not None for place in row_places) else "t") for index, key in enumerate(rows)]
    for column, value in itertools.product(column_places, values):
        name = ", ".join(str(part) if key in NAMED else f"{key} {part}" for key, part in zip(columns, column))
        head += [(f"{name}: {value.title}" if name and len(values) > 1 else name or value.title, "n"), *([("paper", "n"), ("deviation", "n")] if value.paper else [])]
    summaries = list(itertools.product(spec.get("summary", []), values))
    head += [(f"{name}: {value.title}" if len(values) > 1 else name, "n") for name, value in summaries]
    body = []
    for row in row_places:
        cells = [figure(part, 6) if number(part) is not None else Cell(str(part) or "-", str(part)) for part in row]
        for column, value in itertools.product(column_places, values):
            cells.append(cell(row, column, value))
            if value.paper:
                wanted = results.published(paper, *next(((run.scene, run.config) for run in groups.get((row, column), [])), ("", "")))
                off = deviation(found(row, column, value), wanted)
                cells += [figure(wanted, style="paper"), Cell(percent(off, signed=True, digits=1), off)]
        cells += [summary(row, value, name) for name, value in summaries]
        hosts = {run.index: run.host_seconds or 0 for column in column_places for run in groups.get((row, column), [])}
        body.append(cells + [duration(sum(hosts.values()) or None)])
    notes = ([f"Means over {' and '.join(mean_over)}."] if mean_over else []) + ([f"Relative to {', '.join(f'{key} {value}' for key, value in reference.items())}."] if reference else [])
    return Table(identity, title, [*head, ("host", "n")], body, " ".join(notes))


def makers(results, paper, sweep):
    """What makes the sweep's tables, a function each. Without a description: a row for all that differs, a column for each scene; by kind of ray where runs have that."""
    name = str(sweep.get("name") or "sweep")
    variants = ["", *(sweep.get("variants") or [])]
    runs = [run for run in results.of_sweep(sweep.get("name")) if run.variant in variants or len(variants) == 1]  # without those that the sweep no longer has
    kinds = any(run.kinds() for run in runs)
    widths = sorted({int(key.split(".")[1]) for run in runs for key in run.values if key.startswith("simd_utilisation.") and key.split(".")[1].isdecimal()} - {1})
    y = {"name": sweep.get("y") or "mrps", "per": sweep.get("y_per")}
    reference = next((axis for axis in ("variant", "program") if sweep.get("reference") in {run.axis(axis) for run in runs} - {""}), None)
    default = {"values": [y], **({"relative": {reference: sweep["reference"]}} if reference else {})}
    if kinds:
        default = {"mean": ["scene"], "values": OF_KINDS + [f"kind.lanes.{width}" for width in (4, 8, 16, 32) if any(f"rays.{kind}.lanes.{width}" in run.values for run in runs for kind in run.kinds())]}
    elif widths:
        default = {"rows": ["program", "scene"], "values": [f"values.simd_{what}.{width}" for width in widths for what in ("utilisation", "bound")]}
    made = []
    for place, spec in enumerate(descriptions(sweep) or [default]):
        spec = {"values": [y], **spec}
        chosen = list(by_kind(runs)) if any(str(value if isinstance(value, str) else value["name"]).startswith("kind.") for value in spec["values"]) else runs
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
