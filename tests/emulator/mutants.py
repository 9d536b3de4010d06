#!/usr/bin/env python3
"""Do the tests of what explains a run notice a wrong line of emulator/explain? Each mutant is linked into trax-sim.

    mutants.py [SCRATCH] [--build build] [--jobs N] [--only EXPRESSION]
    mutants.py --stale             only lists texts that are not there
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from mutation import ROOT, Mutant, failure, main, relinked  # noqa: E402

SOURCE = ROOT / "emulator/explain"
PYTHON = pathlib.Path(sys.executable)
SECONDS = 60  # of a processor
TESTS = ("explain", "explain_programs", "rays", "memory", "races")
FIRST = {"clocks": "races", "races": "races", "ray_kinds": "rays", "memory_check": "memory", "memory_heap": "memory",
         "memory_shadow": "memory"}  # by file: the test that is tried first; else that of the row, or "explain"

# File of emulator/explain, text, what it becomes; some with the test that is tried first.
MUTANTS = [
    # Waits: by the instruction that wrote the register last, and its object.
    ("waits.c", "other += other < end && *other == index;", "other += 1;", "explain_programs"),
    ("waits.c", "record->awaited == wanted.awaited && record->object == wanted.object",
     "record->awaited == wanted.awaited"),
    ("waits.c", "slow >= SLOW_ACCESS};", "false};", "explain_programs"),
    ("waits.c", "waits->hits_are_awaited || written->accessed->outcome", "written->accessed->outcome"),
    ("waits.c", "if (!passage->misses && !waits->hits_are_awaited)", "if (!waits->hits_are_awaited)"),
    ("waits.c", "charged->rd ? &writers[charged->rd] : &itself", "&itself"),
    ("waits.c", "own->at < charged->at)", "own->at <= charged->at)"),
    ("waits.c", "written->of_piece += written->piece++->count;", "written->piece++;"),
    ("waits.c", "    record->cycles[BANK] += counts->others;", "    ;"),
    # The tally: each instruction of a passage once, with its own refusals and the accesses of each region.
    ("tally.c", "    slot->executed[piece->index + piece->count]--;\n", ""),
    ("tally.c", "slot->others[i] - slot->accesses[i].others};", "slot->others[i]};"),
    ("tally.c", ".others = others - slot->accesses[index].others};", ".others = others};"),
    ("tally.c", "      some &= ((uint64_t)1 << 8 * (count - i)) - 1;", "      ;"),
    ("tally.c", "some >> TRAX_REFUSED_SHIFT & low);", "some & low);"),
    ("tally.c", "  tally->ended[tally->ended_count++] = ended;\n  clear_accesses(slot, index);",
     "  tally->ended[tally->ended_count++] = ended;"),
    ("tally.c", "if (accessed < end && accessed->at == at)", "if (accessed < end)", "explain_programs"),
    # The reading: in the order of the chip, each passage once, on any number of threads.
    ("reading.c", "    explain->end_pcs[passage->thread] = passage->next_pc;\n", "    (void)explain;\n",
     "explain_programs"),
    ("reading.c", "!atomic_compare_exchange_strong(&reading->tallied, &begin, end)",
     "!(atomic_store(&reading->tallied, end), true)",
     "explain_programs"),
    ("reading.c", "atomic_exchange(&task->taken, true))", "atomic_load(&task->taken))"),
    ("reading.c", "    reading->has_further |= passage->context >= TRAX_TALLY_CONTEXTS;\n", ""),
    # Passages: what the engine takes back is forgotten.
    ("passages.c", "    passages->logs[tm].now = passages->logs[tm].kept;\n", "    (void)tm;\n", "explain_programs"),
    ("passages.c", "    log->charged[i].at -= count;\n", ""),
    ("passages.c", ".at >= stretch->count)", ".at > stretch->count)"),
    ("passages.c", "charged->at < at + piece->count; charged++)", "charged->at <= at + piece->count; charged++)"),
    ("passages.c", "    log->charged_count = passages->charged_count[i]; /* a log does not become smaller */\n", ""),
    # Spans and the end of the run.
    ("explain.c", "    explain->open_threads[thread].cycles[cause] += cycles;\n", ""),
    ("explain.c", "  cycles[TRAX_CAUSE_ISSUED]++;\n", ""),
    ("explain.c", "    log->charged[i].index = index;\n", "    (void)index;\n", "explain_programs"),
    ("explain.c", "issue->outcome != TRAX_OUTCOME_HIT,", "false,"),
    # Profiles: call stacks, and whose a charge is.
    ("profile.c", "inst.rd && passage->next_pc != pc + 4)", "inst.rd)"),
    ("profile.c", "index = trax_passage_index(passage, charged->at - 1u);", ";"),
    ("profile.c", "      of = thread->latest_context;\n", ""),
    ("profile.c", "profile->record_count >= MAX_RECORDS || ", "", "explain_programs"),
    # Heat, traces, rays.
    ("heat.c", "      count(local, op, 0, -counts->outcomes[outcome]);\n", ""),
    ("heat.c", "address >> LINE_SHIFT & (LINES_PER_PAGE - 1)", "address >> LINE_SHIFT & (LINES_PER_PAGE / 2 - 1)",
     "explain_programs"),
    ("trace.c", "flags & TRAX_IS_BRANCH && issue->next_pc != issue->pc + 4", "flags & TRAX_IS_BRANCH"),
    ("ray_kinds.c", "    thread->working = TRAX_NO_RAY;\n", ""),
    ("ray_kinds.c", "  to->local_loads -= sum_of(loads);\n", ""),
    # Races: the same bytes, not ordered.
    ("races.c", "!is_ordered && it->mask & own.mask && is_race", "!is_ordered && is_race"),
    ("races.c", "word->atomic == ATOMIC && first->write && !second->write;", "word->atomic == ATOMIC && first->write;"),
    ("races.c", "  else if (past_cache)\n    trax_clocks_load", "  else if (0)\n    trax_clocks_load"),
    ("clocks.c", "  it->clock[thread]++;\n", ""),
    ("clocks.c", "  if (both)\n    join_release(clocks, sum->clock, release);\n", ""),
    # The check of memory.
    ("memory_check.c", "span->inst.op == TRAX_OP_LB && value.undefined & 0x80", "0"),
    ("memory_check.c", "bytes == 4 ? value->tag : MEMORY_NO_TAG", "value->tag"),
    ("memory_check.c", "  if (base->undefined)\n    note_undefined(check, span, MEMORY_ADDRESS, base);\n", ""),
    ("memory_heap.c", "it->begin == pointer.bits && !it->freed)", "!it->freed)"),
    ("memory_heap.c", "cleared ? bytes : 0);", "0);"),
    ("memory_heap.c", "  if (!it || it->freed || it->reached)\n", "  if (!it || it->reached)\n"),
    ("memory_shadow.c", "(at >= undefined || check->fresh[number])", "true"),
]


def words_of(test, programs, build):
    """The arguments of a test, as CMakeLists.txt gives them; programs: a folder like bin/."""
    sim, built = programs / "trax-sim", build / "tests/emulator"
    return {"explain": [sim, built / "calls.elf", built / "deep.elf", build / "tests/bin/emulator-programs"],
            "rays": [sim, built / "rays.elf"], "explain_programs": [programs]}.get(test, [programs, ROOT])


def noticed(folder, build, mutant):
    """The first test that fails."""
    sim = next(relinked(folder, build, "emulator/CMakeFiles/traxemu.dir/explain/", SOURCE / mutant.file,
                        mutant.changed(SOURCE), ["bin/trax-sim"]))
    for beside in [build / "lib", build / "share", *(build / "bin").iterdir()]:
        place = folder / beside.relative_to(build)
        if not place.exists():
            place.symlink_to(beside)
    first = mutant.case or FIRST.get(pathlib.Path(mutant.file).stem)
    for test in sorted(TESTS, key=lambda test: test != first):
        if failure(SECONDS, PYTHON, "-B", HERE / f"{test}_test.py", *words_of(test, sim.parent, build)):
            return [test]
    return []


if __name__ == "__main__":
    sys.exit(main(__doc__, SOURCE, [Mutant(*row[:3], case="".join(row[3:])) for row in MUTANTS], noticed))
