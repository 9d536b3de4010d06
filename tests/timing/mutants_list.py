"""File below emulator/, what stands there once, what the mutant has instead."""

MUTANTS = [
    # --- Words ---
    ("reference/accounting.c", "*turn = position + 1 < n ? position + 1 : 0;", "*turn = position;"),
    ("reference/accounting.c", "const uint32_t position = *turn + i < n ? *turn + i : *turn + i - n;", "const uint32_t position = i;"),
    ("reference/accounting.c", "else if (t < tp->bubble_ends)", "else if (t + 1 < tp->bubble_ends)"),
    # --- Fetch ---
    ("reference/fetch.c", "return tp->pc / 4 %", "return tp->pc / 8 %"),
    ("reference/fetch.c", "port < tm->config->icache.ports_per_bank", "port < 1"),
    ("reference/fetch.c", "return tp->number / tm->config->icache.tps_per_cache;", "return tp->number % tm->config->icache.tps_per_cache;"),
    ("reference/fetch.c", "return !tp->charged && !tp->holds && !tp->awaits_line;", "return !tp->charged && !tp->awaits_line;"),
    ("reference/fetch.c", "  } else if (trax_ref_on_its_way(tm, INSTRUCTION_LINE, icache, line)) {", "  } else if (0) {"),
    ("reference/fetch.c", "icache_of(tm, tp) == icache && line_of(tm, tp) == line", "line_of(tm, tp) == line"),
    ("reference/fetch.c", "trax_ref_charge(tm, tp, t, TRAX_CAUSE_MEMORY_QUEUE);", "trax_ref_charge(tm, tp, t, TRAX_CAUSE_ICACHE_MISS);"),
    ("reference/lines.c", "line_bytes * ways)", "line_bytes)"),
    ("reference/lines.c", "const uint32_t set = line % lines->sets", "const uint32_t set = line / lines->ways % lines->sets"),
    # --- Operands ---
    ("reference/operands.c", "{trax_ref_is(tp, TRAX_READS_RD | TRAX_WRITES_RD), tp->inst.rd}", "{trax_ref_is(tp, TRAX_READS_RD), tp->inst.rd}"),
    ("reference/operands.c", "registers[i].needed && reg->usable > t", "registers[i].needed && reg->usable > t + 1"),
    ("reference/operands.c", "if (trax_ref_is(tp, TRAX_WRITES_RD) && tp->inst.rd != 0)", "if (trax_ref_is(tp, TRAX_WRITES_RD))"),
    ("reference/operands.c", "if (trax_ref_active(tp) && trax_ref_accesses_memory(tp)) {", "if (tp->holds && !tp->ended && trax_ref_accesses_memory(tp)) {"),
    # --- Units ---
    ("reference/units.c", "if (tm->special_free[unit] > t)", "if (tm->special_free[unit] > t + 1)"),
    ("reference/units.c", "config->special.pipelined ? 1 :", "config->special.pipelined ? 2 :"),
    ("reference/units.c", "compares && config->fpu.compare_units ?", "compares ?"),
    ("reference/units.c", "const bool compares = unit == TRAX_UNIT_FP_ADD && !trax_ref_is(tp, TRAX_IS_FLOP);", "const bool compares = unit == TRAX_UNIT_FP_ADD;"),
    ("reference/issue.c", "tp->bubble_ends = t + 1 + tm->config->tp.branch_bubble_cycles;", "tp->bubble_ends = t + tm->config->tp.branch_bubble_cycles;"),
    ("reference/issue.c", "if (tp->pc != pc + 4) {", "if (trax_ref_is(tp, TRAX_IS_BRANCH)) {"),
    ("reference/issue.c", "t + tm->config->tp.local_latency_cycles", "t + tm->config->tp.int_latency_cycles"),
    # --- Data cache ---
    ("reference/data_cache.c", "!trax_ref_is(tp, TRAX_IS_NONTEMPORAL | TRAX_IS_ATOMIC);", "!trax_ref_is(tp, TRAX_IS_ATOMIC);"),
    ("reference/data_cache.c", "tm->tp[i].address / 4 % banks == bank", "tm->tp[i].address / 64 % banks == bank"),
    ("reference/data_cache.c", "(tm->tps + per_bank - 1) / per_bank", "tm->tps / per_bank + 1"),
    ("reference/data_cache.c", "if (trax_ref_on_its_way(tm, DATA_LINE, 0, line)) {", "if (0) {"),
    ("reference/data_cache.c", "trax_ref_lines_on_their_way(tm, DATA_LINE) == tm->config->dcache.mshrs", "trax_ref_lines_on_their_way(tm, DATA_LINE) > tm->config->dcache.mshrs"),
    ("reference/data_cache.c", "if (reg->awaits_line && reg->line == line) {", "if (reg->awaits_line) {"),
    ("reference/data_cache.c", "trax_ref_result(tp, UNKNOWN, TRAX_CAUSE_DATA_MISS);", "trax_ref_result(tp, UNKNOWN, TRAX_CAUSE_DATA_HIT);"),
    # --- Stores and write combining ---
    ("reference/stores.c", "begin <= tp->run_end &&", "begin < tp->run_end &&"),
    ("reference/stores.c", "end >= tp->run_begin;", "end > tp->run_begin;"),
    ("reference/stores.c", "begin / BLOCK == tp->run_begin / BLOCK &&", ""),
    ("reference/stores.c", "tp->run_end = greatest(tp->run_end, end);", "tp->run_end = end;"),
    ("reference/stores.c", "  tp->run_begin = tp->run_end = 0;\n", ""),
    # --- Memory queue ---
    ("reference/queue.c", "tm->queue_turn = (position + 1) % tm->tps;", "tm->queue_turn = (tm->queue_turn + 1) % tm->tps;"),
    ("reference/queue.c", "if (tm->places > taken)", "if (trax_ref_active(tp))"),
    ("reference/queue.c", "if (request.bytes < tm->config->memory.min_transfer_bytes)", "if (0)"),
    ("reference/queue.c", "if (tm->places == tm->config->memory.queue_depth)", "if (tm->places > tm->config->memory.queue_depth - 2)"),
    ("reference/queue.c", "if (trax_ref_ends_thread(tp))", "if (tp->inst.op == TRAX_OP_HALT)"),
    ("reference/queue.c", "atomic ? tm->config->memory.atomic_bytes : 4", "atomic ? 8 : 4"),
    # --- Memory controller ---
    ("reference/controller.c", "channel->free_from > t * cycle ? channel->free_from : t * cycle", "channel->free_from"),
    ("reference/controller.c", "(channel->free_from + cycle - 1) / cycle", "channel->free_from / cycle"),
    ("reference/controller.c", "const uint64_t next = (t + 1) * chip", "const uint64_t next = t * chip"),
    ("reference/controller.c", "request->old_value + 1", "request->old_value + 2"),
    ("reference/run.c", "return trax_ref_buses_idle(chip, t);", "return true;"),
    # --- Faults ---
    ("reference/faults.c", "if (fault->kind && fault->thread < thread)", "if (fault->kind)"),
    ("reference/faults.c", "if (pc % 4 != 0)", "if (pc % 2 != 0)"),
    ("reference/faults.c", "trax_ref_is(tp, TRAX_IS_STORE | TRAX_IS_ATOMIC));\n}\n\nvoid", "trax_ref_is(tp, TRAX_IS_STORE));\n}\n\nvoid"),

    # --- the fast engine: arbiters ---
    ("fast/masks.h", "units->behind = (units->behind & ~asked_groups) | (asked_groups & ~(winners | (winners - first)));", "units->behind = (units->behind & ~asked_groups) | (asked_groups & ~(winners - first));"),
    ("fast/masks.h", "const trax_fast_pair among = preferred | (askers & ~((have - (have >> to_first)) | have));", "const trax_fast_pair among = askers;"),
    ("fast/masks.h", "if (winner)\n      behind =", "if (all)\n      behind ="),
    ("fast/masks.h", "(units->group[i] & ~(winner | (winner - 1)))", "(units->group[i] & ~(winner - 1))"),
    ("fast/cycle.c", "for (uint32_t port = 0; port < ports; port++)", "for (uint32_t port = 0; port < 1; port++)"),
    # --- steps 1 and 2 ---
    ("fast/cycle.c", "return (woken & tm->holding) | taken_up;", "return woken & tm->holding;"),
    ("fast/cycle.c", "asks = (uint16_t)(TRAX_ASKS_BANK | tp->address / 4 % ftm->data_banks << TRAX_ASKS_BANK_SHIFT);", "asks = (uint16_t)(TRAX_ASKS_BANK | tp->address / 8 % ftm->data_banks << TRAX_ASKS_BANK_SHIFT);"),
    ("fast/cycle.c", "ftm->slot[number].busy &= ~ftm->slot[number].step->waits;", "ftm->slot[number].busy = 0;"),
    ("fast/cycle.c", "if (inst->ask == TRAX_ASK_END)\n    asks = TRAX_ASKS_QUEUE;", "if (inst->ask == TRAX_ASK_END)\n    asks = 0;"),
    # --- steps 3 and 4 ---
    ("fast/cycle.c", "const unsigned turn = ftm->tm->queue_turn;", "const unsigned turn = 0;"),
    ("fast/cycle.c", "*hits = there & ~ftm->deferred;", "*hits = there;"),
    ("fast/cycle.c", "    hits = 0; /* serve sees to that */", "    ; /* serve sees to that */"),
    # --- step 5 and the heads ---
    ("fast/issue.c", "if (latency > 1) {", "if (latency > 2) {"),
    ("fast/issue.c", "ftp->atomics |= (uint64_t)1 << inst->rd;", "ftp->atomics |= (uint64_t)1 << inst->ra;"),
    ("fast/head.c", "if (!ftp->atomics) {", "if (1) {"),
    ("fast/blocks.c", "if (*state == TRAX_BLOCK_LOADED)", "if (*state == TRAX_BLOCK_LOADED && 0)"),
    ("fast/blocks.c", "*state = TRAX_BLOCK_WRITTEN;", "*state = 0;"),
    # --- the core, for the fast engine ---
    ("core/tm.c", "if (!trax_queue_has_place(&tm->queue))", "if (0)"),
    ("core/tm.c", "trax_arbiter_to_back(&tm->queue_turn, tp);", "trax_arbiter_to_back(&tm->queue_turn, tp - 1);"),
    ("core/tm.c", "until - t <= TRAX_WHEEL ? until : t + TRAX_WHEEL", "until"),
    ("core/tp.c", "address <= tp->run_end && address + bytes >= tp->run_begin", "address <= tp->run_end && address + bytes > tp->run_begin"),
    ("core/dcache.c", "trax_arbiter_to_back(&tm->queue_turn, number);", ""),
    ("core/unit.c", "unit->free_from[i] = t + unit->interval;", "unit->free_from[i] = t + unit->interval - 1;"),
    ("core/memory.c", "memory->free_from > now ? memory->free_from : now", "now"),
    ("core/icache.c", "icache->pending[i].waiting |= bit;", "icache->pending[i].waiting = bit;"),
    ("core/cache_tags.h", "(tags->next[set] + 1) & (tags->ways - 1)", "tags->next[set] & (tags->ways - 1)"),
]
