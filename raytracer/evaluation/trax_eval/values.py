"""Figures that follow from a run's statistics and are not among them."""


def ratio(numerator, denominator):
    return numerator / denominator if denominator else None


def values_of(statistics):
    rays, memory = statistics["rays"], statistics["memory"]
    values = {
        "bytes_per_ray": ratio(memory["bytes"], rays),
        "data_bytes_per_ray": ratio(memory["data_read_bytes"], rays),
        "flops_per_ray": ratio(statistics["flops"], rays),
        "frames_per_second": ratio(1, statistics["seconds"]),
        "mrps_per_mm2": ratio(statistics["mrps"], statistics["area_mm2"]),
    }
    sampled = statistics.get("sampled")
    if sampled and sampled["cycles_low"]:
        values["mrps_low"] = statistics["mrps"] * statistics["cycles"] / sampled["cycles_high"]
        values["mrps_high"] = statistics["mrps"] * statistics["cycles"] / sampled["cycles_low"]
    return values
