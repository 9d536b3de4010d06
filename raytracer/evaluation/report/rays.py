"""Rays by kind: what MIMD gains as rays lose coherence. Of runs with the values rays.KIND.*, which sweeps with
`ray_kinds` have."""

from .charts import STYLES
from .plots import Bars, Lines, Series
from .results import mean, ratio
from .sweeps import by_kind
from .table import Cell, Table, figure, number, percent, share, words

WIDTHS = (4, 8, 16, 32)
LINES = [*STYLES, (0, "dot")]  # styles of kinds
# Of a kind's thread-cycles, as page.css has the causes of all threads.
SHARES = [(10, "issued", "utilisation"), (11, "instruction fetch", "fetch"),
          (12, "data-cache banks and hits", "dcache"), (13, "off-chip memory", "memory"), (14, "shared units", "units"),
          (17, "other waits", "rest")]

EXPLAINED = (
    "Rays that leave a surface in many directions have less and less in common. A SIMD machine makes one step for all "
    "its lanes, so lanes whose rays do not need it are lost; "
    "a machine of independent threads loses none to that, but each thread waits for instructions, memory and shared "
    "units by itself. Of the same rays: the lanes that a SIMD machine would "
    "use, and the thread-cycles in which this machine issues.")


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


def groups(results, lanes=False):
    """Returns all kinds on all machines, or on those with known lanes of a SIMD machine. A missing scene makes the mean
    of its group missing."""
    found = {}
    runs = [run for run in results.runs if not lanes or any(".lanes." in name for name in run.values) or not run.done]
    for run in by_kind(runs):
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


def with_lanes(results):
    """Groups whose runs tell a SIMD machine's lanes, of the lines of figures; the most coherent first."""
    found = groups(results, True)
    lines = chosen(found)
    groups_of_lines = {}
    for group in found:
        if (group.program, group.workload, group.kind) in lines and group.of("lanes.32") is not None:
            groups_of_lines.setdefault((group.program, group.workload, group.kind), group)
    return sorted(groups_of_lines.values(), key=lambda group: -group.of("lanes.32"))


def gain_table(results):
    """The gain of a machine of independent threads over a SIMD machine with as many lanes, if lanes were the only
    difference."""
    columns = [("kind of ray", "t"), ("workload", "t"), ("program", "t"),
               ("chip", "t")] + [(f"{width} lanes in use", "n")
                                 for width in WIDTHS] + [(f"MIMD over {width} lanes", "n") for width in WIDTHS]
    columns += [("MIMD issues", "n"), ("MRPS", "n"), ("bytes/ray", "n"), ("nJ/ray", "n")]
    rows = []
    for group in with_lanes(results):
        lanes = [group.of(f"lanes.{width}") for width in WIDTHS]
        rows.append([
            words(group.kind),
            words(group.workload),
            words(group.program),
            words(group.chip), *(share(value) for value in lanes), *(_times(value) for value in lanes),
            share(group.of("utilisation")),
            *(figure(group.of(name)) for name in ("mrps", "bytes_per_ray", "energy_per_ray"))
        ])
    return Table(
        "rays-gain", "What MIMD gains as rays lose coherence", columns, rows,
        "The most coherent rays first; means of the scenes. Each kind is shown of the first workload that has it; the "
        "table of all is below. Lanes in use: the share of a SIMD machine's lanes that the same rays use, in full "
        "warps of one kind and generation, with memory that takes no time (docs/explaining.md, --lockstep-rays). MIMD "
        "over lanes: 1 over that share, how many times the work a thread of its own for each lane does, if divergence "
        "is all that is lost. MIMD issues: the share of the kind's "
        "thread-cycles in which an instruction issues here, with all waits for caches, units and memory."
    )


def _times(lanes):
    times = ratio(1, lanes)
    return Cell(None if times is None else f"{number(times, 2)}\u00a0×", times)


def kinds_table(results):
    """A row for each workload, kind of ray and machine: the mean of the scenes."""
    columns = [("workload", "t"), ("kind", "t"), ("program", "t"), ("chip", "t"), ("scenes", "n"), ("rays", "n"),
               ("MRPS", "n"), ("bytes/ray", "n"), ("nJ/ray", "n")]
    columns += [(name, "n") for _, name, _ in SHARES] + [(f"{width} lanes", "n") for width in WIDTHS]
    rows = []
    for group in groups(results):
        name = ", ".join([group.chip, *(f"{key} = {value}" for key, value in group.settings)])
        counts = [run.get(f"values.rays.{group.kind}.count") for run in group.runs]
        rows.append([
            words(group.workload),
            words(group.kind),
            words(group.program),
            words(name),
            figure(len(group.runs)),
            figure(None if None in counts else sum(counts)),
            *(figure(group.of(name)) for name in ("mrps", "bytes_per_ray", "energy_per_ray")),
            *(share(group.of(name))
              for name in (*(name for *_, name in SHARES), *(f"lanes.{width}" for width in WIDTHS)))
        ])
    return Table(
        "rays-table", "Every kind of ray on every machine", columns, rows,
        "Means of the scenes. MRPS: the kind's rays by its own share of the thread-cycles. Issued to other waits: "
        "shares of these thread-cycles."
    ).without_empty()


def _lanes(found):
    """Lanes in use over kinds of rays, a line for each width, and what the threads of the emulated chip issue."""
    kinds = [group.kind for group in found]
    ticks = [(place, group.kind if kinds.count(group.kind) == 1 else group.label if group.several else group.workload)
             for place, group in enumerate(found)]
    series = []
    for index, width in enumerate(WIDTHS):
        style, mark = STYLES[index % len(STYLES)]
        points = [(place, value and 100 * value, f"{group.label}: {percent(value)} of {width} lanes" if value else "")
                  for place, group in enumerate(found) for value in [group.of(f"lanes.{width}")]]
        series.append(Series(f"SIMD, {width} lanes", style, points, mark))
    points = [(place, value and
               100 * value, f"{group.label}: {percent(value)} of the thread-cycles issue on {group.chip}")
              for place, group in enumerate(found) for value in [group.of("utilisation")]]
    series.append(Series("MIMD: issued, all waits counted", 0, points, "circle", dashed=True))
    return Lines("rays-lanes", "In use, as rays lose coherence", "rays, the most coherent first",
                 "lanes or issue slots in use (%)", series, x_ticks=ticks)


def _gain(found):
    ticks = [(width, str(width)) for width in (1, *WIDTHS)]
    series = []
    for index, group in enumerate(found):
        style, mark = LINES[index % len(LINES)]
        points = [(1, 1.0, f"{group.label}: 1 lane wastes none")]
        points += [(width, ratio(1, group.of(f"lanes.{width}")),
                    f"{group.label}: {1 / value:.1f} times the work of {width} lanes" if
                    (value := group.of(f"lanes.{width}")) else "") for width in WIDTHS]
        series.append(Series(group.label, style, points, mark, dashed=index >= len(LINES)))
    return Lines("rays-gain-plot", "MIMD over SIMD, if lanes are all that differs", "lanes of the SIMD machine",
                 "times the work", series, log_x=True, base=2, x_ticks=ticks)


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
    series = []
    for (line, _), points in lines.items():
        style, mark = styles[line]
        if len(points) > 1:
            series.append(Series(points[0][3], style, sorted(point[:3] for point in points), mark, line=False))
    return Lines(identity, title, "threads", unit, series,
                 x_ticks=[(threads, str(threads)) for threads in (32, 64, 128, 256, 512)])


def figures(results, paper):
    known = with_lanes(results)
    if known:
        yield _lanes(known)
        yield _gain(known)
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
