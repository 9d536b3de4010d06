"""Figures that follow from a run's statistics and are not among them."""

import csv
import math


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


def values_of(result, areas):
    statistics = result["statistics"]
    rays, memory = statistics["rays"], statistics["memory"]
    area = areas.chip(statistics["configuration"])
    values = {
        "bytes_per_ray": ratio(memory["bytes"], rays),
        "data_bytes_per_ray": ratio(memory["data_read_bytes"], rays),
        "flops_per_ray": ratio(statistics["flops"], rays),
        "frames_per_second": ratio(1e6 * statistics["mrps"] * statistics["items"], rays * FRAME),
        "area_units": area,
        "mrps_per_mm2": ratio(statistics["mrps"], area),
        "flop_utilisation": ratio(statistics["gflops"], statistics["peak_gflops"]),
    }
    sampled = statistics.get("sampled")
    if sampled and sampled["cycles_low"]:
        values["mrps_low"] = statistics["mrps"] * statistics["cycles"] / sampled["cycles_high"]
        values["mrps_high"] = statistics["mrps"] * statistics["cycles"] / sampled["cycles_low"]
    for row in result.get("lockstep", []):
        values[f"simd_utilisation.{row['width']:.0f}"] = row["utilisation"]
        values[f"simd_bound.{row['width']:.0f}"] = row["longest"]
    for kind in ("counters", "error", "hits", "code"):
        values |= {f"{kind}.{name}": value for name, value in result.get(kind, {}).items()}
    values["scene_bytes"] = sum(buffer["bytes"] for buffer in result["job"]["inputs"]["buffers"]
                                if "file" in buffer and buffer["symbol"] != "params")
    return values | values_of_rays(result, statistics)


# Causes of docs/trax-sim.md by what is behind them.
STALLS = {
    "fetch": ("icache_bank_conflict", "icache_miss"),
    "memory": ("wait_memory", "memory_queue_full"),
    "dcache": ("dcache_bank_conflict", "wait_dcache_hit"),
    "units": ("fp_add_conflict", "fp_mul_conflict", "int_mul_conflict", "special_conflict", "wait_special"),
}


def values_of_rays(result, statistics):
    """Returns values by kind of ray, with `none` for work for no ray: rays.KIND.count, mrps, bytes_per_ray,
    energy_per_ray (nJ), share (of the thread-cycles before the threads' ends), utilisation, one of STALLS and rest
    (shares of the kind's thread-cycles), and lanes.WIDTH."""
    rows = [row for row in result.get("ray_kinds", []) if row["kind"] not in ("all", "rest") and row["thread_cycles"]]
    lanes = {(row["kind"], int(row["width"])): row["utilisation"] for row in result.get("ray_lanes", [])}
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
            mine |= {
                "mrps": row["mrps"], "bytes_per_ray": row["bytes_per_ray"],
                "energy_per_ray": 1e9 * row["energy_per_ray"]
            }
        mine |= {f"lanes.{width}": share for (kind, width), share in lanes.items() if kind == row["kind"]}
        values |= {f"rays.{row['kind']}.{name}": value for name, value in mine.items()}
    return values
