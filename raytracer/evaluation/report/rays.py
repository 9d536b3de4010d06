"""Rays by kind: what MIMD gains as rays lose coherence. Of runs with the values rays.KIND.*, which sweeps with `ray_kinds` have."""

from .charts import STYLES
from .markup import cell, number_cell, percent, table
from .plots import Lines, Series
from .results import mean

KINDS = ("primary", "shadow", "occlusion", "diffuse", "glossy", "mirror", "glass", "other")
WIDTHS = (4, 8, 16, 32)
SHARES = ("utilisation", "fetch", "memory", "dcache", "units", "rest")


def groups(results):
    """{(workload, kind, chip, settings): runs}: all scenes of a machine; what a mean is made of has every scene that the others have."""
    found = {}
    for run in results.runs:
        for kind in KINDS:
            if run.done and run.get(f"values.rays.{kind}.count"):
                found.setdefault((run.workload, kind, run.config, tuple(sorted(run.set.items())), run.size), []).append(run)
    return found


def of(runs, kind, name):
    return mean(run.get(f"values.rays.{kind}.{name}") for run in runs)


def kinds_table(results):
    """A row for each workload, kind of ray and machine: the mean of the scenes."""
    head = [("workload", "t"), ("kind", "t"), ("chip", "t"), ("scenes", "n"), ("rays", "n"), ("MRPS", "n"), ("bytes/ray", "n"), ("nJ/ray", "n")]
    head += [(name, "n") for name in ("issued", "instruction fetch", "memory", "data cache", "units", "other")] + [(f"{width} lanes", "n") for width in WIDTHS]
    rows = []
    for (workload, kind, chip, settings, _), runs in groups(results).items():
        name = ", ".join([chip, *(f"{key} = {value}" for key, value in settings)])
        row = [cell(workload, workload), cell(kind, kind), cell(name, name), number_cell(len(runs)), number_cell(sum(run.get(f"values.rays.{kind}.count") for run in runs))]
        row += [number_cell(of(runs, kind, figure_name)) for figure_name in ("mrps", "bytes_per_ray", "energy_per_ray")]
        for share in (*SHARES, *(f"lanes.{width}" for width in WIDTHS)):
            value = of(runs, kind, share)
            row.append(number_cell(value, shown=percent(value)))
        rows.append(row)
    note = ("Means of the scenes. MRPS: the kind's rays by its own share of the thread-cycles. Issued to other: shares of these thread-cycles. Lanes: the share of a SIMD machine's lanes "
            "that the same rays use, in full warps of one kind and generation, with memory that takes no time (docs/emulator.md, --lockstep-rays).")
    return table("rays-table", "Rays by kind", head, rows, note=note)


def _variants(results):
    """(workload, kind) in the order of the runs, each with a style of its own."""
    named = list(dict.fromkeys((workload, kind) for workload, kind, *_ in groups(results)))
    return {pair: STYLES[index % len(STYLES)] for index, pair in enumerate(named)}


def _label(workload, kind):
    return f"{kind} ({workload})" if workload else kind


def lanes(results):
    styles, series = _variants(results), []
    for (workload, kind, chip, _, _), runs in groups(results).items():
        points = [(width, of(runs, kind, f"lanes.{width}")) for width in (1, 2, *WIDTHS, 64)]
        points = [(width, None if share is None else 100 * share, f"{_label(workload, kind)}: {100 * share:.0f} % of {width} lanes" if share is not None else "") for width, share in points]
        if any(share is not None for _, share, _ in points):
            style, mark = styles[workload, kind]
            series.append(Series(_label(workload, kind), style, points, mark, dashed=list(styles).index((workload, kind)) >= len(STYLES)))
    return Lines("rays-lanes", "SIMD: lanes in use by kind of ray", "lanes", "lanes in use (%)", series, log_x=True, base=2, x_ticks=[(2 ** power, str(2 ** power)) for power in range(7)])


def against_chips(results, paper, identity, title, unit, name, scale=1):
    """A line for each kind over the threads of the paper's chips."""
    styles, lines = _variants(results), {}
    for (workload, kind, chip, settings, size), runs in groups(results).items():
        if chip in paper.chips and not settings:
            value = of(runs, kind, name)
            if value is not None:
                lines.setdefault((workload, kind, size), []).append((paper.threads(chip), scale * value, f"{_label(workload, kind)}, {chip}: {scale * value:.3g}"))
    series = []
    for (workload, kind, _), points in lines.items():
        style, mark = styles[workload, kind]
        if len(points) > 1:
            series.append(Series(_label(workload, kind), style, sorted(points), mark, line=False))
    return Lines(identity, title, "threads", unit, series, x_ticks=[(threads, str(threads)) for threads in (32, 64, 128, 256, 512)])


def figures(results, paper):
    if not groups(results):
        return []
    return [lanes(results),
            against_chips(results, paper, "rays-issued", "MIMD: thread-cycles that issue, by kind of ray", "issued (%)", "utilisation", 100),
            against_chips(results, paper, "rays-fetch", "Thread-cycles that wait for instructions, by kind of ray", "instruction fetch (%)", "fetch", 100),
            against_chips(results, paper, "rays-mrps", "Rays by kind", "million rays per second", "mrps"),
            against_chips(results, paper, "rays-bytes", "Bytes a ray, by kind", "bytes a ray", "bytes_per_ray"),
            against_chips(results, paper, "rays-energy", "Energy a ray, by kind", "nJ a ray", "energy_per_ray")]

