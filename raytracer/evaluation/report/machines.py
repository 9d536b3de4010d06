"""The machines of a comparison of MIMD with SIMD: the sweeps whose names are below. Of each machine the best of the
programs that were tried counts, for each workload the one with the most rays, mean of the scenes. Their chips are one
TM, with a share of the bandwidth as its area has a share of a chip's: so rays for each mm2 are those of chips of one
area and one bandwidth. Of each workload the largest pictures count that both kinds of machines have rendered."""

import math

from .results import mean, ratio
from .sweeps import geometric_mean

SWEEPS = ("simd", "simd-coherent", "simd-units")
PAPERS_ICACHE = 4096  # bytes
COHERENT = ("primary-shadow", "near")  # workloads without secondary rays
RULE = ("with every workload of secondary rays, warps of 8 to 32 lanes have fewer rays per mm\u00b2 than MIMD, by the "
        "best program of each")
PER_AREA, PER_WATT = ("mrps", "values.area_units"), ("mrps", "energy.average_power")


class Machine:
    """Runs of one workload on one machine, of all programs that were tried, with pictures of one size."""
    def __init__(self, run):
        self.runs = {}
        self.lanes = int(run.set.get("simt.width", 1))
        self.own_units = run.set.get("fpu.tps_per_cluster") == 1
        self.icache = run.set.get("icache.bytes", PAPERS_ICACHE)

    @property
    def name(self):
        parts = ["MIMD" if self.lanes == 1 else f"SIMD {self.lanes}"]
        if self.lanes > 1:
            parts.append("own units" if self.own_units else "shared units")
        if self.icache != PAPERS_ICACHE:
            parts.append(f"{self.icache // 1024} kB")
        return ", ".join(parts)

    @property
    def is_papers(self):
        return self.lanes == 1 and not self.own_units and self.icache == PAPERS_ICACHE

    def of(self, program, name, per=None):
        """By scene."""
        def one(run):
            value = run.get(name)
            return value if per is None else ratio(value, run.get(per))

        return {run.scene: one(run) for run in self.runs[program]}

    @property
    def program(self):
        """The best one; None: none was measured on all scenes."""
        rates = [(rate, name) for name in self.runs
                 if (rate := mean(self.of(name, "mrps").values())) is not None]
        return max(rates)[1] if rates else None

    def best(self, name, per=None):
        return self.of(self.program, name, per) if self.program else {}

    def mean(self, name, per=None):
        return mean(self.best(name, per).values())

    def halves(self, name):
        """Returns by scene half the width of the rate's interval, relative to the rate; 0 for exact runs."""
        found = {}
        for run in self.runs.get(self.program, []):
            low, high = run.get("values.mrps_low"), run.get("values.mrps_high")
            half = (high - low) / 2 if name == "mrps" and None not in (low, high) else run.get(f"{name}_half")
            found[run.scene] = ratio(half or 0, run.get(name)) or 0
        return found

    def kinds(self):
        return dict.fromkeys(kind for run in self.runs.get(self.program, []) for kind in run.kinds())


def _by_size(results):
    """Returns the machines of the sweeps by workload and size, large pictures first, without those of which no
    program was measured on all scenes."""
    runs = {run.index: run for sweep in SWEEPS for run in results.of_sweep(sweep)}
    scenes = {run.scene for run in runs.values()}
    found = {}
    for run in runs.values():
        place = run.workload, run.size, tuple(sorted(run.set.items()))
        found.setdefault(place, Machine(run)).runs.setdefault(run.program, []).append(run)
    groups = {}
    for (workload, size, _), machine in found.items():
        machine.runs = {name: some for name, some in machine.runs.items() if {run.scene for run in some} == scenes}
        if machine.program:
            groups.setdefault((workload, size), []).append(machine)
    for some in groups.values():
        some.sort(key=lambda one: (one.lanes > 1, one.icache, not one.own_units and one.lanes > 1, one.lanes))
    order = list(results.named("workloads"))
    known = [place for place in groups if place[0] in order]
    return {place: groups[place] for place in sorted(known, key=lambda one: (order.index(one[0]), -one[1][0]))}


def machines(results):
    """The machines by workload."""
    found = {}
    for (workload, _), some in _by_size(results).items():
        if papers(some) and any(machine.lanes > 1 for machine in some):
            found.setdefault(workload, some)
    return found


def papers(some):
    return next((machine for machine in some if machine.is_papers), None)


def times(machine, base, name, per):
    """Returns by scene how many times the figure of the other machine this one has."""
    own, other = machine.best(name, per), base.best(name, per) if base else {}
    return [ratio(value, other.get(scene)) for scene, value in own.items()]


def half_of_times(machine, base, name):
    """Half the width of the interval of the geometric mean of the scenes' quotients, relative to it; 0: runs are
    exact."""
    own, other = machine.halves(name), base.halves(name)
    squares = [half**2 + other.get(scene, 0)**2 for scene, half in own.items()]
    return math.sqrt(math.fsum(squares)) / len(squares) if squares else 0


def mean_times(machine, base, name, per):
    """The geometric mean of the scenes."""
    found = times(machine, base, name, per)
    return geometric_mean(found) if found and None not in found else None


def tried(results, program):
    """Whether the paper's machine ran the program."""
    return any(program in papers(some).runs for some in machines(results).values())


def lanes_in_use(results):
    """(share of 32 lanes in use by primary and shadow rays, the program with the most); (None, "") if it is not known.
    With units that lanes do not share, so that nothing but divergence leaves lanes unused."""
    wide = [machine for machine in machines(results).get(COHERENT[0], [])
            if machine.lanes == 32 and machine.own_units and machine.icache == PAPERS_ICACHE]
    shares = [(share, name) for machine in wide for name in machine.runs
              if (share := mean(machine.of(name, "simt.efficiency").values())) is not None]
    return max(shares, default=(None, ""))


def judged(results):
    """The paper's claim: (holds, finding); holds is None if it is not known."""
    secondary, coherent = [], []
    for workload, some in machines(results).items():
        base = papers(some)
        for machine in some:
            if machine.lanes >= 8 and machine.icache == PAPERS_ICACHE:
                gain = mean_times(machine, base, *PER_AREA)
                (coherent if workload in COHERENT else secondary).append((gain, workload, machine.name))
    if not secondary or any(gain is None for gain, *_ in secondary):
        return None, "not measured"
    best, worst = max(secondary), min(secondary)
    found = (f"with secondary rays SIMD of 8 to 32 lanes has {worst[0]:.2f} to {best[0]:.2f} times the rays for each "
             f"mm\u00b2 ({best[1]}: {best[2]})")
    if coherent and all(gain is not None for gain, *_ in coherent):
        best = max(coherent)
        found += f"; without them at most {best[0]:.2f} times ({best[1]}: {best[2]})"
    return max(secondary)[0] < 1, found
