"""The file of results beside pages of docs: what their blocks need and nothing else, a run in a line. Sweeps that come
with trax stand in it by their names alone; their files say how they are shown."""

import json
import pathlib

from trax_eval.util import Problem, read_json

from .results import HERE, Results

SWEEPS = HERE.parent / "sweeps"
DIGITS = 6  # of what is no whole number
DESCRIBED = ("title", "claim", "x", "y", "y_per", "reference", "table")


def _rounded(value):
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def _kept(run, names, source):
    """Returns the part of a run's record that identifies the run, and the figures of these names, flat: stats.mrps,
    values.area_units."""
    record = run.record
    kept = {
        name: record[name]
        for name in ("program", "scene", "workload", "variant", "config", "set", "size", "mode", "status")
        if record.get(name)
    }
    if any((point["config"], point["set"], point.get("variant", run.variant)) != (run.config, run.set, run.variant)
           for point in run.points):
        kept["points"] = [{name: point.get(name, "") for name in ("experiment", "variant", "config", "set")}
                          for point in run.points]
    for name in sorted(names):
        first, _, rest = name.partition(".")
        part, path = (first, [rest]) if first in ("values", "host") else ("stats", name.split("."))
        value = record.get(part)
        for key in path:
            value = value.get(key) if isinstance(value, dict) else None
        if value is not None and not isinstance(value, dict) and (value or not name.endswith(".count")):
            kept[f"{part}.{'.'.join(path)}"] = _rounded(value)
    return {**kept, "source": source}


def check_sources(document, runs):
    for kind in ("sources", "sweeps"):
        if not all(isinstance(entry, dict) for entry in document.get(kind) or []):
            raise ValueError(f'"{kind}" is no list of objects')
    count = max(1, len(document.get("sources") or []))
    if not all(type(number) is int and 0 <= number < count for number in (run.get("source", 0) for run in runs)):
        raise ValueError('a run has no "source" of the list')


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
        check_sources(document, runs)
        return {**{name: value for name, value in document.items() if name != "tables"}, "runs": runs}
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise Problem(f"{path}: is no file that trax-eval docs wrote: {error!r}") from None


def without(document, is_dropped):
    """A document without the runs of some sweeps: is_dropped(name of the sweep, run)."""
    runs = []
    for run in document.get("runs", []):
        left = [name for name in run["experiments"] if not is_dropped(name, run)]
        if left:
            points = [point for point in run.get("points", []) if point["experiment"] in left]
            runs.append({**run, "experiments": left, **({"points": points} if points else {})})
    return {**document, "runs": runs}


def own(sweep):
    """A sweep that comes with trax: the file that it was read from stands in an installation's folder of sweeps."""
    path = pathlib.Path(str(sweep.get("file") or ""))
    return path.parts[-3:] == ("evaluation", "sweeps", f"{sweep.get('name')}.json") and (SWEEPS / path.name).exists()


def described(sweep):
    """An entry of the file's sweeps; of one that stands there by its name alone, what its own file says of tables and
    plots."""
    if set(sweep) != {"name"}:
        return sweep
    value = read_json(SWEEPS / f"{pathlib.Path(str(sweep['name'])).name}.json")
    groups = value.get("set")
    variants = [group["name"] for group in groups if "name" in group] if isinstance(groups, list) else []
    return {
        "name": sweep["name"], "title": sweep["name"], "x": "threads", "y": "mrps", "variants": variants,
        **{key: value[key] for key in DESCRIBED if key in value}
    }


def results_of(document):
    return Results({**document, "sweeps": [described(sweep) for sweep in document.get("sweeps") or []]})


def merged(old, new):
    """One document with the sweeps of both. The new one's runs take the place of those of the same sweep, program,
    workload, size and mode."""
    def place(name, run):
        return name, run.get("program"), run.get("workload") or "", str(run.get("size")), run.get("mode")

    taken = {place(name, run) for run in new.get("runs") or [] for name in run.get("experiments") or []}
    old = without(old, lambda name, run: place(name, run) in taken)
    sources, runs = [*old.get("sources", [])], old["runs"]
    shift = len(sources)
    sources += new.get("sources") or [new]
    new = {**new, "sweeps": [{"name": sweep["name"]} if own(sweep) else sweep for sweep in new.get("sweeps") or []]}
    runs = runs + [{**run, "source": run.get("source", 0) + shift} for run in new.get("runs") or []]
    both = {}
    for kind in ("programs", "scenes", "workloads", "sweeps"):
        entries = {entry.get("name"): entry for document in (old, new) for entry in document.get(kind) or []}
        both[kind] = list(entries.values())
    return {"format": "trax-eval-results", "version": 2, "sources": sources, **both, "runs": runs}


def compact(document, results, needed, sweeps):
    """The file's text. needed: by the place of a run the names of the figures that are shown of it; sweeps: names of
    those that are shown."""
    runs, measured = [], {(run.program, run.workload, run.experiments[0]) for run in results.runs
                          if run.index in needed and run.experiments}
    for run in results.runs:
        if sweeps & set(run.experiments) and (run.index in needed or not run.done and
                                              (run.program, run.workload, run.experiments[0]) in measured):
            kept = _kept(run, needed.get(run.index, set()), run.record.get("source", 0))
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
    lists = {
        "sources": sources, **{
            kind: [entry for entry in document.get(kind) or [] if entry.get("name") in names[kind]] for kind in names
        }, "sweeps": [{key: value for key, value in sweep.items() if key != "file" and value not in (None, "", [])}
                      for sweep in document["sweeps"] if sweep["name"] in sweeps]
    }

    def text(value):
        return json.dumps(value, ensure_ascii=False, separators=(",", ":"))

    def listed(entries):
        return "[\n" + ",\n".join(entries) + "\n]"

    parts = [f'"{key}": {listed(map(text, entries))}' for key, entries in lists.items()]
    groups = []
    for experiments, rows in grouped.items():
        columns = list(dict.fromkeys(name for kept in rows for name in kept))
        listed_rows = listed(text([kept.get(name) for name in columns]) for kept in rows)
        groups.append(f'{{"experiments":{text(experiments)},\n"names":{text(columns)},\n"runs":{listed_rows}}}')
    parts.append(f'"tables": {listed(groups)}')
    return '{"format": "trax-eval-results", "version": 2,\n' + ",\n".join(parts) + "}\n"
