"""File below emulator/, what stands there once, what the mutant has instead; of some, the test that is tried first."""

MUTANTS = [
    # --- Words ---
    ("reference/accounting.c", "*pointer = position + 1 < n ? position + 1 : 0;", "*pointer = position;"),
    ("reference/accounting.c", "const uint32_t position = *pointer + i < n ? *pointer + i : *pointer + i - n;",
     "const uint32_t position = i;"),
    ("reference/accounting.c", "else if (t < tp->bubble_ends)", "else if (t + 1 < tp->bubble_ends)"),
    # --- Fetch ---
    ("reference/fetch.c", "return tp->pc / 4 %", "return tp->pc / 8 %"),
    ("reference/fetch.c", "port < tm->config->icache.ports_per_bank", "port < 1"),
    ("reference/fetch.c", "return tp->number / tm->config->icache.tps_per_cache;",
     "return tp->number % tm->config->icache.tps_per_cache;"),
    ("reference/fetch.c", "return !tp->charged && !tp->holds && !tp->awaits_line;",
     "return !tp->charged && !tp->awaits_line;"),
    ("reference/fetch.c", "  if (trax_ref_on_its_way(tm, INSTRUCTION_LINE, icache, line)) {",
     "  if (0) {"),
    ("reference/fetch.c", "icache_of(tm, tp) == icache && line_of(tm, tp) == line", "line_of(tm, tp) == line"),
    ("reference/fetch.c", "trax_ref_charge(tm, tp, t, TRAX_CAUSE_MEMORY_QUEUE);",
     "trax_ref_charge(tm, tp, t, TRAX_CAUSE_ICACHE_MISS);"),
    ("reference/lines.c", "line_bytes * ways)", "line_bytes)"),
    ("reference/lines.c", "return line & (lines->sets - 1)", "return line / lines->ways & (lines->sets - 1)"),
    # --- Operands ---
    ("reference/operands.c", "{trax_ref_is(tp, TRAX_READS_RD | TRAX_WRITES_RD), tp->inst.rd}",
     "{trax_ref_is(tp, TRAX_READS_RD), tp->inst.rd}"),
    ("reference/operands.c", "if (tp->scoreboard[number].usable > t) {",
     "if (tp->scoreboard[number].usable > t + 1) {"),
    ("reference/operands.c", "if (trax_ref_is(tp, TRAX_WRITES_RD) && tp->inst.rd != 0)",
     "if (trax_ref_is(tp, TRAX_WRITES_RD))"),
    ("reference/operands.c", "if (trax_ref_active(tp) && trax_ref_accesses_memory(tp))",
     "if (tp->holds && !tp->ended && trax_ref_accesses_memory(tp))"),
    ("reference/operands.c", "n < operands[i].count", "n < operands[i].count && n < 1"),
    ("reference/operands.c", "(operands[i].first + n) % TRAX_NUM_REGISTERS", "(operands[i].first + n) % 16"),
    # --- Units ---
    ("reference/operands.c", " || trax_lacks_unit(tp->inst.op, tm->config);", ";"),
    ("reference/units.c", "if (group->free_from[unit] > t)", "if (group->free_from[unit] > t + 1)"),
    ("reference/units.c", "t + trax_ref_timing(tm, tp)->interval", "t + 1 + trax_ref_timing(tm, tp)->interval"),
    ("reference/units.c", "unit < kind->per_group; unit++", "unit < kind->per_group && unit < 1; unit++"),
    # The table, which both engines read: tests with numbers of their own notice.
    ("machine/units.h", "X(FP_COMPARE, FP_ADD, TRAX_IS_COMPARE, C->fpu.compare_units ?",
     "X(FP_COMPARE, FP_ADD, TRAX_IS_COMPARE, !C->fpu.compare_units ?"),
    ("machine/units.h", "C->ray.box_latency_cycles, C->ray.box_interval_cycles",
     "C->ray.triangle_latency_cycles, C->ray.box_interval_cycles"),
    ("machine/units.h", "C->ray.triangle_latency_cycles, C->ray.triangle_interval_cycles",
     "C->ray.triangle_latency_cycles, C->ray.box_interval_cycles"),
    ("machine/units.h", "X(FP_ADD, FP_ADD, TRAX_IS_FLOP, TRAX_SHARED_FP_ADD,",
     "X(FP_ADD, FP_ADD, TRAX_IS_FLOP, TRAX_SHARED_FP_MUL,"),
    ("machine/units.h", "trax_or(C->fpu.mul_tps_per_cluster, C->fpu.tps_per_cluster)", "C->fpu.tps_per_cluster"),
    ("machine/units.h", "C->special.pipelined ? 1 : C->special.latency_cycles", "1"),
    ("machine/units.h", "\n    trax_or(C->special.rsqrt_latency_cycles, C->special.latency_cycles),",
     "\n    C->special.latency_cycles,"),
    ("machine/units.h", "C->fpu.convert_latency_cycles, 1, DATA_OTHER", "C->fpu.compare_latency_cycles, 1, DATA_OTHER"),
    ("machine/units.h", "C->int_mul.latency_cycles, 1, DATA_OTHER", "C->int_mul.latency_cycles, 1, DATA_SPECIAL"),
    ("reference/issue.c", "tp->bubble_ends = t + 1 + tm->config->tp.branch_bubble_cycles;",
     "tp->bubble_ends = t + tm->config->tp.branch_bubble_cycles;"),
    ("reference/issue.c", "if (tp->pc != pc + 4) {", "if (trax_ref_is(tp, TRAX_IS_BRANCH)) {"),
    ("reference/issue.c", "t + tm->config->tp.local_latency_cycles", "t + tm->config->tp.int_latency_cycles"),
    # --- Data cache ---
    ("reference/data_cache.c", "!trax_ref_is(tp, TRAX_IS_NONTEMPORAL | TRAX_IS_ATOMIC);",
     "!trax_ref_is(tp, TRAX_IS_ATOMIC);"),
    ("reference/data_cache.c", "tm->tp[i].address / 4 % banks == bank", "tm->tp[i].address / 64 % banks == bank"),
    ("reference/data_cache.c", "(tm->tps + per_bank - 1) / per_bank", "tm->tps / per_bank + 1"),
    ("reference/data_cache.c", "  if (request) {\n    tm->stats->dcache_merged++;",
     "  if (0) {\n    tm->stats->dcache_merged++;"),
    ("reference/data_cache.c", "trax_ref_lines_on_their_way(tm, DATA_LINE) == tm->config->dcache.mshrs",
     "trax_ref_lines_on_their_way(tm, DATA_LINE) > tm->config->dcache.mshrs"),
    ("reference/data_cache.c", "if (reg->line == request->line) {", "if (true) {"),
    ("reference/data_cache.c", "trax_ref_result(tp, UNKNOWN, TRAX_CAUSE_DATA_MISS);",
     "trax_ref_result(tp, UNKNOWN, TRAX_CAUSE_DATA_HIT);"),
    # --- Stores and write combining ---
    ("reference/stores.c", "begin <= tp->run_end &&", "begin < tp->run_end &&"),
    ("reference/stores.c", "end >= tp->run_begin;", "end > tp->run_begin;"),
    ("reference/stores.c", "begin / BLOCK == tp->run_begin / BLOCK &&", ""),
    ("reference/stores.c", "tp->run_end = greatest(tp->run_end, end);", "tp->run_end = greatest(tp->run_begin, end);"),
    ("reference/stores.c", "if (tp->run_begin != tp->run_end && !request_write", "if (!request_write"),
    # --- Memory queue ---
    ("reference/queue.c", "tm->queue_pointer = (tp->number + 1) % tm->tps;",
     "tm->queue_pointer = (tm->queue_pointer + 1) % tm->tps;"),
    ("reference/queue.c", "if (tm->places > taken)", "if (tm->places >= taken)"),
    ("reference/queue.c", "if (request.bytes < tm->config->memory.min_transfer_bytes)", "if (0)"),
    ("reference/queue.c", "if (tm->places == tm->config->memory.queue_depth)",
     "if (tm->places > tm->config->memory.queue_depth - 2)"),
    ("reference/queue.c", "if (trax_ref_ends_thread(tp) || ", "if (tp->inst.op == TRAX_OP_HALT || "),
    ("reference/queue.c", "atomic ? tm->config->memory.atomic_bytes : 4", "atomic ? 8 : 4"),
    # --- Fences ---
    ("reference/fences.c", "request->tp == tp->number && ", ""),
    ("reference/fences.c", "(request->kind == ATOMIC && trax_ref_fences(tp, TRAX_FENCE_RW))",
     "(request->kind == ATOMIC && trax_ref_fences(tp, TRAX_FENCE_W))"),
    ("reference/fences.c", "(request->kind == WRITE && trax_ref_fences(tp, TRAX_FENCE_W))",
     "(request->kind == WRITE && trax_ref_fences(tp, TRAX_FENCE_RW))"),
    ("reference/fences.c", "if (!trax_ref_fences(tp, TRAX_FENCE_R))", "if (!trax_ref_fences(tp, TRAX_FENCE_RW))"),
    ("reference/fences.c", "tm->queue[i].passing = tm->queue[i].kind == DATA_LINE;", "tm->queue[i].passing = false;"),
    ("reference/lines.c", "lines->line[i].present = false;", "lines->line[i].present &= i == 0;"),
    ("reference/data_cache.c", "if (!request->passing) {\n", "{\n"),
    ("reference/data_cache.c", "if (request && request->passing)\n", "if (false)\n"),
    ("reference/operands.c", "for (unsigned rd = 1; rd < TRAX_NUM_REGISTERS; rd++)",
     "for (unsigned rd = TRAX_NUM_REGISTERS - 1; rd > 0; rd--)"),
    ("reference/queue.c", " || trax_ref_fences(tp, TRAX_FENCE_W))\n", ")\n"),
    # --- Memory controller ---
    ("reference/controller.c", "channel->free_from > t * cycle ? channel->free_from : t * cycle",
     "channel->free_from > t * cycle ? t * cycle : channel->free_from"),
    ("reference/controller.c", "(channel->free_from + cycle - 1) / cycle", "channel->free_from / cycle"),
    ("reference/controller.c", "((trax_ref_units)t + 1) * chip", "(trax_ref_units)t * chip"),
    ("reference/controller.c", "request->old_value + 1", "request->old_value + 2"),
    ("reference/run.c", "return trax_ref_buses_idle(chip, t);", "return t > 0 || trax_ref_buses_idle(chip, t);"),
    ("reference/controller.c", "!other->in_dram && other->channel == channel && other->came < first) {",
     "!other->in_dram && other->channel == channel && other->came > first) {"),
    ("reference/controller.c", "trax_ref_increment(chip, request, over) + config->memory.atomic_latency_cycles;",
     "trax_ref_increment(chip, request, over);"),
    ("reference/controller.c", "(config->l2.bytes ? config->l2.latency_cycles : 0)", "config->l2.latency_cycles"),
    ("reference/controller.c", "(uint64_t)config->chip.clock_mhz * config->memory.channels;",
     "config->chip.clock_mhz;"),
    # --- Second-level cache ---
    ("reference/l2.c", "request->completion = t + chip->config->l2.latency_cycles;",
     "request->completion = t + chip->config->l2.latency_cycles + 1;"),
    ("reference/l2.c", "} else if (request->kind == LOAD_PAST_CACHE) {", "} else if (0) {"),
    ("reference/l2.c", "} else if (l2->misses == chip->config->l2.mshrs) {",
     "} else if (l2->misses >= chip->config->l2.mshrs - 1) {"),
    ("reference/l2.c", "  if (trax_ref_lines_use(&chip->l2.lines, line)) /* updated in place */",
     "  if (trax_ref_lines_have(&chip->l2.lines, line)) /* updated in place */"),
    ("reference/l2.c", "miss->channel < first->channel ||", "miss->channel > first->channel ||", "timing-engines-test"),
    ("reference/l2.c", "address / config->l2.line_bytes % config->l2.banks", "address / 64 % config->l2.banks"),
    ("reference/lines.c", "if (places[way].used < places[least].used)", "if (places[way].used > places[least].used)"),
    ("reference/lines.c", "  if (found)\n    found->used = ++lines->uses;\n", ""),
    # --- Faults ---
    ("reference/faults.c", "if (fault->kind && fault->thread < thread)", "if (fault->kind)"),
    ("reference/faults.c", "if (pc % 4 != 0)", "if (pc % 2 != 0)"),
    ("reference/faults.c", "trax_ref_is(tp, TRAX_IS_STORE | TRAX_IS_ATOMIC));\n}\n\nvoid",
     "trax_ref_is(tp, TRAX_IS_STORE));\n}\n\nvoid"),

    # --- the fast engine: arbiters ---
    ("fast/time/masks.h",
     "const trax_fast_pair among = preferred | (requesters & ~((have - (have >> to_first)) | have));",
     "const trax_fast_pair among = (preferred & ~have) | requesters;"),
    ("fast/time/grant.h", "trax_arbiter_grant(&unit->arbiter[group], all, kind->per_group)",
     "trax_arbiter_grant(&unit->arbiter[group], all, 1)"),
    ("fast/time/alone.c", "    trax_arbiter_to_back(&unit->arbiter[group], number);", "    (void)unit;",
     "timing-engines-test"),
    # --- steps 1 and 2 ---
    ("fast/time/cycle.c", "return (woken & tm->holding) | recheck;", "return (woken & tm->holding) | (recheck & 0);"),
    ("fast/time/cycle.c",
     "step |= (uint16_t)(TRAX_STEP_BANK | tp->address / 4 % tm->dcache.banks << TRAX_STEP_BANK_SHIFT);",
     "step |= (uint16_t)(TRAX_STEP_BANK | tp->address / 8 % tm->dcache.banks << TRAX_STEP_BANK_SHIFT);"),
    ("fast/time/cycle.c", "tm->busy_registers[number] &= ~waits;", "tm->busy_registers[number] = 0;"),
    ("fast/time/cycle.c", "if (inst->resource == TRAX_RESOURCE_END || ", "if ("),
    # --- steps 3 and 4 ---
    ("fast/time/grant.h", "const unsigned pointer = tm->queue_arbiter % 64;", "const unsigned pointer = 0;"),
    ("fast/time/grant.h", "tm->load_hits & ~tm->executes_at_issue & ~", "tm->load_hits & ~"),
    ("fast/time/grant.h", "stores = won & tm->storing & *slow;", "stores = 0;"),
    ("fast/time/grant.h", "if (!trax_tp_stores(tp, load) ||", "if ("),
    ("fast/time/grant.h", "store_hits += count_bits(served & tm->load_hits)", "store_hits += count_bits(served)"),
    # One that combines takes effect at once: not before a head that executes at issue, a burst's end, or a reader.
    ("fast/time/grant.h", "at_once = tm->buffer && !(tm->ready & tm->executes_at_issue)", "at_once = tm->buffer"),
    ("fast/time/grant.h", "if (at_once && tm->heads.at[number] < tm->heads.last[number] &&", "if (at_once &&"),
    ("fast/time/grant.h", "trax_fast_find_readers(tm, store->address, bit))) {", "0)) {"),
    ("fast/time/grant.h", "(requesters & (requesters - 1)) || unit->free_from)", "(requesters & (requesters - 1)))"),
    ("fast/time/grant.h", "  trax_arbiter_to_back(&unit->arbiter[trax_first(requesters) / unit->kind.group_size], "
     "trax_first(requesters));\n", ""),
    # Banks one after the other: of many data banks, and of instruction caches of any shape.
    ("fast/time/grant.h", "here & *rr_mask ? here & *rr_mask : here,", "here,", "timing-engines-test"),
    ("fast/time/grant.h", "*rr_mask = -2 * winner;", "(void)rr_mask;", "timing-engines-test"),
    ("fast/time/cycle.c", "rest & trax_group_mask(icache, config->icache.tps_per_cache), ", "rest, "),
    ("fast/time/cycle.c", "config->icache.ports_per_bank);", "1);"),
    ("fast/time/grant.h", "if (!tm->serial_hits)", "if (1)"),
    # Whether the next load's line is resident: after arrivals, evictions and fences.
    ("fast/time/cycle.c", "      trax_fast_find_line(tm, tp);", "      (void)tm;"),
    ("fast/time/cycle.c", "^ line) & tags->set_mask))", "^ line)))"),
    ("fast/tm/tp.c", "    tm->load_hits = 0;", "    (void)tm;", "timing-engines-test"),
    # --- step 5 and the heads ---
    ("fast/time/issue.h", "if (latency > 1) {", "if (latency > 2) {"),
    ("fast/time/issue.h", "tp->atomics |= (uint64_t)1 << inst->rd;", "tp->atomics |= (uint64_t)1 << inst->ra;"),
    ("fast/function/burst_steps.h", "(program->timing[index].waits & (uint32_t)tp->atomics)", "0"),
    ("fast/tm/tm.c", "tm->tp[request->tp].begin_reg[request->rd] = request->value", "request->value"),
    ("fast/time/head.c", "tp->alone && tp->atomics ? 0 : ", ""),
    ("fast/time/head.h", "tm->heads.address[tp] = tm->tp[tp].burst.access[load].address;",
     "tm->heads.address[tp] = tm->tp[tp].burst.access[0].address;"),
    ("fast/time/issue.h", "tm->heads.at[number] < last || tp->ends_slowly", "tm->heads.at[number] < last"),
    ("fast/time/heads.h", "heads->at[__builtin_ctzll(who)] + 1u", "heads->at[__builtin_ctzll(who)]"),
    ("fast/create.c", "machine->calls.before_write = trax_fast_range_written;", "machine->calls.before_write = NULL;"),
    ("fast/function/blocks.c", "if (trax_fast_is_loaded(&chip->blocks, address)) {", "if (0) {"),
    ("fast/function/blocks.h", "*block = *block < state ? state : *block;", "*block = state & 0;"),
    ("fast/function/blocks.h", "    blocks->input_bytes = 0;", "    (void)blocks;"),
    ("fast/function/blocks.h", "address - blocks->input < blocks->input_bytes;\n}", "false;\n}"),
    # --- the core, for the fast engine ---
    ("fast/tm/tm.c", "if (!trax_queue_has_place(&tm->queue))", "if (0)"),
    ("fast/tm/tm.c", "trax_arbiter_to_back(&tm->queue_arbiter, tp);",
     "trax_arbiter_to_back(&tm->queue_arbiter, tp - 1);"),
    ("fast/tm/tm.c", "if (tm->tp[tp].asleep_until > t)", "if (tm->tp[tp].asleep_until > t + 64)"),
    ("fast/tm/dcache.c", "trax_arbiter_to_back(&tm->queue_arbiter, number);", ""),
    ("fast/time/grant.h", "trax_fast_head_timing(tm, trax_first(winner))->decoded->op",
     "trax_fast_head_timing(tm, trax_first(all))->decoded->op"),
    ("fast/time/grant.h", "if (free_from[i] <= t)", "if (free_from[i] <= t + 1)"),
    ("fast/memory/memory.c", "const bool busy = channel->free_from.cycle >= t;",
     "const bool busy = false;"),
    ("fast/memory/memory.c", "return channel->free_from.cycle <= t;",
     "return channel->free_from.cycle < t + !channel->free_from.units;"),
    ("fast/tm/icache.c", "icache->pending[i].waiting |= bit;", "icache->pending[i].waiting = bit;"),
    ("fast/tm/cache_tags.h", "(way + 1) & (tags->ways - 1)", "way & (tags->ways - 1)"),
    # --- Fences ---
    ("fast/tm/tp.c", "if (kind & TRAX_FENCE_R)", "if (kind == TRAX_FENCE_R)"),
    ("fast/tm/tp.c", "all ? n : groups[i].first + n", "all ? TRAX_NUM_REGISTERS - 1 - n : groups[i].first + n"),
    ("fast/tm/tm.c", "tp->increments || (of_writes && tp->writes)", "of_writes && (tp->increments || tp->writes)"),
    ("fast/tm/tm.c", "if (of_writes && !write_run(tm, number))", "if (!write_run(tm, number))"),
    ("fast/tm/tm.c", ".kind = TRAX_REQUEST_WRITE, .tp = (uint8_t)number, ", ".kind = TRAX_REQUEST_WRITE, "),
    ("fast/tm/dcache.c", "dcache->mshr[i].passing = 1;", "dcache->mshr[i].passing = i == 0;"),
    ("fast/tm/dcache.c", "if (!dcache->mshr[i].passing) {\n", "{\n"),
    ("fast/tm/dcache.c", "if (dcache->mshr[i].passing)\n        return false;\n", ""),
    ("fast/tm/cache_tags.h", "memset(tags->lines, 0, places * sizeof", "memset(tags->lines, 0, places / 2 * sizeof"),
    ("fast/state.c", "dcache->mshr, dcache->mshr_limit);", "dcache->mshr, 0);"),
    ("fast/function/program.c", "return ~1u;", "return ~3u;"),
    ("fast/time/cycle.c", " || inst->resource == TRAX_RESOURCE_FENCE)\n", ")\n"),
    # --- More of the fast engine, by rule ---
    # Stores combine within a block of 64 bytes.
    ("fast/tm/tp.h", "address / COMBINING_BLOCK != tp->run_begin / COMBINING_BLOCK ||",
     "(address / COMBINING_BLOCK | 1) != (tp->run_begin / COMBINING_BLOCK | 1) ||"),
    # A store that touches the run's end combines.
    ("fast/tm/tp.h", "address > tp->run_end ||", "address >= tp->run_end ||"),
    # A store that touches the run's begin combines.
    ("fast/tm/tp.h", "address + bytes < tp->run_begin)", "address + bytes <= tp->run_begin)"),
    # The first unusable register gives the cause.
    ("fast/tm/tp.c", "{tp->inst->wait_ra, tp->inst->more_ra + 1u}, {tp->inst->wait_rb, tp->inst->more_rb + 1u}",
     "{tp->inst->wait_rb, tp->inst->more_rb + 1u}, {tp->inst->wait_ra, tp->inst->more_ra + 1u}"),
    # All registers of a group must be usable.
    ("fast/function/program.c", "n <= decoded->more_ra; n++", "n < decoded->more_ra; n++"),
    ("fast/function/program.c", "(decoded->wait_rb + n) % TRAX_NUM_REGISTERS", "(decoded->wait_rb + n) % 16"),
    ("machine/text.c", "(trax_group_b(flags) - 1) & 15 : 0", "(trax_group_b(flags) - 2) & 15 : 0"),
    ("machine/text.c", "if (trax_lacks_unit(inst.op, config))", "if (0)"),
    # The special units have one round robin.
    ("fast/time/grant.h", "trax_arbiter_grant(&unit->arbiter[group], all & ~winners, 1)",
     "trax_arbiter_grant(&(trax_arbiter){unit->arbiter[group]}, all & ~winners, 1)"),
    # When a TM goes back, so do they.
    ("fast/state.c", "unit->free_from, trax_shared_unit_count(unit));", "unit->free_from, 0);"),
    # As many operations are accepted as units are free.
    ("fast/time/grant.h", "i < kind->per_group && all & ~winners;",
     "i < kind->per_group && i < 1 && all & ~winners;"),
    # The winner goes to the back.
    ("fast/tm/arbiter.h", "(uint8_t)((winner + 1) & 63)",
     "(uint8_t)(winner & 63)"),
    # A load needs a free miss register.
    ("fast/tm/dcache.c", "dcache->mshr_count == dcache->mshr_limit ||",
     "dcache->mshr_count + (dcache->mshr_limit > 1) == dcache->mshr_limit ||"),
    # A line under way is merged with, whichever it is.
    ("fast/tm/dcache.c", "if (dcache->mshr[i].line == line) {",
     "if (dcache->mshr[i].line == line && i < 3) {"),
    # A load that took a place moves the queue's turn.
    ("fast/tm/dcache.c", "  trax_arbiter_to_back(&tm->queue_arbiter, number);\n  return true;",
     "  (void)number;\n  return true;"),
    # The latency of a hit.
    ("fast/tm/dcache.c", "t + tm->config->dcache.hit_latency_cycles, TRAX_CAUSE_DATA_HIT",
     "t + 1, TRAX_CAUSE_DATA_HIT"),
    # A load into r0 waits for nobody.
    ("fast/tm/dcache.c", "  if (rd == TRAX_NO_REGISTER)\n    return;",
     "  if (rd == TRAX_NO_REGISTER && number != 1)\n    return;"),
    # A fetch without a place is charged to the queue.
    ("fast/tm/icache.c", "trax_tm_charge(tm, tp, TRAX_CAUSE_MEMORY_QUEUE);",
     "trax_tm_charge(tm, tp, TRAX_CAUSE_ICACHE_MISS);"),
    # Fetches of a line under way are merged.
    ("fast/tm/icache.c", "tm->stats->icache_merged++;",
     "tm->stats->icache_misses++;"),
    # A line serves all that wait for it.
    ("fast/tm/icache.c", "tm->holding |= icache->pending[i].waiting;",
     "tm->holding |= icache->pending[i].waiting & -icache->pending[i].waiting;"),
    # Round robin over the TMs.
    ("fast/memory/memory.c", "  trax_arbiter_to_back(&waiting->arbiter, number);\n",
     ""),
    # A transfer takes bytes / B cycles.
    ("fast/memory/memory.c", ": 0) + request->bytes * memory->units_per_byte",
     ": 0) + (request->bytes + 3) / 4 * 4 * memory->units_per_byte"),
    # The latency is added to every transfer.
    ("fast/memory/memory.c", "+ memory->latency;",
     "+ memory->latency + (request->kind == TRAX_REQUEST_WRITE);"),
    # A place is taken until the completion.
    ("fast/tm/queue.h", "queue->count < queue->depth;",
     "queue->count < queue->depth && queue->started < 40;"),
    # The peak is the largest count.
    ("fast/tm/queue.h", "> queue->peak)",
     "> queue->peak + 1)"),
    # A short transfer costs min_transfer_bytes.
    ("fast/tm/tm.c", "request.bytes < tm->config->memory.min_transfer_bytes",
     "request.bytes < tm->config->memory.min_transfer_bytes && request.kind != TRAX_REQUEST_WRITE"),
    # Combined stores are counted.
    ("fast/tm/tm.c", "tm->stats->combined_stores++;",
     "tm->stats->combined_stores += tp->inst->bytes == 4;"),
    # The run becomes the union.
    ("fast/tm/tp.h", "tp->run_begin = address < tp->run_begin ? address : tp->run_begin;",
     "tp->run_begin = tp->run_begin;"),
    # The TP that took a place moves the queue's turn.
    ("fast/tm/tm.c", "  trax_tm_request(tm, request);\n  trax_arbiter_to_back(&tm->queue_arbiter, tp);",
     "  trax_tm_request(tm, request);\n  (void)tp;"),
    # An atomic increment costs atomic_bytes.
    ("fast/tm/tm.c", ".bytes = atomic ? tm->config->memory.atomic_bytes : tp->inst->bytes",
     "  .bytes = tp->inst->bytes"),
    # A wait for an atomic increment has its own cause.
    ("fast/tm/tm.c", "atomic ? TRAX_CAUSE_DATA_ATOMIC : TRAX_CAUSE_DATA_MISS",
     "TRAX_CAUSE_DATA_MISS"),
    # The first TP's fault is reported, of several.
    ("fast/tm/tm.c", "tm->fault.kind && tm->fault.tp < number",
     "tm->fault.kind && tm->fault.tp > number"),
    # A store past the cache does not look into it.
    ("fast/tm/tm.c", "if (tp->inst->is_nontemporal) {",
     "if (!tp->inst->bytes) {"),
    # Sleepers wake in their cycle, however long they sleep.
    ("fast/tm/tm.c", "if (tm->tp[tp].asleep_until > t)",
     "if (tm->tp[tp].asleep_until > t + 1)"),
    # A thread is halted from the cycle after its end.
    ("fast/tm/tp.c", "trax_tm_end_thread(tm, number, t + 1, (int32_t)value);",
     "trax_tm_end_thread(tm, number, t, (int32_t)value);"),
    # The bank of an instruction.
    ("machine/text.c", "pc / 4 % config->icache.banks",
     "pc / 8 % config->icache.banks"),
    # The run ends when the bus is idle.
    ("fast/chip.c", "idle_from > *t + 1 ? idle_from : *t + 1;",
     "idle_from ? *t + 1 : *t + 1;"),
    # Data that arrive in t are used in t.
    ("fast/time/cycle.c", "trax_queue_oldest(&tm->queue)->completion <= t;",
     "trax_queue_oldest(&tm->queue)->completion < t;"),
    # Losers of a fetch are charged.
    ("fast/time/cycle.c", "refused->fetch = losers;",
     "refused->fetch = losers & ~tm->awaiting & ~(losers >> 63 << 63);"),
    # Loads and stores past the cache ask for no bank.
    ("fast/time/cycle.c", "else if (inst->is_nontemporal || inst->is_atomic)\n      step",
     "else if (inst->is_atomic)\n      step"),
    # A pc that is not a multiple of 4 is misaligned.
    ("fast/time/cycle.c", "pc % 4 ? TRAX_FAULT_MISALIGNED_PC : TRAX_FAULT_EXECUTE",
     "TRAX_FAULT_EXECUTE"),
    # Losers of integer multipliers are charged.
    ("fast/time/grant.h", "return requesters & ~winners;",
     "return requesters & ~winners & ~(requesters & -requesters);"),
    # A cycle with any loser is counted.
    ("fast/time/cycle.c", "refused.fetch | tm->ready;", "refused.fetch != 0;"),
    ("fast/time/cycle.c", "refused.fetch | tm->ready;", "tm->ready != 0;"),
    # A refused access is charged to the queue.
    ("fast/time/grant.h", "trax_tm_charge(tm, number, refused);\n    return false;",
     "return false;"),
    # Counters of refusals are charged before they overflow.
    ("fast/time/masks.h", "++counts->cycles == UINT8_MAX;", "++counts->cycles == UINT8_MAX + 2;"),
    ("fast/time/heads.h", "(at >= check_at)", "(at > check_at)"),
    # Round robin of banks.
    ("fast/time/masks.h", "-(*(WINNERS) + *(WINNERS)) |",
     "-*(WINNERS) |"),
    # Round robin of units in even groups.
    ("fast/time/masks.h", "(requested_groups & ~(winners | (winners - first)))",
     "(requested_groups & ~(winners - first))"),
    # The bubble after a taken branch.
    ("fast/time/issue.h", "t + 1 + bubble, TRAX_CAUSE_BRANCH",
     "t + bubble, TRAX_CAUSE_BRANCH"),
    # Effects happen in the TPs' order.
    ("fast/time/issue.h", "(effects = slow & tm->executes_at_issue) != 0",
     "(effects = 0) != 0"),
    # The latency of local memory.
    ("fast/time/issue.h", "latency = tm->config->tp.local_latency_cycles;\n    cause",
     "latency = 1;\n    cause"),
    # Stores are noted before others may see them.
    ("fast/time/issue.h", "if (!tm->buffer)\n      trax_fast_word_written",
     "if (!tm->buffer && inst->bytes > 1)\n      trax_fast_word_written"),
    # A store of the TM itself calls back the bursts that have loaded the word.
    ("fast/time/issue.h", "else if (inst->is_store)\n      trax_fast_roll_back_readers",
     "else if (inst->is_store && 0)\n      trax_fast_roll_back_readers"),
    # Arrived increments are forgotten.
    ("fast/time/head.c", "tp->atomics &= ~(rest & -rest);",
     "tp->atomics = 0;"),
    # Instructions that a burst has not issued did not happen.
    ("fast/time/head.c", "    tp->jumps -= next != trax_fast_index(tp, i) + 1;",
     "(void)next;"),
    # A line that was replaced is not there.
    ("fast/time/head.c", "trax_fast_set_resident(tm, number, evicted - 1, false);",
     "(void)tm;"),
    # Lines of programs of more than 64 may be missing, too.
    ("fast/time/head.c", "if (!trax_fast_is_resident(tm, icache, at))",
     "if (tm->chip->program.lines <= 64 && !trax_fast_is_resident(tm, icache, at))"),
    ("fast/time/head.c", "at <= line[(steps < count - i ? steps : count - i) - 1]; at++)", "at <= line[0]; at++)"),
    # Heads whose line has gone are looked at again.
    ("fast/time/head.c", "      tm->uncertain |= (uint64_t)1 << tp;",
     "      tm->uncertain |= 0;"),
    # And from then on.
    ("fast/time/head.c", "      tm->heads.check_at[tp] = 0;\n",
     ""),
    # A head in another line is looked at,
    ("fast/time/head.c", "      if ((step->pc & -line_bytes) != line)\n        break;\n",
     ""),
    ("fast/time/head.c", "leaves = next_line < stop;",
     "leaves = false;"),
    # one that needs a register,
    ("fast/time/head.c", "!(step->waits & busy)",
     "!(step->waits & busy & 0xFFFF)"),
    # and one behind a head that was not fetched in this cycle.
    ("fast/time/head.c", "if (fetched || !uncertain || next < tm->heads.check_at[number])",
     "if (fetched || true)"),
    # A new burst may begin with any of these.
    ("fast/time/head.c", "(tm->busy | tm->uncertain) & bit ? 0 : NO_CHECK;",
     "NO_CHECK;"),
    # Which instruction a step is.
    ("fast/function/burst.c", "program->number + index,", "program->number + index + (at > 90),"),
    # Steps are near the first one.
    ("fast/function/burst_steps.h", "if (index - first + TRAX_REACH > 2 * TRAX_REACH)", "if (0 && first)",
     "timing-translated-test"),
    ("translate/burst.c", "if (t->count > TRAX_REACH)", "if (0)", "timing-translated-test"),
    # Round robin of units by bytes.
    ("fast/time/masks.h", "TRAX_FAST_ARBITRATE(groups, (groups *)&units->rr_masks, (groups)requesters, &winners);",
     "trax_fast_pair all = {-1, -1};\n    TRAX_FAST_ARBITRATE(groups, (groups *)&all, (groups)requesters, &winners);"),
    # A write calls back those who have run ahead.
    ("fast/function/blocks.c", "if (trax_fast_is_loaded(&chip->blocks, address)) {\n    trax_fast_roll_back",
     "if (trax_fast_is_loaded(&chip->blocks, address) && address % 16) {\n    trax_fast_roll_back"),
    # Bursts that load from written blocks are watched, in every word, and in every epoch.
    ("fast/function/burst.c", "tm->watched[number] |= (uint64_t)1 <<", "tm->watched[number] |= (uint64_t)0 <<"),
    ("fast/function/burst.c", "tm->readers[trax_fast_line_hash(address)] |= (uint64_t)1 << number;", ";"),
    ("fast/function/blocks.c", "any |= (tp->burst.access[i].address & ~3u) == word;",
     "any |= tp->burst.access[i].address == word;"),
    ("fast/function/blocks.c", "if ((tp->burst.access[i].address & ~3u) == word && !trax_tp_stores(tp, i))",
     "if (tp->burst.access[i].address == word && !trax_tp_stores(tp, i))"),
    ("fast/function/blocks.c", "    if (!(tm->watched[trax_first(rest)] >> line % 64 & 1))", "    if (true)"),
    ("fast/function/blocks.c", "tm->heads.load[number] - (tm->heads.load[number] > 0)", "tm->heads.load[number]"),
    ("fast/function/blocks.c", "i = tm->heads.load[number]; i < end", "i = tm->heads.load[number] + 1u; i < end"),
    ("fast/function/blocks.c", "i < chip->tms; i++)\n    trax_fast_roll_back_readers(&chip->tm[i], address, 0);",
     "i < 1; i++)\n    trax_fast_roll_back_readers(&chip->tm[i], address, 0);"),
    ("fast/function/blocks.c", "      if (chip->tm[i].watched[tp])\n", "      if (0)\n"),
    ("fast/merge.c", "  trax_fast_record_readers(tm);\n", ""),
    ("fast/function/burst.c", "if (!*line || (*line)->number != address / TRAX_OVERLAY_BYTES) {", "if (!*line) {"),
    ("fast/function/blocks.c", "if (!line || line->number != address / TRAX_OVERLAY_BYTES)", "if (!line)"),
    # Stores of bursts: their words are not loaded again; at their issue they take effect, in order; others roll back.
    ("fast/function/burst.c", "if (has_stored(tp, address, load))", "if (has_stored(tp, address, load) && 0)"),
    ("fast/function/burst.c", "!((tp->burst.access[i].address ^ address) & ~3u)",
     "tp->burst.access[i].address == address"),
    ("fast/function/burst.c", "  if (!tp->again) {", "  if (true) {"),
    ("fast/function/burst.c", "tm->watched[number] = tp->stored = 0;", "tm->watched[number] = 0;",
     "timing-translated-test"),
    ("fast/function/blocks.c", "    trax_fast_roll_back_readers(tm, address, bit);\n", ""),
    ("fast/function/blocks.c", "i < chip->tms; i++)\n    trax_fast_roll_back_readers(&chip->tm[i], address, &",
     "i < 1; i++)\n    trax_fast_roll_back_readers(&chip->tm[i], address, &"),
    ("fast/function/blocks.c", "if (trax_fast_is_loaded(&chip->blocks, address))\n    return false;", ""),
    ("fast/time/head.c", "tp->alone || tp->stored ? bit : 0", "tp->alone ? bit : 0"),
    ("fast/time/issue.h", "    trax_fast_roll_back_tp(tm, number);\n    return false;", "    return false;"),
    ("fast/time/issue.h", "return tm->heads.at[number] < tm->heads.last[number];", "return true;"),
    ("fast/time/alone.c", "(trax_tp_stores(tp, load) &&", "(0 &&"),
    ("fast/function/burst.c", "tp->burst.access[load].word = value;", "tp->burst.access[load % 4].word = value;"),
    # Local memory is as it was.
    ("fast/function/blocks.c", "memcpy(tp->local + (undo->address - TRAX_LOCAL_BASE), &undo->word",
     "memcpy(&tp->begin_reg[TRAX_NO_REGISTER], &undo->word"),
    # Records of translated bursts.
    ("translate/burst.c", "  run->burst->undo_begin = TRAX_BURST + 1;\n", "", "timing-translated-test"),
    ("translate/burst.c", "(uint32_t)(TRAX_BURST - count)", "(uint32_t)(TRAX_BURST + 32 - count)"),
    ("translate/burst.c", "lines |= (uint64_t)1 << t->bursts->line[i] % 64;", "lines |= 1;"),
    ("translate/burst.c", "  if (t->bursts->slow_jump) {", "  if (t->bursts->slow_jump > 1) {"),
    ("translate/sequence.c", "t->bursts && inst->imm == 4", "t->bursts && inst->imm == 5"),
    ("translate/instruction.c", "value += t->bursts->step[index] | t->bursts->slow_local;",
     "value += t->bursts->step[index];"),
    ("translate/instruction.c", "value += t->bursts->bank_mask;", "value += t->bursts->bank_mask & ~16u;"),
    ("translate/templates.c", "  return state <= TRAX_BLOCK_LOADED;", "  return true;"),
    ("translate/templates.c", "        record_undo(address & ~3u,", "        record_undo(address & ~1u,"),
    ("fast/function/burst.c", "    if (run.pc == program->timing[end].pc) { /* no jump */", "    if (0) {"),
    ("fast/function/burst.c", "      tp->burst.jumps++;", "      (void)tp;"),
    ("fast/function/burst.c", ".input_bytes = chip->blocks.input_bytes}",
     ".input_bytes = chip->machine->space.input_bytes}"),
    # A misaligned load ends a burst.
    ("fast/function/burst_steps.h", "    if (address & (BYTES - 1))",
     "    if (0)"),
    # Blocks that are written are not loaded ahead.
    ("fast/function/burst_steps.h", "if (state > last_loadable)",
     "if (state > last_loadable && 0)"),
    # A burst that is executed again loads from blocks that are shared meanwhile.
    ("fast/function/burst_steps.h", "limit < TRAX_BURST || alone ? TRAX_BLOCK_SHARED : TRAX_BLOCK_WRITTEN",
     "TRAX_BLOCK_WRITTEN"),
    # A jump with a bubble is not quick.
    ("fast/function/burst_steps.h", "config->tp.branch_bubble_cycles > 0 ? TRAX_STEP_SLOW : 0",
     "config->tp.branch_bubble_cycles > 1 ? TRAX_STEP_SLOW : 0"),
    # The cycle counter ends a burst.
    ("fast/function/program.c", "decoded->imm == TRAX_SR_CYCLE || decoded->imm == TRAX_SR_CYCLEH",
     "decoded->imm == TRAX_SR_CYCLEH"),
    # A TM that has read too early goes back.
    ("fast/merge.c", "if (line->writer[word] == tm)", "if (line->writer[word] == tm || line->writer[word] >= 64)"),
    ("fast/store_buffer.h", "line->read |= trax_overlay_bits(address, bytes)",
     "line->read |= trax_overlay_bits(address, 1)"),
    # A word that several wrote conflicts.
    ("fast/merge.c", "line->writer[word] != writer ? BY_SEVERAL : writer", "0 ? BY_SEVERAL : writer"),
    # The order of two TMs' stores to a byte matters if they differ, and that of a store and an increment in any case.
    ("fast/merge.c", "line->bytes[trax_first(bits)] != own->bytes[trax_first(bits)] ||", "0 ||"),
    ("fast/merge.c", "line->writer[trax_first(bits) / 4] == BY_CONTROLLER)", "0)"),
    # Stores to shared blocks have their order.
    ("fast/function/blocks.h", "if (trax_fast_is_shared(blocks, address))\n    trax_store_buffer_record",
     "if (0)\n    trax_store_buffer_record"),
    # Data that were loaded ahead and are written or incremented are loaded again.
    ("fast/merge.c", "written >> at & BLOCK_BITS &&", "written >> at & 1 && at &&"),
    ("fast/merge.c",
     "    if (trax_fast_is_loaded(&merge->chip->blocks, merge->increments[i]))\n      return false;\n", ""),
    # A block from which bursts have loaded is not shared without their going back.
    ("fast/function/blocks.h",
     "  if (!trax_fast_is_loaded(blocks, address))\n    __atomic_store_n", "  __atomic_store_n"),
    # Stores of a cycle in the TMs' order.
    ("fast/merge.c", "const uint32_t tm = trax_first(rest);\n    struct trax_store_buffer_side *buffer",
     "const uint32_t first = trax_first(rest);\n"
     "    const uint32_t tm = first ^ (order->tms[t - order->begin] >> (first ^ 1) & 1);\n"
     "    struct trax_store_buffer_side *buffer"),
    # Memory is restored.
    ("fast/merge.c", "undo->address, undo->bytes, sizeof undo->bytes);", "undo->address, undo->bytes, 1);"),
    # A miss register of the second-level cache is free again.
    ("fast/memory/l2.c", "    mshr->request.bytes = 0;\n", ""),
    # The controller is restored.
    ("fast/state.c", "VISIT_DERIVED(memory, 1);", "VISIT_DERIVED(memory, 0);"),
    # Increments are noted as writes.
    ("fast/merge.c", "sizeof word), BY_CONTROLLER);", "sizeof word), 0);"),
    # Requests are shown in their cycle.
    ("fast/merge.c", "trax_memory_cycle(memory, chip->tm, t);", "trax_memory_cycle(memory, chip->tm, t + 1);"),
    # An epoch in which a TM stops is given up.
    ("fast/merge.c", "if (tm->buffer->stop || tm->fault.kind)", "if (tm->fault.kind)"),
    # Bursts do not load what others may increment.
    ("fast/function/blocks.h", "__ATOMIC_RELAXED) == TRAX_BLOCK_SHARED", "__ATOMIC_RELAXED) <= TRAX_BLOCK_SHARED"),
    # The write set is that of one epoch.
    ("fast/merge.c", "  trax_overlay_empty(&merge->written);\n", ""),
    # An epoch that is given up has written nothing.
    ("fast/merge.c", "good = !merge->failed && goes_on", "good = goes_on"),
    # Stores take effect at its end, and are seen by their TM before, also in later quanta.
    ("fast/merge.c", "(bytes, line->bytes, line->written);", "(bytes, line->bytes, line->written & 0x11111111);"),
    ("fast/merge.c", "  tm->buffer->side = &tm->buffer->sides[side];",
     "  trax_overlay_empty(&tm->buffer->written);\n  tm->buffer->side = &tm->buffer->sides[side];"),
    # A quantum ahead is of half a latency.
    ("fast/epochs.c", "quantum * epochs->latency / epochs->sides", "quantum * epochs->latency"),
    ("base/pool.c", "round - seen.finished <= 1;", "round - seen.finished <= 2;"),
    # A TM receives what was served, in its quantum, and at the end of the epoch, and wakes for it.
    ("fast/merge.c", "done = 0;\n  trax_tm_receive(tm, side);", "done = 0;\n  trax_tm_receive(tm, 0);"),
    ("fast/merge.c", "  for (unsigned side = 0; side < TRAX_SIDES; side++)\n    trax_tm_receive(tm, side);\n", ""),
    ("fast/tm/tm.c", "    tm->next_cycle = trax_queue_oldest(&tm->queue)->completion;", "    ;"),
    # Requests arrive by their completions, those of one cycle in the order in which they were made.
    ("fast/tm/queue.c", "x->completion < y->completion", "x->completion > y->completion"),
    ("fast/tm/queue.c", "x->number < y->number", "x->number > y->number"),
    # Every part of the snapshot is copied.
    ("machine/snapshot.c", "  return snapshot->count * part / parts;",
     "  return snapshot->count * part / parts - part / 2;"),
    # A TM sees its own stores.
    ("machine/overlay.h", "  old ^= (old ^ new) & trax_overlay_mask(written);", "  old = new;"),
    ("machine/overlay.h", "if (__builtin_expect(bytes == sizeof value, true))", "if (true)"),
    ("machine/overlay.h", "    return written ? new : old;", "    return new;"),
    ("machine/overlay.h", "line->written |= trax_overlay_bits(address, bytes);",
     "line->written |= trax_overlay_bits(address, 1);"),
    # Lines have what each TM stored to them.
    ("machine/overlay.h", "    old ^= (old ^ new) & trax_overlay_mask(bits >> at);", "    old = new;"),
    ("machine/overlay.h", "if (overlay->lines[i - 1].number == number)", "if (true)"),
    # --- DRAM: one module of both engines, so timing-dram-test notices most ---
    ("dram/dram.c", "latest(now, bank->activate_from)", "now"),
    ("dram/dram.c", "latest(rank->activate_from, rank->window_from", "latest(now, rank->window_from"),
    ("dram/dram.c", "rank->window_from[rank->activations % TRAX_DRAM_WINDOW]", "rank->activate_from"),
    ("dram/dram.c", "commands.precharge = latest(now, bank->precharge_from);", "commands.precharge = now;"),
    ("dram/dram.c", "commands.precharge + config->dram.trp);", "commands.precharge);"),
    ("dram/dram.c", "commands.access = latest(now, bank->access_from);", "commands.access = now;"),
    ("dram/dram.c", "latest(commands.access, rank->read_from);", "latest(commands.access, 0 * rank->read_from);"),
    ("dram/dram.c", "channel->last_queue != queue || channel->last_rank != rank_number",
     "channel->last_queue != queue"),
    ("dram/dram.c", "channel->last_queue != queue || channel->last_rank", "channel->last_rank"),
    ("dram/dram.c", "commands->activate + config->dram.tras;", "commands->activate;"),
    ("dram/dram.c", "last_access + config->dram.trtp", "last_access"),
    ("dram/dram.c", "latest(bank->precharge_from, commands->over + config->dram.twr)",
     "latest(bank->precharge_from, commands->over)"),
    ("dram/dram.c", "rank->read_from = commands->over + config->dram.twtr;", ";"),
    ("dram/dram.c", "(uint64_t)(request->bursts - 1) * dram->burst", "0"),
    ("dram/dram.c", "begin = latest(begin, precharge + config->dram.trp);", "begin = latest(begin, precharge);"),
    ("dram/dram.c", "banks[bank].activate_from = begin + config->dram.trfc;", ";"),
    ("dram/dram.c", "if (rank->refresh_due > now)", "if (rank->refresh_due >= now)"),
    ("dram/dram.c", "config->dram.trefi * (i + 1) / ranks", "config->dram.trefi"),
    ("dram/dram.c", "reads && (channel->last_queue == TRAX_DRAM_WRITE || ", "reads && ("),
    ("dram/dram.c", "writes - config->dram.batch_to : 1", "writes : 1"),
    ("dram/dram.c", "channel->overtaken[queue] >= dram->config->dram.cap", "false"),
    ("dram/dram.c", "if (begins < data) {", "if (begins <= data) {"),
    ("dram/dram.c", "chosen ? channel->overtaken[queue] + 1 : 0;", "0;"),
    ("dram/dram.c", "if (now >= first_tick(dram, t + 1))", "if (now > first_tick(dram, t + 1))"),
    ("dram/dram.c", "config->dram.trp + config->dram.trcd + config->dram.tcl;\n    dram->capacity",
     "0;\n    dram->capacity"),
    ("machine/dram_mapping.c", "rest >>= map->bits[i];", "rest >>= 1;"),
    ("machine/dram_mapping.c", "(address + bytes - 1) / burst - address / burst + 1",
     "(bytes + burst - 1) / burst + 0 * address"),
    ("fast/memory/admission.c", "admitted &= ~((uint64_t)1 << tm);", "(void)tm;"),
    ("fast/memory/admission.c", "trax_memory_increment(memory, number, request, t + 1)",
     "trax_memory_increment(memory, number, request, t)"),
    ("fast/memory/memory.c", "channel->unit_free_from = over + memory->unit_interval;",
     "channel->unit_free_from = over;"),
    ("fast/memory/create.c", "return 1 + config->memory.latency_cycles;", "return 2 + config->memory.latency_cycles;"),
    ("dram/dram.c", "dram->channel, config->memory.channels);", "dram->channel, 0);", "timing-state-test"),
    ("dram/dram.c", "channel->bank, config->dram.ranks * config->dram.banks);", "channel->bank, 0);",
     "timing-state-test"),
    ("reference/dram.c", "return (request && request->kind == ATOMIC) ||", "return"),
    ("reference/controller.c", "done + chip->config->memory.atomic_interval_cycles;", "done;"),
    # --- Line fills ---
    ("fast/tm/dcache.c", "(*end > t ? *end : t) + config->dcache.fill_cycles", "t + config->dcache.fill_cycles"),
    ("fast/tm/dcache.c", "i < words && i < dcache->banks; i++", "i < dcache->banks; i++"),
    ("fast/time/grant.h", "trax_first(rest))] > t ?", "trax_first(rest))] > t + 1 ?"),
    ("reference/data_cache.c", "filling ? -1 : ", "filling && !filling ? -1 : "),
    # --- One TP, one thread ---
    ("fast/time/alone.c", "used.data_banks |= (uint64_t)1 << (step >> TRAX_STEP_BANK_SHIFT & 63);", ";"),
    ("fast/time/alone.c", "used.fetch_banks |= (uint64_t)1 << (step >> TRAX_STEP_FETCH_SHIFT);\n    }", "}"),
    ("fast/time/alone.c", "used.fetch_banks |= (uint64_t)1 << (step >> TRAX_STEP_FETCH_SHIFT);\n        tp->pc",
     "tp->pc"),
    ("fast/time/alone.c", "used->kinds |= kinds;", ";"),
    ("fast/time/alone.c", "used->fetch_banks |= fetch_banks;", ";"),
    ("fast/time/alone.c", "busy || uncertain ? 1 : most", "most"),
    ("fast/tm/tm.c", "completion < end)\n    end =", "completion < end)\n    end +="),
    ("fast/tm/tm.c", "if (t + trax_first(rotated) < end)", "if (0)"),
    ("fast/time/alone.c", "tm->tp[number].usable[trax_first(rest)] > t)",
     "tm->tp[number].usable[trax_first(rest)] > t + 1)"),
    ("fast/time/alone.c", "uncertain && (at == next_line", "uncertain && 0 && (at == next_line"),
    ("fast/time/alone.c", "at == next_line || ", "(at == next_line && 0) || "),
    ("fast/time/alone.c", " || is_behind_jump(&tp->burst, at))", ")"),
    ("fast/time/alone.c", "tm->stats->icache_hits += at - first;", "tm->stats->icache_hits += t - begin;"),
    ("fast/time/alone.c", "        tm->now = t;\n", ""),
    ("fast/chip.c", "if (tm->stats->memory_requests != requests)", "if (tm->stats->memory_requests == requests)"),
    ("fast/time/alone.c", "tm->dcache.all_fills_end > t ||", "0 ||"),
    ("fast/time/alone.c", "!trax_queue_has_place(&tm->queue) ||", "0 ||"),
    ("fast/time/alone.c", "tm->now = t; /* of a request */", ";"),
    # Global memory is as it was, in the reverse order, when a thread that is alone has stored ahead.
    ("fast/function/blocks.c", "tp->alone ? tp->burst.load_count : 0", "0"),
    ("fast/function/burst.c", "tp->stores[load / 64] |= (uint64_t)1 << load % 64;\n  memcpy(",
     "tp->stores[0] |= (uint64_t)1 << load % 64;\n  memcpy("),
    ("fast/function/burst.c", "trax_space_check(space, address, bytes, true) ||", "(address & (bytes - 1)) ||"),
    ("fast/chip.c", "  if (chip->alone) /* bursts may have stored */\n    trax_fast_roll_back(chip);", ""),
    ("fast/chip.c", "return !increments;", "return true;"),
    ("fast/chip.c", "transfer < until ? transfer : until", "until"),
    # --- Stretches ---
    ("fast/function/blocks.c", "    tm->observed->told[number] = tm->observed->told_loads[number] = 0;",
     "    (void)0;"),
    ("fast/observe.c", "    tm->tp[number].outcome = *outcome;", "    (void)outcome;"),
    ("fast/time/refusals.h", "    trax_fast_log_refusals(tm, full);", "    (void)full;"),
    ("fast/observe.c", "    trax_fast_log_refusals(tm, (uint64_t)1 << tp);\n    trax_log_charge",
     "    trax_log_charge"),
    ("fast/time/cycle.c", "    record_refusals(tm, wide, granted & tm->observed->tps);\n", ""),
    ("fast/time/refusals.h", "    trax_fast_log_refusals(tm, single);", "    (void)single;"),
    ("fast/observe.c", "    trax_fast_read_charges(tm, number, cycles);", "    memset(cycles, 0, sizeof cycles);"),
    ("fast/epochs.c", "    chip->machine->observer->go_back(chip->machine->observer->context);", "    (void)chip;"),
    ("fast/epochs.c", "  trax_fast_keep(epochs->chip, true);\n", ""),
    ("fast/state.c", "  TRAX_VISIT_DERIVED(tm->observed, tm->observed ? 1 : 0);\n", ""),
    ("fast/time/cycle.c", "tm->serial_hits ? 0 : tm->load_hits & ~tm->storing", "~(uint64_t)0"),
    ("fast/observe.c", "      outcomes[at] = TRAX_FAST_NO_OUTCOME;\n", ""),
    ("fast/observe.c", "  return ~(first | second << 16);", "  return first | second << 16;"),
    ("fast/observe.c", "      some &= ((uint32_t)1 << (count - i)) - 1;", "      (void)count;"),
    ("fast/observe.c", "  if (count > 16)", "  if (count > 17)"),
    ("fast/observe.c", "  if (count > 32)", "  if (count > 48)"),
    ("fast/time/refusals.h", "(63 - __builtin_clzll(in_bursts))", "trax_first(in_bursts)"),
    ("fast/time/refusals.h", "for (uint64_t rest = in_bursts; rest;)",
     "for (uint64_t rest = in_bursts; rest; rest = 0)"),
    ("fast/observe.c", "  return count < 64 ? found & (((uint64_t)1 << count) - 1) : found;", "  return found;"),
    ("fast/time/refusals.h", "((*some & most) == most) | ((*some | most) == UINT8_MAX)", "(*some & most) == most"),
    ("fast/time/refusals.h", "((*some & most) == most) | ((*some | most) == UINT8_MAX)", "(*some | most) == UINT8_MAX"),
    ("fast/time/refusals.h", "- trax_fast_bytes_of(lower >> i);", "- trax_fast_bytes_of(lower);"),
    ("engine/run.c", "    run->engine->tell(run->chip);", "    (void)run;"),
    ("fast/time/issue.h", "trax_fast_tell_steps(tm, number, last + 1, tp->resume_pc);",
     "trax_fast_tell_steps(tm, number, last, tp->resume_pc);"),
    # --- Output ---
    ("fast/merge.c", "  trax_transfer_log_discard(&merge->chip->transfers);\n  merge->printed_count = 0;",
     "  trax_transfer_log_discard(&merge->chip->transfers);"),
    ("fast/epochs.c",
     "  trax_merge_keep(&epochs->merge);\n  epochs->has_snapshot = epochs->chip->transfers.holds = true;",
     "  epochs->has_snapshot = epochs->chip->transfers.holds = true;"),
]
