"""Axes and figures that a sweep names and only its report looks up. A mistyped one would leave a plot or table out."""

import fnmatch

from .sweep import option_of
from .table_spec import descriptions
from .util import Problem, nearest

AXES = ("program", "scene", "workload", "kind", "variant", "chip", "size", "mode", "threads")
# Figures whose names depend on the run: of trax-eval, of the host, of the scene, of the machine.
OPEN = ("values.*", "kind.*", "host.*", "scene.*", "configuration.*", "configuration")


class Names:
    """What the sweep's report knows: the keys that trax-sim describes and those that the sweep sets; statistics."""
    def __init__(self, sweep, tools):
        self.sweep = sweep
        keys = {key for point in sweep.points for key, _ in (*point.settings, *point.program.settings)}
        self.axes = dict.fromkeys((*AXES, *sorted(keys), *tools.described("--help-config")))
        self.figures = dict.fromkeys(tools.described("--help-stats"))

    def check(self, place, name, known, what):
        name = str(name)
        if not option_of(name) and not any(fnmatch.fnmatchcase(name, pattern) for pattern in (*known, *OPEN)):
            raise Problem(f'{self.sweep.file}: {place}: "{name}" is no {what}{nearest(name, known)}')

    def axis(self, place, name):
        self.check(place, name, self.axes,
                   f"axis: neither a key of trax-sim --help-config nor one of {', '.join(AXES)}")

    def figure(self, place, name):
        self.check(place, name, self.figures, "statistic of trax-sim --help-stats, nor values.NAME or kind.NAME")

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
