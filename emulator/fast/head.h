/* The head of a TP is the instruction that it fetches or holds. Everything that will be asked of it is noted when it
   becomes the head. */
#ifndef TRAX_FAST_HEAD_H
#define TRAX_FAST_HEAD_H

#include "fast/fast.h"

static inline void trax_fast_set_resident(struct trax_fast_tm *ftm, unsigned icache, uint32_t line, bool is_there) {
  ftm->resident[icache][line] = is_there;
  if (ftm->fast->program.lines <= 64)
    ftm->resident_lines[icache] = (ftm->resident_lines[icache] & ~((uint64_t)1 << line)) | (uint64_t)is_there << line;
}

/* The TP's next instruction becomes its head, executed already if it may be; returns its pc. */
uint32_t trax_fast_advance(struct trax_fast_tm *ftm, unsigned tp);

/* The next steps of those that issue and do nothing else: they become the heads. */
static inline __attribute__((always_inline)) void trax_fast_issue_quickly(struct trax_fast_tm *ftm, const bool wide,
                                                                          uint64_t quick) {
  trax_fast_move_on(&ftm->heads, wide, quick);
  ftm->tm->holding &= ~quick;
}

/* Makes a step the only one, executed at issue. */
static inline void trax_fast_execute_at_issue(struct trax_fast_tm *ftm, unsigned number, uint16_t asks, uint32_t index,
                                   uint32_t address) {
  struct trax_fast_tp *ftp = &ftm->tp[number];
  ftm->deferred |= (uint64_t)1 << number;
  ftp->asks[0] = asks | TRAX_ASKS_SLOWLY;
  ftp->segment[0] = 0;
  ftp->origin[0] = index;
  ftp->address[0] = address;
  ftm->heads.last[number] = ftm->heads.load[number] = 0;
  trax_fast_set_head(&ftm->heads, number, 0);
}

#endif
