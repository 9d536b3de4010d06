#!/usr/bin/env python3
"""Do the tests of warps notice a wrong engine? Each mutant is a rule of docs/simt.md changed in one line of
emulator/simt. The changed file is compiled and linked into the tests, before the library.

    mutants.py [SCRATCH] [--build build] [--only EXPRESSION]
    mutants.py --stale             only lists texts that are not there
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from mutation import ROOT, Mutant, failure, main, relinked  # noqa: E402

SOURCE = ROOT / "emulator/simt"
SECONDS = 15
TESTS = {"simt-rules-test": [],
         "timing-engines-test": ["--engine", "simt", "--seed", "7001", "--count", "12", "--stop"]}

# File below emulator/simt/, what stands there once, what the mutant has instead.
MUTANTS = [
    ("choice.c", "return tm->lane[a].depth > tm->lane[b].depth;", "return tm->lane[a].depth < tm->lane[b].depth;"),
    ("choice.c", "return tm->ref->tp[a].pc < tm->ref->tp[b].pc;", "return tm->ref->tp[a].pc > tm->ref->tp[b].pc;"),
    ("choice.c", "if (tm->ref->tp[lane].pc != pc)", "if (tm->ref->tp[lane].pc != pc || warp->group)"),
    ("choice.c", ".waited >= tm->ref->config->simt.patience;", ".waited > tm->ref->config->simt.patience;"),
    ("choice.c", "    lane->waited = 0;\n", ""),
    ("choice.c", "    lane->depth += calls;\n", ""),
    ("choice.c", "cost = waits ? part : 1;", "cost = 1;"),
    ("choice.c", "has_turn ? part_of_patience(tm) : 0;", "has_turn;"),
    ("choice.c", "if (warp->turns_left && warp->running & trax_simt_bit(warp->turns_lane))", "if (warp->turns_left)"),
    ("fetch.c", " || warp->uncharged != warp->group)", ")"),
    ("fetch.c", "return lane / tm->ref->config->icache.tps_per_cache;", "return lane * 0;"),
    ("fetch.c", "trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_ICACHE_BANK);", ";"),
    ("fetch.c", "trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_MEMORY_QUEUE);", ";"),
    ("operands.c", "warp->active = warp->has_operands ? warp->left : 0;",
     "warp->active = warp->left & warp->uncharged;"),
    ("operands.c", "passes = check(tm, warp, i, t) && passes;", "passes = check(tm, warp, i, t);"),
    ("operands.c", "if (warp->is_checked && !*waits_for)", "if (warp->is_checked)"),
    ("resources.c", "i < kind->per_group && asks & ~won;", "i < 1 && asks & ~won;"),
    ("resources.c", "  set &= tm->warp[winner / tm->ref->config->simt.width].group;\n", ""),
    ("resources.c", "while (is_load(first) && set) {", "while (set) {"),
    ("resources.c", "if (lane->address / 4 == first->address / 4)", "if (lane->address / 64 == first->address / 64)"),
    ("resources.c", "if (lane->address / 4 == first->address / 4)", "if (0)"),
    ("resources.c", "{asks & ~before, asks & before};", "{asks, 0};"),
    ("accounting.c", "*pointer = (winner - first + 1) % n;", "*pointer = (winner - first) % n;"),
    ("accounting.c", "const uint64_t bubble = ends <= since ? since : ends < t ? ends : t;",
     "const uint64_t bubble = since + 0 * ends;"),
    ("accounting.c", "tp->ended ? TRAX_CAUSE_HALTED : TRAX_CAUSE_DIVERGENCE", "TRAX_CAUSE_DIVERGENCE"),
    ("accounting.c", "trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_LOCKSTEP);",
     "trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_DIVERGENCE);"),
    ("accounting.c", "stats->broadcast_loads += (tm->broadcast & bit) != 0;", "stats->broadcast_loads += 0;"),
]


def noticed(folder, build, mutant):
    """The first test that fails."""
    programs = relinked(folder, build, "emulator/CMakeFiles/traxemu.dir/simt", SOURCE / mutant.file,
                        mutant.changed(SOURCE), TESTS)
    failures = (failure(SECONDS, program, *TESTS[program.name]) for program in programs)
    return [said for said in failures if said][:1]


if __name__ == "__main__":
    sys.exit(main(__doc__, SOURCE, [Mutant(*row) for row in MUTANTS], noticed))
