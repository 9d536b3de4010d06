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

/* A head that has: only its time is left. */
static void note_result(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  const struct trax_fast_tp *ftp = &ftm->tp[number];
  const struct trax_fast_inst *head = ftp->head;
  struct trax_tp *tp = &ftm->tm->tp[number];
  ftm->tm->stats->instructions[head->op]++;
  /* The data cache knows about its loads' results; usable[TRAX_NO_REGISTER] means nothing. */
  const bool cached = ftp->address - 1 < TRAX_LOCAL_BASE - 1;
  trax_tp_set_usable(tp, cached ? TRAX_NO_REGISTER : head->rd, t + head->latency, head->cause);
}

void trax_fast_issue(struct trax_fast_tm *ftm, uint64_t granted, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  const uint32_t bubble = tm->config->tp.branch_bubble_cycles;
  uint64_t issued = granted;
  uint64_t taken = 0;
  for (uint64_t rest = granted; rest; rest &= rest - 1) {
    const unsigned number = trax_first(rest);
    const uint64_t bit = rest & -rest;
    const uint32_t pc = ftm->deferred & bit ? tm->tp[number].pc : ftm->tp[number].head->pc;
    if (tm->machine->trace)
      trax_fast_show(ftm, number);
    const struct trax_decoded *inst = ftm->tp[number].head->decoded;
    if (!(ftm->deferred & bit)) {
      note_result(ftm, number, t);
    } else if (!execute(ftm, number, t)) {
      issued &= ~bit;
      continue;
    }
    if (tm->machine->trace)
      trax_tm_trace(tm, number, pc, inst, t);
    if (tm->ended & bit)
      continue;
    const bool jumps = trax_fast_advance(ftm, number, t) != pc + 4;
    taken += jumps;
    if (jumps && bubble)
      trax_tm_sleep_until(tm, number, t, t + 1, t + 1 + bubble, TRAX_CAUSE_BRANCH);
    else
      trax_fast_ask_fetch(ftm, number);
  }
  tm->holding &= ~issued;
  tm->stats->taken_branches += taken;
  trax_fast_count(&ftm->tally[TRAX_CAUSE_ISSUED], issued);
}
