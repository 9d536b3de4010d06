"""Figures that follow from a run's statistics and are not among them."""

import csv


def ratio(numerator, denominator):
    return numerator / denominator if denominator else None


FRAME = 1280 * 720  # pixels of the paper's pictures


class Areas:
    """The chip as a sum of its units at 65 nm. It has no wires, arbiters, queues or clock; the paper's has."""

    def __init__(self, folder):
        with open(folder / "areas.csv", newline="") as file:
            self.units = {row["unit"]: float(row["mm2"]) for row in csv.DictReader(file)}

    def cache(self, kind, size, banks):
        """mm2; between two numbers of banks in proportion, None where there is no figure."""
        known = sorted((int(name.split("_")[2]), area) for name, area in self.units.items() if name.startswith(f"{kind}_{size}_"))
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
        caches = (self.cache("icache", icache["bytes"], icache["banks"]), self.cache("dcache", dcache["bytes"], groups(dcache["tps_per_bank"])))
        if None in caches or configuration["l2"]["bytes"]:
            return None
        unit = self.units
        tp = sum(unit[name] for name in ("register_file", "local_memory", "int_add", "branch", "bitwise"))
        compare = unit["fp_compare"] + unit["convert"]
        area = threads * (tp + (compare if fpu["compare_units"] else 0))
        area += groups(fpu["tps_per_cluster"]) * fpu["adders_per_cluster"] * (unit["fp_add"] + (0 if fpu["compare_units"] else compare))
        area += groups(fpu["mul_tps_per_cluster"] or fpu["tps_per_cluster"]) * fpu["multipliers_per_cluster"] * unit["fp_mul"]
        area += groups(configuration["int_mul"]["tps_per_unit"]) * configuration["int_mul"]["units_per_group"] * unit["int_mul"]
        area += configuration["special"]["units_per_tm"] * unit["special"]
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
    return values
