/* Step 5: those who were granted all they asked for issue, in order. */
#include "fast/head.h"

/* A head that has not run ahead: the reference executes it. False if it faulted. */
static bool execute(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  struct trax_fast_tp *ftp = &ftm->tp[number];
  struct trax_tp *tp = &ftm->tm->tp[number];
  const struct trax_decoded *inst = tp->inst;
  const uint32_t pc = tp->pc;
  if ((inst->is_store || inst->is_atomic) && tp->address < TRAX_LOCAL_BASE)
    trax_fast_block_written(ftm->fast, tp->address);
  if (inst->is_atomic)
    ftp->atomics |= (uint64_t)1 << inst->rd;
  if (!trax_tp_execute(ftm->tm, number, t))
    return false;
  if (inst->ask != TRAX_ASK_MEMORY)
    trax_tp_set_usable(tp, inst->rd, t + inst->latency, inst->cause);
  else if (tp->address >= TRAX_LOCAL_BASE)
    trax_tp_set_usable(tp, inst->rd, t + ftm->tm->config->tp.local_latency_cycles, TRAX_CAUSE_DATA_LOCAL);
  ftm->slot[number].busy |= trax_fast_register_bit(inst->rd);
  ftp->resume = tp->pc == pc + 4 ? ftm->slot[number].step->inst + 1 : trax_fast_inst_at(&ftm->fast->program, tp->pc);
  ftp->resume_pc = tp->pc;
  return true;
}

static inline void note_result(struct trax_fast_tm *ftm, unsigned number, const struct trax_fast_step *step,
                               uint64_t t) {
  const struct trax_fast_inst *inst = step->inst;
  if (inst->latency > 1) {
    trax_tp_set_usable(&ftm->tm->tp[number], step->rd, t + inst->latency, inst->cause);
    ftm->slot[number].busy |= trax_fast_register_bit(step->rd);
  }
}

/* A deferred head, or the last of a burst. Returns whether the next one is elsewhere than behind it. */
static bool issue_slowly(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_tm *tm = ftm->tm;
  const struct trax_tp *tp = &tm->tp[number];
  trax_fast_show(ftm, number);
  const struct trax_decoded *inst = tp->inst;
  const uint32_t pc = tp->pc;
  if (!(ftm->deferred & bit))
    note_result(ftm, number, ftm->slot[number].step, t);
  else if (!execute(ftm, number, t))
    return false;
  tm->stats->instructions[inst->op]++;
  trax_fast_count(&ftm->tally[TRAX_CAUSE_ISSUED], bit);
  tm->holding &= ~bit;
  if (tm->machine->trace)
    trax_tm_trace(tm, number, pc, inst, t);
  if (tm->ended & bit)
    return false;
  const bool jumps = trax_fast_advance(ftm, number) != pc + 4;
  tm->stats->taken_branches += jumps;
  if (!jumps || !tm->config->tp.branch_bubble_cycles)
    trax_fast_ask_fetch(ftm, number);
  return jumps;
}

void trax_fast_issue(struct trax_fast_tm *ftm, uint64_t granted, uint64_t t) {
  struct trax_tm *const tm = ftm->tm;
  uint64_t *const instructions = tm->stats->instructions;
  const uint32_t bubble = tm->config->tp.branch_bubble_cycles;
  uint64_t quick = 0, jumping = 0, slow_jumping = 0, clear = 0, moved = 0;
  for (uint64_t rest = granted; rest; rest &= rest - 1) {
    const unsigned number = trax_first(rest);
    const uint64_t bit = rest & -rest;
    struct trax_fast_slot *const slot = &ftm->slot[number];
    const struct trax_fast_step *const step = slot->step;
    if (__builtin_expect(step == slot->last, false)) {
      slow_jumping |= issue_slowly(ftm, number, t) ? bit : 0;
      continue;
    }
    instructions[step->inst->op]++;
    note_result(ftm, number, step, t);
    const struct trax_fast_inst *const next = step[1].inst;
    slot->step = step + 1;
    ftm->want[step[1].class] |= bit;
    quick |= bit;
    clear |= bit & -(uint64_t)((next->waits & slot->busy) == 0);
    const uint64_t jump = bit & -(uint64_t)(next != step->inst + 1);
    jumping |= jump;
    moved |= bit & -(uint64_t)next->starts_line;
    if (!bubble || !jump)
      trax_fast_ask_bank(slot->icache, next, bit); /* what has been executed can be fetched */
  }
  ftm->clear = (ftm->clear & ~quick) | clear;
  ftm->same_line &= ~(moved | jumping);
  tm->holding &= ~quick;
  trax_fast_count_many(&ftm->tally[TRAX_CAUSE_ISSUED], quick);
  if (jumping)
    tm->stats->taken_branches += (unsigned)__builtin_popcountll(jumping);
  jumping |= slow_jumping;
  if (bubble)
    for (; jumping; jumping &= jumping - 1)
      trax_tm_sleep_until(tm, trax_first(jumping), t, t + 1, t + 1 + bubble, TRAX_CAUSE_BRANCH);
}
