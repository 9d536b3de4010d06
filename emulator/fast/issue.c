/* Step 5: those who were granted all they asked for issue, in order. */
#include "fast/head.h"

/* A head that has not run ahead: the reference executes it. False if it faulted. */
static bool execute(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  struct trax_fast_tp *ftp = &ftm->tp[number];
  struct trax_tp *tp = &ftm->tm->tp[number];
  const struct trax_decoded *inst = tp->inst;
  const uint32_t pc = tp->pc;
  if ((inst->is_store || inst->is_atomic) && tp->address < TRAX_LOCAL_BASE)
    trax_fast_page_written(ftm->fast, tp->address);
  if (inst->is_atomic)
    ftp->atomics |= (uint64_t)1 << inst->rd;
  if (!trax_tp_execute(ftm->tm, number, t))
    return false;
  ftm->tm->stats->instructions[inst->op]++;
  if (inst->ask != TRAX_ASK_MEMORY)
    trax_tp_set_usable(tp, inst->rd, t + inst->latency, inst->cause);
  else if (tp->address >= TRAX_LOCAL_BASE)
    trax_tp_set_usable(tp, inst->rd, t + ftm->tm->config->tp.local_latency_cycles, TRAX_CAUSE_DATA_LOCAL);
  ftp->resume = tp->pc == pc + 4 ? ftp->head + 1 : trax_fast_inst_at(&ftm->fast->program, tp->pc);
  ftp->resume_pc = tp->pc;
  return true;
}

/* A deferred head, or any if issues are traced. Returns whether the next one is elsewhere than behind it. */
static bool issue_slowly(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_tm *tm = ftm->tm;
  struct trax_fast_tp *ftp = &ftm->tp[number];
  trax_fast_show(ftm, number);
  const struct trax_decoded *inst = ftp->tp->inst;
  const uint32_t pc = ftp->tp->pc;
  if (!(ftm->deferred & bit)) {
    tm->stats->instructions[inst->op]++;
    if (inst->ask != TRAX_ASK_MEMORY || ftp->address >= TRAX_LOCAL_BASE)
      trax_tp_set_usable(ftp->tp, inst->rd, t + ftp->head->latency, ftp->head->cause);
  } else if (!execute(ftm, number, t))
    return false;
  ftp->issued++;
  tm->holding &= ~bit;
  if (tm->machine->trace)
    trax_tm_trace(tm, number, pc, inst, t);
  if (tm->ended & bit)
    return false;
  const bool jumps = trax_fast_advance(ftm, number, t) != pc + 4;
  tm->stats->taken_branches += jumps;
  if (!jumps || !tm->config->tp.branch_bubble_cycles)
    trax_fast_ask_fetch(ftm, number);
  return jumps;
}

void trax_fast_issue(struct trax_fast_tm *ftm, uint64_t granted, uint64_t t) {
  struct trax_tm *const tm = ftm->tm;
  struct trax_fast_tp *const tps = ftm->tp;
  const struct trax_fast_inst *const inst = ftm->fast->program.inst;
  uint64_t *const instructions = tm->stats->instructions;
  const uint32_t bubble = tm->config->tp.branch_bubble_cycles;
  const bool traced = tm->machine->trace;
  uint64_t jumping = 0, done = 0;
  for (uint64_t rest = granted; rest; rest &= rest - 1) {
    const unsigned number = trax_first(rest);
    const uint64_t bit = rest & -rest;
    struct trax_fast_tp *const ftp = &tps[number];
    /* deferred may change under way: a store calls back who has run ahead */
    if (traced || (ftm->deferred & bit) || ftp->next == ftp->count) {
      jumping |= issue_slowly(ftm, number, t) ? bit : 0;
      continue;
    }
    const struct trax_fast_inst *const head = ftp->head;
    const uint32_t pc = head->pc;
    instructions[head->op]++;
    ftp->issued++;
    /* The data cache has seen to its loads' results; usable[TRAX_NO_REGISTER] means nothing. */
    const bool cached = ftp->address - 1 < TRAX_LOCAL_BASE - 1;
    const unsigned rd = cached ? TRAX_NO_REGISTER : head->rd;
    trax_tp_set_usable(ftp->tp, rd, t + head->latency, head->cause);
    done |= bit;
    trax_fast_take_step(ftm, ftp, inst, bit);
    trax_fast_look_ahead(ftm, ftp, number, t);
    const bool jumps = ftp->head->pc != pc + 4;
    tm->stats->taken_branches += jumps;
    jumping |= (uint64_t)jumps << number;
    if (!jumps || !bubble)
      trax_fast_ask_bank(ftp->icache, ftp->head, bit); /* what has been executed can be fetched */
  }
  tm->holding &= ~done;
  if (bubble)
    for (; jumping; jumping &= jumping - 1)
      trax_tm_sleep_until(tm, trax_first(jumping), t, t + 1, t + 1 + bubble, TRAX_CAUSE_BRANCH);
}
