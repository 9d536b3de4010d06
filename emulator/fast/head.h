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
  if (icache->banks & bank_bit) {
    bank->asking |= bit;
    icache->conflicts |= bank_bit;
  } else {
    bank->last = bank->asking;
    bank->asking = bit;
    icache->banks |= bank_bit;
  }
}

static inline void trax_fast_ask_fetch(struct trax_fast_tm *ftm, unsigned number) {
  const struct trax_fast_slot *slot = &ftm->slot[number];
  if (slot->step->inst->decoded->ask == TRAX_ASK_OUTSIDE)
    ftm->outside |= (uint64_t)1 << number;
  else
    trax_fast_ask_bank(slot->icache, slot->step->inst, (uint64_t)1 << number);
}

/* Whether the head's line is in its cache. */
static inline bool trax_fast_is_resident(const struct trax_cache_tags *tags, const struct trax_fast_inst *head) {
  const uint32_t line = trax_line_of(tags, head->pc);
  return tags->ways == 1 ? tags->lines[line & tags->set_mask] == (uint64_t)line + 1 : trax_cache_tags_have(tags, line);
}

/* The TP's next instruction becomes its head, executed already if it may be; returns its pc. */
uint32_t trax_fast_advance(struct trax_fast_tm *ftm, unsigned tp);

#endif
