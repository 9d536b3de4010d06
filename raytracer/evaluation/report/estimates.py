"""Compares quick runs with the exact runs of the same jobs."""

import functools
import itertools

from .results import deviation, mean, ratio
from .table import Cell, Table, between, duration, figure, percent, words


class Estimate:
    """A sampled or quick run, its interval, and the exact run of the same job, where there is one."""
    def __init__(self, run, exact):
        self.run, self.exact, self.interval = run, exact, run.interval()
        self.value = exact.get("mrps") if exact else None
        self.holds = None
        if self.value is not None and self.interval is not None:
            self.holds = self.interval[0] <= self.value <= self.interval[1]
        self.error = deviation(run.get("mrps"), self.value)


def _job(run):
    """The key that an estimate and the exact run of the same job share."""
    settings = tuple(sorted(str(item) for item in run.set.items() if not item[0].startswith("trax-render --sample-")))
    return run.program, run.scene, run.view, run.workload, run.variant, run.config, run.size, settings


def _names(runs):
    """The columns that tell jobs apart, workloads and variants only where there are any."""
    return ["program", "scene", *(name for name in ("workload", "variant") if any(getattr(run, name) for run in runs))]


def estimates(runs):
    exact = {_job(run): run for run in runs if run.done and run.mode == "exact"}
    return [Estimate(run, exact.get(_job(run))) for run in runs if run.done and run.mode != "exact"]


def every(results):
    """A row for each."""
    rows, found = [], estimates(results.runs)
    names = _names([one.run for one in found])
    columns = [("mode", "t"), *((name, "t") for name in names), ("chip", "t"), ("bandwidth (GB/s)", "n"),
               ("estimate (MRPS)", "n"), ("interval", None), ("exact", "n"), ("error", "n"), ("inside", "t"),
               ("host, estimate", "n"), ("host, exact", "n")]
    for one in found:
        run, interval, holds = one.run, one.interval, one.holds
        ends = None if interval is None else " to ".join(between(interval)) if run.is_estimate() else "exact"
        rows.append([
            words(run.mode), *(words(getattr(run, name)) for name in names),
            Cell(run.config, run.get("threads")),
            figure(run.setting("memory.bandwidth_gbps")),
            figure(run.get("mrps")),
            Cell(ends),
            figure(one.value),
            Cell(percent(one.error, signed=True, digits=1), one.error),
            Cell(None if holds is None else "yes" if holds else "no", None if holds is None else str(holds)),
            duration(run.host_seconds),
            duration(one.exact.host_seconds if one.exact else None)
        ])
    known = [one.holds for one in found if one.holds is not None]
    note = (f"The interval held the exact figure in {sum(known)} of {len(known)} cases where it is known."
            if known else "No exact run of these jobs is there to compare with.")
    return Table("sampled", "Estimates and their intervals", columns, rows, note) if rows else None


def _summary(name, results, runs):
    """A row for each program and scene, and for each workload where there are any."""
    found = [one for one in estimates(runs) if one.error is not None]
    names = [name for name in _names([one.run for one in found]) if name != "variant"]
    order = {"program": results.programs(), "scene": results.scenes(), "workload": ["", *results.named("workloads")]}
    groups = {place: [] for place in itertools.product(*(order[name] for name in names))}
    for one in found:
        groups[tuple(getattr(one.run, name) for name in names)].append(one)
    columns = [
        *((name, "t") for name in names), ("estimates", "n"), ("intervals that hold the exact figure", "n"),
        ("mean error", "n"), ("greatest error", "n"), ("mean half of the interval", "n"), ("processor, estimates", "n"),
        ("processor, exact", "n"), ("exact / estimates", "n")
    ]
    rows = []
    for place, found in groups.items():
        if not found:
            continue
        errors = [abs(one.error) for one in found]
        half = mean(
            ratio(one.interval[1] - one.interval[0], 2 * one.run.get("mrps")) if one.interval else None
            for one in found)
        ours, exact = (None if None in times else sum(times)
                       for times in ([one.run.processor_seconds()
                                      for one in found], [one.exact.processor_seconds() for one in found]))
        rows.append([
            *map(words, place),
            figure(len(found)),
            figure(sum(bool(one.holds) for one in found)),
            Cell(percent(mean(errors), digits=1), mean(errors)),
            Cell(percent(max(errors), digits=1), max(errors)),
            Cell(percent(half, digits=1), half),
            duration(ours),
            duration(exact),
            figure(ratio(exact, ours), 2)
        ])
    return Table(f"estimates-{name}", f"Estimates beside exact runs: {name}", columns, rows)


def of_sweep(results, sweep):
    """Returns a function that makes the summary of a sweep's estimates, or None."""
    runs = [run for run in results.runs if sweep.get("name") in run.experiments]
    if all(run.mode == "exact" for run in runs):
        return None
    return functools.partial(_summary, sweep["name"], results, runs)
