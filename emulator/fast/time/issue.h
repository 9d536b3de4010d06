/* Step 5: the TPs that were granted all that they need issue, in order. Included by cycle.c. */
#ifndef TRAX_FAST_ISSUE_H
#define TRAX_FAST_ISSUE_H

#include "fast/store_buffer.h"
#include "fast/time/head.h"

/* Executes a head that executes at issue. False: it faulted. */
static bool execute(struct trax_tm *tm, unsigned number, uint64_t t) {
  struct trax_tp *tp = &tm->tp[number];
  const struct trax_decoded *inst = tp->inst;
  const uint32_t pc = tp->pc, index = trax_fast_head(tm, number);
  if ((inst->is_store || inst->is_atomic) && tp->address < TRAX_LOCAL_BASE) {
    if (!tm->buffer)
      trax_fast_word_written(tm->chip, tp->address, inst->is_atomic ? TRAX_BLOCK_SHARED : TRAX_BLOCK_WRITTEN);
    else if (inst->is_store)
      trax_fast_roll_back_readers(tm, tp->address, 0);
  }
  if (inst->is_atomic && tm->buffer && !trax_fast_is_shared(&tm->chip->blocks, tp->address))
    trax_store_buffer_record(tm->buffer, (struct trax_store_buffer_entry){t, tp->address, 0, TRAX_INCREMENT});
  if (inst->is_atomic)
    tp->atomics |= (uint64_t)1 << inst->rd;
  if (!trax_tp_execute(tm, number, t))
    return false;
  if (inst->resource != TRAX_RESOURCE_MEMORY)
    trax_tp_set_usable(tp, inst->rd, t + inst->latency, inst->cause);
  else if (tp->address >= TRAX_LOCAL_BASE)
    trax_tp_set_usable(tp, inst->rd, t + tm->config->tp.local_latency_cycles, TRAX_CAUSE_DATA_LOCAL);
  trax_fast_set_busy(tm, number, inst->rd);
  const bool goes_on = tp->pc == pc + 4;
  tp->resume = goes_on ? &tm->chip->program.inst[index + 1] : trax_fast_inst_at(&tm->chip->program, tp->pc);
  tp->resume_pc = tp->pc;
  tp->jumps += !goes_on;
  tp->issued++;
  tm->at_issue++;
  tm->count_deltas[index]++;
  tm->count_deltas[index + 1]--;
  if (tm->ray_counts && inst->op == TRAX_OP_TRAP)
    trax_fast_count_rays(tm, number, inst->imm, tp->reg[inst->ra]);
  return true;
}

/* Updates the scoreboard if the result is not usable in the next cycle and does not come from memory. */
static void set_result_usable(struct trax_tm *tm, unsigned number, uint64_t t) {
  const struct trax_decoded *inst = trax_fast_head_timing(tm, number)->decoded;
  uint32_t latency = inst->latency;
  trax_cause cause = (trax_cause)inst->cause;
  if (inst->resource == TRAX_RESOURCE_MEMORY) {
    if (inst->is_store || (tm->heads.low[number] & TRAX_STEP_KIND) == TRAX_STEP_BANK)
      return;
    latency = tm->config->tp.local_latency_cycles;
    cause = TRAX_CAUSE_DATA_LOCAL;
  }
  if (latency > 1) {
    trax_tp_set_usable(&tm->tp[number], inst->rd, t + latency, cause);
    trax_fast_set_busy(tm, number, inst->rd);
  }
}

/* Performs a store of a burst if the head is one, or rolls the TP back so that its head executes at issue. Returns
   whether it was not the last step: then only the next one must become the head. */
static bool store_now(struct trax_tm *tm, unsigned number, uint64_t t) {
  const unsigned load = tm->heads.load[number];
  if ((tm->heads.low[number] & TRAX_STEP_KIND) != TRAX_STEP_BANK || !trax_tp_stores(&tm->tp[number], load))
    return false;
  if (!trax_fast_store(tm, number, load, trax_fast_head_timing(tm, number)->decoded->bytes, t)) {
    trax_fast_roll_back_tp(tm, number);
    return false;
  }
  return tm->heads.at[number] < tm->heads.last[number];
}

