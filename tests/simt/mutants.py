#!/usr/bin/env python3
"""Do the tests of warps notice a wrong engine? Each mutant is a rule of docs/simt.md changed in one line of
emulator/simt. The changed file is compiled and linked into the tests, before the library.

    mutants.py [SCRATCH] [--build build] [--only EXPRESSION]
    mutants.py --stale             only lists texts that are not there
"""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from mutation import ROOT, Mutant, failure, main, relinked  # noqa: E402

SOURCE = ROOT / "emulator/simt"
SECONDS = 15
TESTS = {"simt-rules-test": [],
         "timing-engines-test": ["--engine", "simt", "--seed", "7001", "--count", "24", "--stop"]}

# File below emulator/simt/, what stands there once, what the mutant has instead.
MUTANTS = [
    ("choice.c", "least = place[i] < least ? place[i] : least;",
     "least = place[i] != NOWHERE && (place[i] > least || least == NOWHERE) ? place[i] : least;"),
    ("choice.c", "least = place[i] < least ? place[i] : least;",
     "least = place[i] >> 32 < least >> 32 ? place[i] : least;"),
    ("choice.c", "    group |= (uint64_t)is_there << i;\n", "    group |= (uint64_t)(is_there && !group) << i;\n"),
    ("choice.c", "tm->place[trax_simt_first(warp->stays)] < warp->others", "true"),
    ("choice.c", "    is_split |= tm->ref->tp[i].pc != pc;\n", ""),
    ("choice.c", "warp->others = is_level ? others : 0;", "warp->others = others;"),
    ("choice.c", "if (warp->issued - warp->waits_from >= tm", "if (warp->issued - warp->waits_from > tm"),
    ("choice.c", "  warp->waits_from = tm->last_issued[longest];\n", ""),
    ("choice.c", "    tm->last_issued[i] = warp->issued;\n", ""),
    ("choice.c", " - ((uint64_t)(int64_t)calls << 32);", ";"),
    ("choice.c", "    tm->place[trax_simt_take(&set)] = NOWHERE;", "    trax_simt_take(&set);"),
    ("choice.c", "warp->issued += is_wait ? part : 1;", "warp->issued += 1;"),
    ("choice.c", "warp->turns_left = part_of_patience(tm);", "warp->turns_left = 1;"),
    ("choice.c", "if (!(warp->running & trax_simt_bit(warp->turns_lane)))", "if (0)"),
    ("fetch.c", " || warp->uncharged != warp->group)", ")"),
    ("fetch.c", "icache = &tm->ref->icache[lane->icache];", "icache = &tm->ref->icache[0];"),
    ("fetch.c", " && lines->uses == fetched->arrivals)", ")"),
    ("fetch.c", "trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_ICACHE_BANK);", ";"),
    ("fetch.c", "trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_MEMORY_QUEUE);", ";"),
    ("operands.c", "warp->active = warp->has_operands ? warp->left : 0;",
     "warp->active = warp->left & warp->uncharged;"),
    ("operands.c", "passes &= check(tm, warp, trax_simt_take(&set), t);",
     "passes = check(tm, warp, trax_simt_take(&set), t);"),
    ("operands.c", "passes &= check_again(tm, warp, trax_simt_take(&set), t);",
     "passes = check_again(tm, warp, trax_simt_take(&set), t);"),
    ("operands.c", "    return check(tm, warp, i, t);", "    return true;"),
    ("operands.c", "    trax_ref_find_address(tm->ref, lane, t);\n", ""),
    ("operands.c", "    *pending &= ~(set & -set);", "    *pending = 0;"),
    ("text.c", "registers(inst->wait_rb, inst->more_rb + 1u)", "registers(inst->wait_rb, 1)"),
    ("text.c", "    return ~1u;", "    return 0;"),
    ("accounting.c", "    tm->lane[i].pending |= writes;\n", ""),
    ("operands.c", "    tm->for_memory |= bit;\n", ""),
    ("run.c", "      else if (request->completion < chip->arrives)", "      else"),
    ("run.c", "        chip->is_waited_for = true;", "        chip->is_waited_for = i == 0;"),
    ("run.c", "return are_running ? next : t;", "return next;"),
    ("run.c", " || !trax_always_free(unit, ref->config);", ";"),
    ("sleep.c", "      next = tm->ref->tp[lane].scoreboard[waits_for].usable;",
     "      next = tm->ref->tp[lane].scoreboard[waits_for].usable + 1;"),
    ("sleep.c", "warp->slept_from = t + 1;", "warp->slept_from = t;"),
    ("sleep.c", "if (has_arrived || t >= warp->wakes) {", "if (t >= warp->wakes) {"),
    ("sleep.c", "return waits_for ? tm->ref->tp[lane].scoreboard[waits_for].cause : TRAX_CAUSE_LOCKSTEP;",
     "return waits_for ? tm->ref->tp[lane].scoreboard[waits_for].cause : TRAX_CAUSE_DIVERGENCE;"),
    ("resources.c", "i < kind->per_group && asks & ~won;", "i < 1 && asks & ~won;"),
    ("resources.c", "  set &= tm->warp[winner / tm->ref->config->simt.width].group;\n", ""),
    ("resources.c", "while (is_load(first) && set) {", "while (set) {"),
    ("resources.c", "if (lane->address / 4 == first->address / 4)", "if (lane->address / 64 == first->address / 64)"),
    ("resources.c", "if (lane->address / 4 == first->address / 4)", "if (0)"),
    ("resources.c", "{asks & ~before, asks & before};", "{asks, 0};"),
    ("accounting.c", "  warp->bubble_ends = bubble_ends;\n", ""),
    ("accounting.c", "const uint64_t bubble = ends <= since ? since : ends < t ? ends : t;",
     "const uint64_t bubble = since + 0 * ends;"),
    ("accounting.c", "tp->ended ? TRAX_CAUSE_HALTED : TRAX_CAUSE_DIVERGENCE", "TRAX_CAUSE_DIVERGENCE"),
    ("accounting.c", "trax_simt_charge(tm, warp, warp->uncharged, t, TRAX_CAUSE_LOCKSTEP);",
     "trax_simt_charge(tm, warp, warp->uncharged, t, TRAX_CAUSE_DIVERGENCE);"),
    ("accounting.c", "    tm->ref->stats->broadcast_loads++;", ""),
]


def noticed(folder, build, mutant):
    """The first test that fails."""
    programs = relinked(folder, build, "emulator/CMakeFiles/traxemu.dir/simt/", SOURCE / mutant.file,
                        mutant.changed(SOURCE), TESTS)
    failures = (failure(SECONDS, program, *TESTS[program.name]) for program in programs)
    return list(itertools.islice(filter(None, failures), 1))


if __name__ == "__main__":
    sys.exit(main(__doc__, SOURCE, [Mutant(*row) for row in MUTANTS], noticed))
