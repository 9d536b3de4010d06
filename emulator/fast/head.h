/* The head of a TP is the instruction that it fetches or holds. Everything that will be asked of it is noted when it
   becomes the head. */
#ifndef TRAX_FAST_HEAD_H
#define TRAX_FAST_HEAD_H

#include "fast/fast.h"

/* The TP, which has no other instruction, asks the bank of its head from the next fetch on. */
static inline void trax_fast_ask_bank(struct trax_fast_icache *icache, const struct trax_fast_inst *head,
                                      uint64_t bit) {
  struct trax_fast_bank *bank = &icache->bank[head->bank];
  const uint64_t bank_bit = (uint64_t)1 << head->bank;
  const uint64_t kept = (icache->banks & bank_bit) ? ~(uint64_t)0 : 0; /* somebody asks already */
  bank->last = (bank->last & kept) | (bank->asking & ~kept);
  bank->asking = (bank->asking & kept) | bit;
  icache->conflicts |= bank_bit & kept;
  icache->banks |= bank_bit;
}

static inline void trax_fast_ask_fetch(struct trax_fast_tm *ftm, unsigned number) {
  const struct trax_fast_tp *ftp = &ftm->tp[number];
  if (ftp->head->decoded->ask == TRAX_ASK_OUTSIDE)
    ftm->outside |= (uint64_t)1 << number;
  else
    trax_fast_ask_bank(ftp->icache, ftp->head, (uint64_t)1 << number);
}

/* Whether the head's operands will be usable in the cycle after t, and its line is in its cache, perhaps not known. */
static inline void trax_fast_look_ahead(struct trax_fast_tm *ftm, const struct trax_fast_tp *ftp, unsigned number,
                                        uint64_t t) {
  const struct trax_fast_inst *head = ftp->head;
  const uint64_t *usable = ftp->tp->usable;
  const struct trax_cache_tags *tags = ftp->icache->tags;
  const bool clear = (usable[head->wait_ra] <= t + 1) & (usable[head->wait_rb] <= t + 1) &
                     (usable[head->wait_rd] <= t + 1);
  const bool resident = tags->ways == 1 ? tags->lines[head->line & tags->set_mask] == (uint64_t)head->line + 1
                                        : trax_cache_tags_have(tags, head->line);
  const uint64_t others = ~((uint64_t)1 << number);
  ftm->clear = (ftm->clear & others) | (uint64_t)clear << number;
  ftm->resident = (ftm->resident & others) | (uint64_t)resident << number;
}

/* The next step becomes the head. */
static inline void trax_fast_take_step(struct trax_fast_tm *ftm, struct trax_fast_tp *ftp,
                                       const struct trax_fast_inst *inst, uint64_t bit) {
  const struct trax_fast_step step = ftp->steps[ftp->next++];
  const struct trax_fast_inst *head = inst + step.inst;
  ftp->head = head;
  ftp->address = step.address;
  ftm->want[head->class + ((step.address >= TRAX_LOCAL_BASE) & (head->class == TRAX_CLASS_BANK))] |= bit;
}

/* The TP's next instruction becomes its head, executed already if it may be, as of cycle t; returns its pc. */
uint32_t trax_fast_advance(struct trax_fast_tm *ftm, unsigned tp, uint64_t t);

#endif
