"""A shared unit is a row: unit.patch adds one for float comparisons, with configuration, statistics, area, energy, both
engines and pages, and changes a few files. unit_test.py SCRATCH (patched.py has made it)

The engines must agree with the unit on random machines; what the unit did on a small program must be what that program
has for it; both pages must be those of the patched sources."""

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
    compares = stats["instructions_by_operation"]["fmin"]
    unit.check(compares > 0 and stats["compare"]["operations"] == compares,
               f"{stats['compare']} of {compares} comparisons")
    unit.check(before["compare"] == {"utilisation": 0, "operations": 0}, f"without the unit: {before['compare']}")
    unit.check(before["fp_add"]["operations"] == stats["fp_add"]["operations"] + compares,
               f"adders: {before['fp_add']}, {stats['fp_add']}")
    unit.check(stats["causes"]["compare_conflict"] > 0 == before["causes"]["compare_conflict"],
               f"conflicts: {stats['causes']}")
    share = compares * LATENCY / stats["cycles"] / (TPS // GROUP)
    unit.check(abs(stats["compare"]["utilisation"] - share) < 1e-9,
               f"utilisation {stats['compare']['utilisation']}, by hand {share}")
    area = 0.64 + 0.63 * TPS / 16 + TPS // GROUP * AREA
    unit.check(abs(stats["area_mm2"] - area) < 1e-9, f"area {stats['area_mm2']}, by hand {area}")
    unit.check(abs(stats["energy"]["fp_compare"] - compares * NJ * 1e-9) < 1e-18, f"energy {stats['energy']}")
    for group in ("causes", "compare", "cycles"):
        unit.check(stats[group] == same[group], f"{group}: {stats[group]}, with the reference {same[group]}")


def main():
    unit = Patched("unit.patch", most_files=5)
    for keys in (UNIT, []):  # one machine's unit, and any
        unit.engines_agree(keys, 15)
    check_statistics(unit)
    return unit.end()


if __name__ == "__main__":
    sys.exit(main())