/* Tells the observer of a slow head that has been issued; one of stretches when the burst has ended. Without stretches
   a burst has one instruction, so that all heads are slow. */
static void tell_slow(struct trax_tm *tm, unsigned number, uint32_t pc, const struct trax_decoded *inst) {
  const struct trax_tp *tp = &tm->tp[number];
  const bool at_issue = tm->executes_at_issue >> number & 1;
  const unsigned last = tm->heads.last[number];
  if (!tm->observer->stretch) {
    trax_tm_notify_issue(tm, number, pc, inst, tp->resume_pc);
  } else if (at_issue) {
    trax_fast_tell_single(tm, number, pc, inst);
  } else if (tm->heads.at[number] == last) {
    trax_fast_tell_steps(tm, number, last + 1, tp->resume_pc);
    tm->observed->told[number] = tm->observed->told_loads[number] = 0;
  }
}

/* Issues a slow head: one that executes at issue, the last one of a burst, or one with a latency above 1 or a bubble.
 */
static void issue_slowly(struct trax_tm *tm, unsigned number, uint64_t t) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_tp *tp = &tm->tp[number];
  const uint32_t bubble = tm->config->tp.branch_bubble_cycles;
  if ((tm->storing & bit) && store_now(tm, number, t) && !tm->observer) {
    tm->holding &= ~bit;
    trax_fast_set_load(tm, number, tm->heads.load[number] + 1u);
    trax_fast_set_head(&tm->heads, number, tm->heads.at[number] + 1u);
    return;
  }
  if (bubble || (tm->observer && !tm->observer->stretch))
    trax_fast_export_head(tm, number); /* inst, pc, which heads that execute at issue have */
  const struct trax_decoded *inst = tp->inst;
  const uint32_t pc = tp->pc;
  if (tm->executes_at_issue & bit) {
    if (!execute(tm, number, t))
      return;
  } else {
    const unsigned last = tm->heads.last[number];
    if (tm->heads.at[number] < last || tp->ends_slowly)
      set_result_usable(tm, number, t);
    if (tm->heads.at[number] == last)
      trax_fast_end_burst(tm, number, last + 1u, last + 1u);
  }
  tm->holding &= ~bit;
  if (tm->observer)
    tell_slow(tm, number, pc, inst);
  if (tm->ended & bit)
    return;
  trax_fast_advance(tm, number);
  if (bubble && trax_fast_head_timing(tm, number)->pc != pc + 4)
    trax_tm_sleep_until(tm, number, t, t + 1, t + 1 + bubble, TRAX_CAUSE_BRANCH);
}

/* Issues quick heads: the next steps of their TPs become the heads. */
static ALWAYS_INLINE void issue_quickly(struct trax_tm *tm, const bool wide, uint64_t quick) {
  trax_fast_move_on(&tm->heads, wide, quick);
  tm->holding &= ~quick;
}

static void issue_all_quickly(struct trax_tm *tm, uint64_t quick) {
  if (tm->wide)
    issue_quickly(tm, true, quick);
  else
    issue_quickly(tm, false, quick);
}

/* Issues the TPs with quick heads and those with slow heads (TRAX_STEP_SLOW). */
static void issue_in_order(struct trax_tm *tm, uint64_t quick, uint64_t slow, uint64_t t) {
  /* Heads that execute at issue may affect other TPs, so the order of TPs matters: TPs before such a head issue first.
     TPs after it may roll back, and their heads then execute at issue (blocks.c). A store of a burst has its word's
     bank, so that no other TP accesses the word in this cycle. */
  uint64_t effects;
  while (__builtin_expect((effects = slow & tm->executes_at_issue) != 0, false)) {
    const uint64_t up_to = effects ^ (effects - 1);
    issue_all_quickly(tm, quick & up_to);
    quick &= ~up_to;
    for (uint64_t rest = slow & up_to; rest; rest &= rest - 1)
      issue_slowly(tm, trax_first(rest), t);
    const uint64_t back = quick & tm->executes_at_issue;
    quick ^= back;
    slow = (slow & ~up_to) | back;
  }
  issue_all_quickly(tm, quick);
  for (; slow; slow &= slow - 1)
    issue_slowly(tm, trax_first(slow), t);
}

#endif
