"""The tables and figures of MIMD against SIMD."""

from .machines import PAPERS_ICACHE, PER_AREA, PER_WATT, half_of_times, machines, mean_times, papers, times
from .plots import Lines, Series
from .sweeps import geometric_mean
from .table import Cell, Table, duration, figure, number, share, words

LINES = [(3, "triangle"), (4, "diamond"), (5, "circle"), (0, "square"), (1, "triangle"), (2, "dot")]  # of workloads
EXPLAINED = (
    "The same rays on warps: lanes that are at the same instruction execute it together, with one fetch. Machines are "
    "compared at equal area, the sum of published areas of units, and equal bandwidth. Of each machine the best of the "
    "programs that were tried counts.")


def _interval(machine, base, name, per):
    """A cell: the geometric mean of the scenes, the least and the greatest."""
    found = times(machine, base, name, per)
    if not found or None in found:
        return Cell(None)
    several = len(found) > 1 and machine is not base
    below = f"{number(min(found), 2)} to {number(max(found), 2)}" if several else ""
    half = half_of_times(machine, base, name) if several else 0
    below += f"; \u00b1 {number(half * geometric_mean(found), 1)}" if half else ""
    return figure(geometric_mean(found), below=below)


def best_table(results):
    columns = [("workload", "t"), ("machine", "t"), ("program", "t"), ("MRPS", "n"), ("mm\u00b2", "n"),
               ("MRPS/mm\u00b2", "n"), ("W", "n"), ("MRPS/W", "n"), ("lanes in use", "n"),
               ("MRPS/mm\u00b2 over MIMD's", "n"), ("MRPS/W over MIMD's", "n"), ("processor time", "n")]
    rows = []
    for workload, some in machines(results).items():
        base = papers(some)
        for machine in some:
            rows.append([
                words(workload),
                words(machine.name),
                words(machine.program),
                figure(machine.mean("mrps")),
                figure(machine.mean("values.area_units")),
                figure(machine.mean(*PER_AREA)),
                figure(machine.mean("energy.average_power")),
                figure(machine.mean(*PER_WATT)),
                share(machine.mean("simt.efficiency")),
                _interval(machine, base, *PER_AREA),
                _interval(machine, base, *PER_WATT),
                duration(machine.mean("host.processor_seconds"))
            ])
    return Table(
        "simd-best", "MIMD against SIMD at equal area and equal bandwidth", columns, rows,
        "Means of the scenes; over MIMD's: the geometric mean of the scenes, the least and the greatest of them and, "
        "of sampled runs, half the width of the mean's interval. Processor time: of one scene."
    )


def kinds_table(results):
    """Rays of a kind for each mm2, over MIMD's: a column for each machine."""
    found = machines(results)
    names = list(dict.fromkeys(machine.name for some in found.values() for machine in some if not machine.is_papers))
    rows = []
    for workload, some in found.items():
        base = papers(some)
        for kind in base.kinds() if base else ():
            name = f"values.rays.{kind}.mrps"
            own = {machine.name: machine for machine in some}
            rows.append([words(workload), words(kind), figure(base.mean(name, "values.area_units"))] + [
                _interval(own[other], base, name, "values.area_units") if other in own else Cell(None)
                for other in names
            ])
    columns = [("workload", "t"), ("kind", "t"), ("MIMD: MRPS/mm\u00b2", "n"),
               *((name, "n") for name in names)]
    return Table(
        "simd-kinds", "Rays of a kind for each mm\u00b2, over MIMD's", columns, rows,
        "The geometric mean of the scenes, the least and the greatest of them and, of sampled runs, half "
        "the width of the mean's interval.")


def _curves(results, identity, title, figure_of):
    series = []
    ticks = [(lanes, str(lanes)) for lanes in (1, 4, 8, 16, 32)]
    for index, (workload, some) in enumerate(machines(results).items()):
        base = papers(some)
        points = [(1, 1.0, f"{workload}, MIMD: 1")]
        for machine in some:
            if machine.own_units and machine.icache == PAPERS_ICACHE and machine.lanes > 1:
                value = mean_times(machine, base, *figure_of)
                points.append((machine.lanes, value, f"{workload}, {machine.name}: {number(value)}" if value else ""))
        style, mark = LINES[index % len(LINES)]
        if len(points) > 1 and base:
            series.append(Series(workload, style, points, mark, dashed=index >= len(LINES)))
    return Lines(identity, title, "lanes of a warp", "times MIMD's", series, log_x=True, base=2, x_ticks=ticks)


def figures(results):
    yield _curves(results, "simd-area", "SIMD with a unit for each lane over MIMD: MRPS/mm\u00b2", PER_AREA)
    yield _curves(results, "simd-watt", "SIMD with a unit for each lane over MIMD: MRPS/W", PER_WATT)
