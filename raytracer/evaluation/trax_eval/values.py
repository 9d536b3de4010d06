"""Figures that follow from a run's statistics and are not among them."""

import csv
import math
import statistics as stat


def ratio(numerator, denominator):
    return numerator / denominator if denominator else None


FRAME = 1280 * 720  # pixels of the paper's pictures
ICACHE = 4096  # bytes, of the instruction caches in areas.csv


class Areas:
    """The chip as a sum of its units at 65 nm. It has no wires, arbiters, queues or clock; the paper's has."""
    def __init__(self, folder):
        with open(folder / "areas.csv", newline="") as file:
            self.units = {row["unit"]: float(row["mm2"]) for row in csv.DictReader(file)}

    def cache(self, kind, size, banks):
        """mm2; between two numbers of banks in proportion, None where there is no figure. An instruction cache of
        another size than 4 kB in proportion to it."""
        if kind == "icache" and size != ICACHE:
            area = self.cache(kind, ICACHE, banks)
            return area and area * size / ICACHE
        known = sorted(
            (int(name.split("_")[2]), area) for name, area in self.units.items() if name.startswith(f"{kind}_{size}_"))
        for (low, below), (high, above) in zip(known, known[1:] or known):
            if low <= banks <= high:
                return below + (above - below) * (banks - low) / max(1, high - low)
        return None

    def chip(self, configuration):
        """mm2, or None: there is no figure for such a cache."""
        def groups(tps):
            return -(-threads // tps)

        threads = configuration["chip"]["tps_per_tm"]
        fpu, icache, dcache = (configuration[name] for name in ("fpu", "icache", "dcache"))
        caches = (self.cache("icache", icache["bytes"],
                             icache["banks"]), self.cache("dcache", dcache["bytes"], groups(dcache["tps_per_bank"])))
        if None in caches or configuration["l2"]["bytes"]:
            return None
        unit = self.units
        tp = math.fsum(unit[name] for name in ("register_file", "local_memory", "int_add", "branch", "bitwise"))
        compare = unit["fp_compare"] + unit["convert"]
        area = threads * (tp + (compare if fpu["compare_units"] else 0))
        adder = unit["fp_add"] + (0 if fpu["compare_units"] else compare)
        area += groups(fpu["tps_per_cluster"]) * fpu["adders_per_cluster"] * adder
        multiplier_groups = groups(fpu["mul_tps_per_cluster"] or fpu["tps_per_cluster"])
        area += multiplier_groups * fpu["multipliers_per_cluster"] * unit["fp_mul"]
        int_mul = configuration["int_mul"]
        area += groups(int_mul["tps_per_unit"]) * int_mul["units_per_group"] * unit["int_mul"]
        area += configuration["special"]["units_per_tm"] * unit["special"]
        # docs/results/ray-unit.md
        ray = 6 * (unit["fp_add"] + unit["fp_mul"]) + 13 * unit["fp_compare"] + unit["special"]
        area += groups(configuration["ray"]["tps_per_group"]) * configuration["ray"]["units_per_group"] * ray
        area += groups(icache["tps_per_cache"]) * caches[0] + caches[1]
        return configuration["chip"]["tms"] * area


# Figures of every run: name -> figure(statistics, area).
OF_RUNS = {
    "bytes_per_ray": lambda stats, _: ratio(stats["memory"]["bytes"], stats["rays"]),
    "data_bytes_per_ray": lambda stats, _: ratio(stats["memory"]["data_read_bytes"], stats["rays"]),
    "flops_per_ray": lambda stats, _: ratio(stats["flops"], stats["rays"]),
    "frames_per_second": lambda stats, _: ratio(1e6 * stats["mrps"] * stats["items"], stats["rays"] * FRAME),
    "area_units": lambda _, area: area,
    "mrps_per_mm2": lambda stats, area: ratio(stats["mrps"], area),
    "flop_utilisation": lambda stats, _: ratio(stats["gflops"], stats["peak_gflops"]),
}
# Figures of some runs, beside those of kinds of rays. Other programs' figures have their names.
OF_SOME_RUNS = ("mrps_low", "mrps_high", "scene_bytes", "picture.pixels_that_differ", "counters.*", "error.*", "hits.*",
                "code.*", "scene.*", "rebuild_pays_below")


def values_of(result, areas):
    statistics = result["statistics"]
    area = areas.chip(statistics["configuration"])
    values = {name: figure(statistics, area) for name, figure in OF_RUNS.items()}
    sampled = statistics.get("sampled")
    if sampled and sampled["cycles_low"]:
        values["mrps_low"] = statistics["mrps"] * statistics["cycles"] / sampled["cycles_high"]
        values["mrps_high"] = statistics["mrps"] * statistics["cycles"] / sampled["cycles_low"]
    for kind in ("counters", "error", "hits", "code"):
        values |= {f"{kind}.{name}": value for name, value in result.get(kind, {}).items()}
    values["scene_bytes"] = sum(buffer["bytes"] for buffer in result["job"]["inputs"]["buffers"]
                                if "file" in buffer and buffer["symbol"] != "params")
    return values | values_of_rays(result, statistics)


# Causes of docs/trax-sim.md, grouped by the unit that they wait for.
STALLS = {
    "fetch": ("icache_bank_conflict", "icache_miss"),
    "memory": ("wait_memory", "memory_queue_full"),
    "dcache": ("dcache_bank_conflict", "wait_dcache_hit"),
    "units": ("fp_add_conflict", "fp_mul_conflict", "int_mul_conflict", "special_conflict", "wait_special"),
}
OF_RAYS = ("count", "mrps", "bytes_per_ray", "energy_per_ray", "share", "utilisation", *STALLS, "rest")


def rows_of_rays(result, statistics):
    """The row of each kind of ray, of trax-sim --ray-kinds or --ray-cycles."""
    rate = statistics["configuration"]["chip"]["clock_mhz"] * statistics["threads"]
    whole, *parts = parts_of_rays(result) or [{}]
    cycles = []
    for kind, row in whole.items():
        # A sampled run has the ratio of its parts: the cycles of a ray vary less from place to place than the number of
        # rays.
        rays, spent = (math.fsum(part[kind][name] for part in parts or [whole]) for name in ("rays", "thread_cycles"))
        cycles.append(row | {"mrps": ratio(rate * rays, spent)})
    return [
        row for row in result.get("ray_kinds", cycles) if row["kind"] not in ("all", "rest") and row["thread_cycles"]
    ]


def values_of_rays(result, statistics):
    """Returns values by kind of ray, with `none` for work for no ray: rays.KIND.NAME with the names OF_RAYS. Energies
    are in nJ; `share` is of the thread-cycles before the threads' ends, and utilisation, stalls and rest are shares of
    the kind's. Of a sampled run also half the width of a figure's interval, NAME_half."""
    rows = rows_of_rays(result, statistics)
    live = statistics["thread_cycles"] - statistics["causes"]["halted"]
    values = {}
    for row in rows:
        cycles = row["thread_cycles"] - row["halted"]
        mine = {"count": row["rays"], "share": ratio(cycles, live), "utilisation": ratio(row["issued"], cycles)}
        for stall, causes in STALLS.items():
            mine[stall] = ratio(sum(row[cause] for cause in causes), cycles)
        mine["rest"] = max(
            0, 1 - math.fsum(value or 0 for name, value in mine.items() if name in STALLS or name == "utilisation"))
        if row["rays"]:
            mine["mrps"] = row["mrps"]
        if row["rays"] and "energy_per_ray" in row:
            mine |= {"bytes_per_ray": row["bytes_per_ray"], "energy_per_ray": 1e9 * row["energy_per_ray"]}
        values |= {f"rays.{row['kind']}.{name}": value for name, value in mine.items()}
    return values | halves_of_rays(result, values)


# --- intervals of sampled runs

BIAS = 0.01  # for caches after a warm-up, as in docs/sampling.md


def student_95(degrees):
    """The quantile of Student's distribution: a value lies between minus and plus the result with probability 0.95
    (Abramowitz and Stegun, 26.7.5; the first from tables)."""
    few = (0, 12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179)
    if degrees < len(few):
        return few[degrees]
    z, n = 1.959964, degrees
    terms = z, (z**3 + z) / 4, (5 * z**5 + 16 * z**3 + 3 * z) / 96, (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384
    return sum(term / n**power for power, term in enumerate(terms))


def half_width(draws, whole, divisor=None):
    """Half the width of the interval of an estimated total, or of its quotient by another one. draws: (total, other) of
    each draw, weighted, so that they add up to what was sampled. The error of a quotient is that of its numerator
    minus the quotient times its denominator, to first order (Cochran, Sampling Techniques, 6.3)."""
    estimate = whole if divisor is None else whole / divisor
    errors = [total - (0 if divisor is None else estimate * other) for total, other in draws]
    spread = math.sqrt(len(errors) * stat.variance(errors)) / (divisor or 1)
    return student_95(len(errors) - 1) * spread + BIAS * abs(estimate)


def parts_of_rays(result):
    """The parts of a run that counted the cycles of rays, a row for each kind: the whole, and if it was sampled its
    beginning and end, and then the draws, weighted so that they add up."""
    rows = result.get("ray_cycles", [])
    kinds = len({row["kind"] for row in rows})
    parts = [{row["kind"]: row for row in rows[first:first + kinds]} for first in range(0, len(rows), kinds or 1)]
    return [{
        kind: {name: value if name in ("part", "kind") else row["weight"] * value for name, value in row.items()}
        for kind, row in part.items()
    } for part in parts]


def halves_of_rays(result, values):
    """Half widths of the figures that values_of_rays returns of a sampled run."""
    whole, *parts = parts_of_rays(result) or [{}]
    if len(parts) < 3:  # an exact run, or a single draw
        return {}
    halves = {}
    known = [cause for stall in STALLS.values() for cause in stall] + ["issued"]
    shares = {"utilisation": ["issued"], "rest": known} | STALLS

    def live(row):
        return row["thread_cycles"] - row["halted"]

    def half(kind, over, below=None):
        """Returns the relative half width of the sum of over(part), or of its quotient by the sum of below(part)."""
        draws = [(over(part[kind]), below(part[kind]) if below else 0) for part in parts[1:]]
        sums = [math.fsum(side(part[kind]) for part in parts) for side in (over, below) if side]
        return ratio(half_width(draws, *sums), sums[0] / sums[1] if below else sums[0]) if all(sums) else 0

    for kind in whole:
        for name in ("mrps", "share", *shares):
            value = values.get(f"rays.{kind}.{name}")
            if value is None:
                continue
            if name == "mrps":
                width = half(kind, lambda row: row["thread_cycles"], lambda row: row["rays"])
            elif name == "share":
                width = half(kind, live)
            else:
                width = half(kind, lambda row, causes=shares[name]: sum(row[cause] for cause in causes), live)
            # The rest has the absolute error of the known parts.
            halves[f"rays.{kind}.{name}_half"] = width * (1 - value if name == "rest" and value else value)
    return halves
