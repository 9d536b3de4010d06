/* The head of a TP is the instruction that it fetches or holds. Everything that will be asked of it is noted when it
   becomes the head. */
#ifndef TRAX_FAST_HEAD_H
#define TRAX_FAST_HEAD_H

#include "fast/fast.h"

/* The TP, which has no other instruction, asks the bank of its head from the next fetch on. */
static inline void trax_fast_ask_fetch(struct trax_fast_tm *ftm, unsigned number) {
  const struct trax_fast_inst *inst = &ftm->fast->program.inst[ftm->head[number]->index];
  if (inst->decoded->ask == TRAX_ASK_OUTSIDE)
    ftm->outside |= (uint64_t)1 << number;
  else if (ftm->narrow)
    ftm->asking16_of[number][ftm->head[number]->bank] |= ftm->bit16[number];
  else
    ftm->asking_of[number][ftm->head[number]->bank] |= (uint64_t)1 << number;
}

/* Whether a step that becomes the TP's head will need no second look when it is fetched. */
static inline bool trax_fast_is_smooth(const struct trax_fast_tm *ftm, unsigned number) {
  const struct trax_fast_step *step = ftm->head[number];
  return (step->waits & ftm->busy_registers[number] ? 0 : 1) & ftm->resident[ftm->icache_of[number]][step->line];
}

static inline void trax_fast_set_resident(struct trax_fast_tm *ftm, unsigned icache, uint32_t line, bool is_there) {
  ftm->resident[icache][line] = is_there;
  if (ftm->fast->program.lines <= 64)
    ftm->resident_lines[icache] = (ftm->resident_lines[icache] & ~((uint64_t)1 << line)) | (uint64_t)is_there << line;
}

/* The TP's next instruction becomes its head, executed already if it may be; returns its pc. */
uint32_t trax_fast_advance(struct trax_fast_tm *ftm, unsigned tp);

#endif
