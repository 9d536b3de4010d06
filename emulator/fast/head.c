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
  struct trax_tp *tp = &ftm->tm->tp[number];
  drop_arrived(ftp, tp);
  ftp->next = ftp->count = 0;
  if (!ftp->atomics) { /* else it might read or overtake what the increment will write */
    ftp->begin = ftp->resume;
    memcpy(ftp->reg, tp->reg, sizeof ftp->reg);
    ftp->count = trax_fast_burst(ftm->fast, ftm, number, ftm->fast->burst);
  }
  ftm->deferred = (ftm->deferred & ~bit) | (ftp->count ? 0 : bit);
  if (ftp->count)
    return;
  ftp->head = ftp->resume;
  ftp->address = 0;
  tp->inst = ftp->head->decoded;
  tp->pc = ftp->resume_pc;
  ftm->want[TRAX_CLASS_DEFERRED] |= bit;
}

uint32_t trax_fast_advance(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_fast_tp *ftp = &ftm->tp[number];
  if (ftp->next == ftp->count)
    trax_fast_refill(ftm, number);
  if (!(ftm->deferred & bit))
    trax_fast_take_step(ftm, ftp, ftm->fast->program.inst, bit);
  trax_fast_look_ahead(ftm, ftp, number, t);
  return ftm->deferred & bit ? ftp->tp->pc : ftp->head->pc;
}

void trax_fast_show(struct trax_fast_tm *ftm, unsigned number) {
  const struct trax_fast_tp *ftp = &ftm->tp[number];
  struct trax_tp *tp = &ftm->tm->tp[number];
  if (ftm->deferred >> number & 1)
    return; /* set when it became the head, and its address since */
  tp->inst = ftp->head->decoded;
  tp->pc = ftp->head->pc;
  tp->address = ftp->address;
}
