"""Rays by kind: what they cost on a machine of independent threads. Of runs with the values rays.KIND.*, which sweeps
with `ray_kinds` or `ray_cycles` have."""

from .charts import STYLES
from .machines import SWEEPS
from .plots import Bars, Lines, Series
from .results import mean, shown
from .sweeps import by_kind
from .table import Table, figure, number, percent, share, words

LINES = [*STYLES, (0, "dot")]  # styles of kinds
COMPARED = {*SWEEPS, "simd-programs"}
# The parts of a kind's thread-cycles, with the colours that page.css has for causes.
SHARES = [(10, "issued", "utilisation"), (11, "instruction fetch", "fetch"),
          (12, "data-cache banks and hits", "dcache"), (13, "off-chip memory", "memory"), (14, "shared units", "units"),
          (17, "other waits", "rest")]

EXPLAINED = (
    "Rays that leave a surface in many directions have less and less in common. A machine of independent threads loses "
    "nothing to that by itself, but each thread waits for instructions, memory and shared units.")


class Group:
    """One kind of ray of a workload, on one machine: the runs of all scenes."""
    def __init__(self, workload, kind, chip, settings, size, program):
        self.workload, self.kind, self.chip, self.settings = workload, kind, chip, settings
        self.size, self.program, self.runs = size, program, []
        self.several = False  # programs: then its label has its own

    def of(self, name):
        return mean(run.get(f"values.rays.{self.kind}.{name}") for run in self.runs)

    @property
    def label(self):
        inner = [
            part for part in ("" if self.workload == self.kind else self.workload, self.program if self.several else "")
            if part
        ]
        return f"{self.kind} ({', '.join(inner)})" if inner else self.kind


def groups(results):
    """Returns all kinds on all machines but those of the comparison with SIMD, which has its own tables. A missing
    scene makes the mean of its group missing."""
    found = {}
    for run in by_kind([run for run in results.runs if not COMPARED & set(run.experiments)]):
        place = run.workload, run.kind, run.config, tuple(sorted(run.set.items())), run.size, run.program
        found.setdefault(place, Group(*place)).runs.append(run)
    for group in found.values():
        group.several = len({other.program for other in found.values()}) > 1
    return list(found.values())


def chosen(found):
    """A group for each line of a figure: of a program each kind of the first workload that has it; of a workload
    without a kind of its own, its last."""
    by_workload, seen, lines = {}, set(), []
    for group in found:
        by_workload.setdefault((group.program, group.workload), {})[group.kind] = group.label
    for (program, workload), kinds in by_workload.items():
        new = [kind for kind in kinds if (program, kind) not in seen] or list(kinds)[-1:]
        seen.update((program, kind) for kind in new)
        lines += [(program, workload, kind) for kind in new]
    return lines


def on_one_chip(results, paper):
    """The groups of the lines of figures, on the paper's chip that has the most of them, of several on 4x32."""
    found, by_chip = groups(results), {}
    lines = chosen(found)
    for group in found:
        line = group.program, group.workload, group.kind
        if group.chip in paper.chips and not group.settings and line in lines and group.of("utilisation") is not None:
            best = by_chip.setdefault(group.chip, {}).get(line)
            if best is None or group.size > best.size:
                by_chip[group.chip][line] = group
    most = max(by_chip.items(), key=lambda chip: (len(chip[1]), chip[0] == "4x32"), default=("", {}))
    return list(most[1].values())


def kinds_table(results):
    """A row for each workload, kind of ray and machine: the mean of the scenes."""
    columns = [("workload", "t"), ("kind", "t"), ("program", "t"), ("chip", "t"), ("scenes", "n"), ("rays", "n"),
               ("MRPS", "n"), ("bytes/ray", "n"), ("nJ/ray", "n")]
    columns += [(name, "n") for _, name, _ in SHARES]
    rows = []
    for group in groups(results):
        name = ", ".join([group.chip, *(f"{key} = {shown(value)}" for key, value in group.settings)])
        counts = [run.get(f"values.rays.{group.kind}.count") for run in group.runs]
        rows.append([
            words(group.workload),
            words(group.kind),
            words(group.program),
            words(name),
            figure(len(group.runs)),
            figure(None if None in counts else sum(counts)),
            *(figure(group.of(name)) for name in ("mrps", "bytes_per_ray", "energy_per_ray")),
            *(share(group.of(name)) for *_, name in SHARES)
        ])
    return Table(
        "rays-table", "Every kind of ray on every machine", columns, rows,
        "Means of the scenes. MRPS: the kind's rays by its own share of the thread-cycles. Issued to other waits: "
        "shares of these thread-cycles."
    ).without_empty()


def _stalls(found):
    bars = [(group.label, [(style, value, f"{group.label}: {label} {percent(value, digits=1)}")
                           for style, label, name in SHARES if (value := group.of(name)) and value > 1e-4])
            for group in found]
    return Bars("rays-stalls", f"Where the rays' thread-cycles went: {found[0].chip}",
                "share of the kind's thread-cycles", bars, [(style, label) for style, label, _ in SHARES])


def _against_chips(found, paper, identity, title, unit, name, scale=1):
    """A line for each kind over the threads of the paper's chips."""
    styles = {line: LINES[index % len(LINES)] for index, line in enumerate(chosen(found))}
    lines = {}
    for group in found:
        line = group.program, group.workload, group.kind
        if group.chip not in paper.chips or group.settings or line not in styles:
            continue
        value = group.of(name)
        if value is not None:
            tip = f"{group.label}, {group.chip}: {number(scale * value)}"
            point = paper.threads(group.chip), scale * value, tip, group.label
            lines.setdefault((line, group.size), []).append(point)
    series, known = [], [line for line, _ in lines]
    for (line, size), points in lines.items():
        style, mark = styles[line]
        label = points[0][3] + (", {}x{}".format(*size) if known.count(line) > 1 else "")
        if len(points) > 1:
            series.append(Series(label, style, sorted(point[:3] for point in points), mark, line=False))
    return Lines(identity, title, "threads", unit, series,
                 x_ticks=[(threads, str(threads)) for threads in (32, 64, 128, 256, 512)])


def figures(results, paper):
    if known := on_one_chip(results, paper):
        yield _stalls(known)
    for identity, title, unit, name, scale in _OVER_CHIPS if any(run.kinds() for run in results.runs) else ():
        yield _against_chips(groups(results), paper, identity, title, unit, name, scale)


_OVER_CHIPS = [("rays-mrps", "Rays by kind", "million rays per second", "mrps", 1),
               ("rays-issued", "MIMD: thread-cycles that issue, by kind of ray", "issued (%)", "utilisation", 100),
               ("rays-fetch", "Thread-cycles that wait for instructions, by kind of ray", "instruction fetch (%)",
                "fetch", 100),
               ("rays-memory", "Thread-cycles that wait for memory, by kind of ray", "memory (%)", "memory", 100),
               ("rays-bytes", "Bytes a ray, by kind", "bytes a ray", "bytes_per_ray", 1),
               ("rays-energy", "Energy a ray, by kind", "nJ a ray", "energy_per_ray", 1)]
