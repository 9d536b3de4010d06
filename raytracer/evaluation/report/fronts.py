"""The fronts of the paper's chips: rays for area, power and bandwidth, by the sweep `rays`."""

from .charts import STYLES
from .own import COSTS, LABELS, front
from .plots import Lines, Series
from .results import mean, ratio
from .table import Cell, Table, figure, words

WORKLOAD = "primary-shadow"  # the paper's
SWEEP = "rays"


class Chip:
    """The runs of all scenes on one chip."""
    def __init__(self, name):
        self.name, self.runs = name, []

    def get(self, statistic):
        return mean(run.get(statistic) for run in self.runs)


def chips(results, paper):
    """The paper's chips with exact runs of all scenes, of the program and size that most chips have."""
    found = {}
    for run in results.runs:
        if (SWEEP in run.experiments and run.done and run.workload == WORKLOAD and run.config in paper.chips
                and not run.set and not run.is_estimate()):
            found.setdefault((run.program, run.size), {}).setdefault(run.config, Chip(run.config)).runs.append(run)
    most = max(found.values(), key=len, default={})
    scenes = max((len(chip.runs) for chip in most.values()), default=0)
    known = [most[name] for name in paper.chips if name in most and len(most[name].runs) == scenes]
    needed = "mrps", *(cost for _, cost, _ in COSTS)
    return [chip for chip in known if None not in [chip.get(name) for name in needed]]


def chips_table(results, paper):
    known = chips(results, paper)
    fronts = {identity: front(known, cost) for identity, cost, _ in COSTS}
    rows = []
    for chip in known:
        on = ", ".join(identity for identity, chosen in fronts.items() if chip in chosen)
        rows.append([
            words(chip.name),
            figure(paper.threads(chip.name)),
            figure(chip.get("mrps")),
            *(figure(chip.get(cost)) for _, cost, _ in COSTS),
            *(figure(ratio(chip.get("mrps"), chip.get(cost))) for _, cost, _ in COSTS[:2]),
            Cell(on, on)
        ])
    columns = [("chip", "t"), ("threads", "n"), ("MRPS", "n"), ("mm²", "n"), ("W", "n"), ("GB/s", "n"),
               ("MRPS/mm²", "n"), ("MRPS/W", "n"), ("on the front of", "t")]
    return Table("chips-front", "The paper's chips: rays for area, power and bandwidth", columns, rows,
                 "Means of the scenes. On the front: no chip that costs as little has as many rays. GB/s: in use.")


def figures(results, paper):
    known, (style, mark), series = chips(results, paper), STYLES[0], []
    _, cost, _ = COSTS[0]

    def points(some):
        return [(chip.get(cost), chip.get("mrps"),
                 f"{chip.name}: {chip.get('mrps'):.4g} MRPS, {chip.get(cost):.4g} mm²") for chip in some]

    if known:
        series = [Series("the paper's chips", style, points(known), mark, line=False),
                  Series("front (dashed)", style, points(front(known, cost)), mark, dashed=True)]
    yield Lines("chips-front", "The paper's chips: rays and area", LABELS[cost], LABELS["mrps"], series)
