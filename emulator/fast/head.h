/* The head of a TP is the instruction that it fetches or holds. Everything that will be asked of it is noted when it
   becomes the head. */
#ifndef TRAX_FAST_HEAD_H
#define TRAX_FAST_HEAD_H

#include "fast/fast.h"

static inline void trax_fast_set(uint64_t *mask, unsigned tp, bool value) {
  *mask = (*mask & ~((uint64_t)1 << tp)) | (uint64_t)value << tp;
}

/* The TP asks for its head from the next fetch on. */
static inline void trax_fast_ask_fetch(struct trax_fast_tm *ftm, unsigned number) {
  const uint64_t bit = (uint64_t)1 << number;
  const struct trax_fast_inst *head = ftm->tp[number].head;
  if (head->decoded->ask == TRAX_ASK_OUTSIDE) {
    ftm->outside |= bit;
    return;
  }
  struct trax_fast_icache *icache = &ftm->icache[ftm->icache_of[number]];
  icache->asking[head->bank] |= bit;
  icache->banks |= (uint64_t)1 << head->bank;
}

static inline unsigned trax_fast_data_bank(const struct trax_fast_tm *ftm, uint32_t address) {
  const uint32_t banks = ftm->tm->dcache.banks;
  return (banks & (banks - 1)) == 0 ? address / 4 & (banks - 1) : address / 4 % banks;
}

/* After the issue in cycle t of the TP's head: the next one, executed already if it may be; returns its pc. */
static inline uint32_t trax_fast_advance(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  const uint64_t bit = (uint64_t)1 << number;
  struct trax_fast_tp *ftp = &ftm->tp[number];
  const struct trax_tp *tp = &ftm->tm->tp[number];
  if (ftp->next == ftp->count)
    trax_fast_refill(ftm, number);
  if (!(ftm->deferred & bit)) {
    const struct trax_fast_step *step = &ftp->steps[ftp->next++];
    const struct trax_fast_inst *head = ftm->fast->program.inst + step->inst;
    ftp->head = head;
    ftp->address = step->address;
    const bool local = step->address >= TRAX_LOCAL_BASE;
    const bool load = head->class == TRAX_CLASS_BANK;
    ftm->want[head->class + (local & load)] |= bit;
    ftm->data_bank[load & !local ? trax_fast_data_bank(ftm, step->address) : TRAX_MAX_TPS_PER_TM] |= bit;
  }
  const struct trax_fast_inst *head = ftp->head;
  const uint64_t next = t + 1;
  trax_fast_set(&ftm->clear, number,
                (tp->usable[head->wait_ra] <= next) & (tp->usable[head->wait_rb] <= next) &
                    (tp->usable[head->wait_rd] <= next));
  trax_fast_set(&ftm->resident, number,
                trax_cache_tags_have(&ftm->tm->icache[ftm->icache_of[number]].tags, head->line));
  return ftm->deferred & bit ? tp->pc : head->pc;
}

#endif
