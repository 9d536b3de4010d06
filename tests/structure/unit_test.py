"""A shared unit is a row: unit.patch adds one for float comparisons, with configuration, statistics, area, energy, both
engines and pages, and changes a few files. unit_test.py SCRATCH (patched.py has made it)

The engines must agree with the unit on random machines. The unit's figures for a small program must follow from the
program. Both pages must be those of the patched sources."""

import sys

from patched import Patched

TPS, GROUP, LATENCY, AREA, NJ = 32, 16, 4, 0.000722, 0.000536
CHIP = [f"chip.tps_per_tm={TPS}"]
UNIT = ["compare.units_per_group=1", f"compare.tps_per_group={GROUP}", f"compare.latency_cycles={LATENCY}",
        "compare.pipelined=false"]


def check_statistics(unit):
    """Of a program with a loop of fadd, fsub, fmin and others."""
    before = unit.statistics("mix", CHIP)
    stats = unit.statistics("mix", CHIP + UNIT)
    same = unit.statistics("mix", CHIP + UNIT, "--engine", "reference")
    compares, compare = stats["instructions_by_operation"]["fmin"], stats["compare"]
    unit.check(compares > 0 and compare["operations"] == compares, f"{compare} of {compares} comparisons")
    unit.check(before["compare"] == {"utilisation": 0, "operations": 0}, f"without the unit: {before['compare']}")
    adders = [figures["fp_add"]["operations"] for figures in (before, stats)]
    unit.check(adders[0] == adders[1] + compares, f"adders: {adders}")
    conflicts = [figures["causes"]["compare_conflict"] for figures in (before, stats)]
    unit.check(conflicts[0] == 0 < conflicts[1], f"conflicts: {conflicts}")
    share = compares * LATENCY / stats["cycles"] / (TPS // GROUP)
    unit.check(abs(compare["utilisation"] - share) < 1e-9, f"utilisation {compare['utilisation']}, by hand {share}")
    area = 0.64 + 0.63 * TPS / 16 + TPS // GROUP * AREA
    unit.check(abs(stats["area_mm2"] - area) < 1e-9, f"area {stats['area_mm2']}, by hand {area}")
    unit.check(abs(stats["energy"]["fp_compare"] - compares * NJ * 1e-9) < 1e-18, f"energy {stats['energy']}")
    for group in ("causes", "compare", "cycles"):
        unit.check(stats[group] == same[group], f"{group}: {stats[group]}, with the reference {same[group]}")


def main():
    unit = Patched("unit.patch", most_files=5)
    unit.engines_agree(UNIT, 10)  # policy_test.py compares machines of any keys, those of the unit among them
    check_statistics(unit)
    return unit.end()


if __name__ == "__main__":
    sys.exit(main())
