"""The paper's assertions about its choices, judged by the sweeps. A judge returns (holds, finding); holds is None if it
is not known."""

from .machines import RULE as RULE_OF_SIMD
from .machines import judged, lanes_in_use, tried
from .results import mean, ratio

NOT_MEASURED = "not measured"
_NOT_KNOWN = None, NOT_MEASURED


def swept(results, sweep, program, chip, settings, figure):
    """The mean over the scenes of a figure in a sweep's runs with these settings, or None. Large pictures go before
    small ones, exact runs before estimates."""
    values = []
    for scene in results.papers:
        runs = [
            run for run in results.of_sweep(sweep)
            if (run.program, run.scene,
                run.config) == (program, scene, chip) and run.done and set(run.set) <= set(settings) and all(
                    run.setting(key) == value for key, value in settings.items())
        ]
        best = max(runs, key=lambda run: (run.size or (0, 0), run.mode == "exact"), default=None)
        values.append(best.get(figure) if best else None)
    return mean(values)


def _fpu(results, paper, program):
    rays, per_area = ([
        swept(results, "fpu-sharing", program, "4x32", {"fpu.tps_per_cluster": tps}, figure) for tps in (1, 4, 8, 16)
    ] for figure in ("mrps", "values.mrps_per_mm2"))
    kept = ratio(rays[2], rays[0])
    if kept is None or None in per_area:
        return _NOT_KNOWN
    best = max(zip(per_area, (1, 4, 8, 16)))[1]
    return kept >= 0.9, (f"{100 * kept:.1f} % of the rays of an FPU for each TP; {per_area[2] / per_area[0]:.1f} times "
                         f"those per mm²; of 1, 4, 8 and 16 TPs, {best} have the most per mm²")


def _special(results, paper, program):
    one, two = (swept(results, "special-unit", program, "1x32",
                      {"chip.tps_per_tm": 64, "special.pipelined": True, "special.units_per_tm": units}, "mrps")
                for units in (1, 2))
    kept = ratio(one, two)
    return _NOT_KNOWN if kept is None else (kept >= 0.95, f"{100 * kept:.1f} % of the rays of two units")


def _rarely(results, paper, program):
    shares = []
    for scene in results.papers:
        run = results.cell(program, scene, "4x32")
        shares.append(ratio(run.get("instructions_by_unit.special"), run.get("instructions")) if run else None)
    share = mean(shares)
    busy = results.mean_of_papers("special.utilisation", program, "4x32")
    return _NOT_KNOWN if share is None or busy is None else (
        share <= 0.02, f"{100 * share:.2f} % of the instructions; the unit is busy in {100 * busy:.0f} % of the cycles")


def _icache(results, paper, program):
    many, few = (swept(results, "icache-banks", program, "4x32", {"icache.banks": banks}, "mrps") for banks in (32, 16))
    lost = swept(results, "icache-banks", program, "4x32", {"icache.banks": 16}, "cause_percent.icache_bank_conflict")
    kept = ratio(few, many)
    if kept is None or lost is None:
        return _NOT_KNOWN
    return kept >= 0.95, f"{100 * kept:.1f} % of the rays of 32 banks; conflicts take {lost:.1f} % of the thread-cycles"


def _dcache_banks(results, paper, program):
    two, eight = (swept(results, "dcache-banks", program, "4x32", {"dcache.tps_per_bank": tps}, "mrps")
                  for tps in (2, 8))
    kept = ratio(eight, two)
    return _NOT_KNOWN if kept is None else (kept >= 0.95, f"{100 * kept:.1f} % of the rays of a bank for each 2 TPs")


def _dcache_bytes(results, paper, program):
    now, twice = (swept(results, "dcache-bytes", program, "8x32", {"dcache.bytes": size}, "values.bytes_per_ray")
                  for size in (16384, 32768))
    kept = ratio(twice, now)
    return _NOT_KNOWN if kept is None else (kept < 1,
                                            f"32 kB for 16: {100 * (1 - kept):.0f} % fewer bytes a ray on 8x32")


def _lanes(results, paper, program):
    if not tried(results, program):
        return _NOT_KNOWN
    used, best = lanes_in_use(results)
    if used is None:
        return _NOT_KNOWN
    return 0.61 <= used <= 0.86, f"{100 * used:.0f} % of the lanes of warps of 32, by the best program: {best}"


def _simd(results, paper, program):
    return judged(results) if tried(results, program) else _NOT_KNOWN


def _peak(results, paper, program):
    found = []
    for chip, wanted in (("1x32", 9), ("1x48", 13), ("1x64", 17)):
        run = next((run for scene in results.papers if (run := results.cell(program, scene, chip)) and run.done), None)
        if run is None:
            return _NOT_KNOWN
        keys = ("chip.tps_per_tm", "fpu.tps_per_cluster", "fpu.adders_per_cluster", "fpu.multipliers_per_cluster",
                "special.units_per_tm")
        tps, cluster, adders, multipliers, special = values = [run.setting(key) for key in keys]
        if None in values or not cluster:
            return _NOT_KNOWN
        found.append((-(-tps // cluster) * (adders + multipliers) + special, wanted))
    return all(ours == wanted for ours, wanted in found), ", ".join(f"{ours:.0f}" for ours, _ in found)


ASSERTIONS = [
    ("A TM's operations per cycle", "the same: adders, multipliers and FPDIV/iSQRT of a TM of 32, 48 and 64 TPs",
     "9, 13 and 17", _peak),
    ("Eight TPs share an FPU", "on 4x32 at least 90 % of the rays of an FPU for each TP", "found sufficient", _fpu),
    ("FPDIV/iSQRT are rarely used", "at most 2 % of the instructions, mean of the scenes on 4x32",
     "described, no figures", _rarely),
    ("One FPDIV/iSQRT unit serves up to 64 TPs", "on a TM of 64 TPs at least 95 % of the rays of two units",
     "described, no figures", _special),
    ("16 banks for the instructions of 16 TPs", "on 4x32 at least 95 % of the rays of 32 banks",
     "no large negative impact", _icache),
    ("A bank of the data cache for each 8 TPs", "on 4x32 at least 95 % of the rays of a bank for each 2 TPs",
     "the appropriate choice", _dcache_banks),
    ("A larger data cache takes pressure off the memory", "fewer bytes a ray on 8x32 with twice the cache", "likely",
     _dcache_bytes),
    ("Lanes in use on a SIMD machine",
     "between the figures that the paper quotes for a ray tracer on a GTX 280: warps of 32, primary and shadow rays",
     "61 to 86 %", _lanes),
    ("Pure SIMD is not the most efficient architecture", RULE_OF_SIMD, "described, no figures", _simd),
]
