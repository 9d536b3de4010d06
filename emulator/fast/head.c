#include "fast/head.h"

#include <string.h>

/* Forgets the increments whose old values have arrived. */
static void drop_arrived(struct trax_fast_tp *ftp, const struct trax_tp *tp) {
  for (uint64_t rest = ftp->atomics; rest; rest &= rest - 1)
    if (tp->usable[trax_first(rest)] != TRAX_NEVER)
      ftp->atomics &= ~(rest & -rest);
}

void trax_fast_refill(struct trax_fast_tm *ftm, unsigned number) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_fast_tp *ftp = &ftm->tp[number];
  struct trax_fast_slot *slot = &ftm->slot[number];
  struct trax_tp *tp = &ftm->tm->tp[number];
  drop_arrived(ftp, tp);
  unsigned count = 0;
  if (!ftp->atomics) { /* else it might read or overtake what the increment will write */
    ftp->begin = ftp->resume;
    memcpy(ftp->reg, tp->reg, sizeof ftp->reg);
    count = trax_fast_burst(ftm->fast, ftm, number, ftm->fast->burst);
  }
  if (count) {
    ftm->deferred &= ~bit;
    slot->step = ftp->steps;
    slot->last = ftp->steps + count - 1;
  } else {
    ftm->deferred |= bit;
    ftp->only = (struct trax_fast_step){.inst = ftp->resume, .class = TRAX_CLASS_DEFERRED};
    slot->step = slot->last = &ftp->only;
    tp->inst = ftp->resume->decoded;
    tp->pc = ftp->resume_pc;
  }
}

uint32_t trax_fast_advance(struct trax_fast_tm *ftm, unsigned number) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_fast_slot *slot = &ftm->slot[number];
  if (slot->step == slot->last)
    trax_fast_refill(ftm, number);
  else
    slot->step++;
  const struct trax_fast_inst *head = slot->step->inst;
  ftm->want[slot->step->class] |= bit;
  ftm->clear = (ftm->clear & ~bit) | (head->waits & slot->busy ? 0 : bit);
  ftm->same_line &= ~bit;
  return ftm->deferred & bit ? ftm->tm->tp[number].pc : head->pc;
}

void trax_fast_show(struct trax_fast_tm *ftm, unsigned number) {
  const struct trax_fast_step *step = ftm->slot[number].step;
  struct trax_tp *tp = &ftm->tm->tp[number];
  if (ftm->deferred >> number & 1)
    return; /* set when it became the head, and its address since */
  tp->inst = step->inst->decoded;
  tp->pc = step->inst->pc;
  tp->address = step->address;
}
