"""Axes and figures that a sweep names and only its report looks up. A mistyped one would leave a plot or table out."""

import fnmatch

from .sweep import option_of
from .table_spec import descriptions
from .util import Problem, nearest
from .values import OF_RAYS, OF_RUNS, OF_SOME_RUNS
from .workloads import KINDS

AXES = ("program", "scene", "workload", "kind", "variant", "chip", "size", "mode", "threads")


def own_figures():
    """The names of the figures that trax-eval adds to the statistics; patterns where a part of them is a run's own."""
    of_rays = [*OF_RAYS, *(f"{name}_half" for name in OF_RAYS)]
    return ["host.processor_seconds", *(f"values.{name}" for name in (*OF_RUNS, *OF_SOME_RUNS)),
            *(f"values.rays.{kind}.{name}" for kind in (*KINDS, "none") for name in of_rays),
            *(f"kind.{name}" for name in of_rays)]


class Names:
    """Returns the names that the sweep's report knows: keys of trax-sim and of the sweep, and figures."""
    def __init__(self, sweep, tools):
        self.sweep, described = sweep, tools.described("--help-config")
        keys = {key for point in sweep.points for key, _ in (*point.settings, *point.program.settings)}
        self.axes = dict.fromkeys((*AXES, *sorted(keys), *described))
        self.figures = dict.fromkeys([*tools.described("--help-stats"), *own_figures(),
                                      *(f"configuration.{key}" for key in described)])

    def check(self, place, name, known, what):
        name = str(name)
        if not option_of(name) and not any(fnmatch.fnmatchcase(name, pattern) for pattern in known):
            raise Problem(f'{self.sweep.file}: {place}: "{name}" is no {what}{nearest(name, known)}')

    def axis(self, place, name):
        self.check(place, name, self.axes,
                   f"axis: neither a key of trax-sim --help-config nor one of {', '.join(AXES)}")

    def figure(self, place, name):
        self.check(place, name, self.figures,
                   "statistic of trax-sim --help-stats, and no values.NAME or kind.NAME of trax-eval")

    def table(self, place, spec):
        for member in ("each", "rows", "columns", "mean"):
            for name in spec.get(member, []):
                self.axis(f"{place}.{member}", name)
        for member in ("where", "only", "relative"):
            for name in spec.get(member, {}):
                self.axis(f"{place}.{member}", name)
        for value in spec.get("values", []):
            value = {"name": value} if isinstance(value, str) else value
            for member in ("name", "per"):
                if member in value:
                    self.figure(f"{place}.values", value[member])


def check_report(sweep, tools):
    names = Names(sweep, tools)
    known = names.axes | names.figures
    names.check("x", sweep.x, known, "key of trax-sim --help-config, no axis and no statistic of --help-stats")
    names.figure("y", sweep.y)
    if sweep.y_per:
        names.figure("y_per", sweep.y_per)
    many = isinstance(sweep.table, list)
    for number, spec in enumerate(descriptions({"name": sweep.name, "table": sweep.table})):
        names.table(f"table[{number}]" if many else "table", spec)
