/* The head of a TP is the instruction that it fetches or holds. All that its timing needs is recorded when it becomes
   the head. */
#ifndef TRAX_FAST_HEAD_H
#define TRAX_FAST_HEAD_H

#include "fast/fast.h"

static inline void trax_fast_set_resident(struct trax_fast_tm *ftm, unsigned icache, uint32_t line, bool is_resident) {
  ftm->resident[icache][line] = is_resident;
  if (ftm->fast->program.lines <= 64)
    ftm->resident_lines[icache] = (ftm->resident_lines[icache] & ~((uint64_t)1 << line)) | (uint64_t)is_resident
                                                                                               << line;
}

/* Makes the TP's next instruction its head, after a new burst if necessary; returns its pc. */
uint32_t trax_fast_advance(struct trax_fast_tm *ftm, unsigned tp);

/* Makes an instruction the TP's head, which executes at issue; its step is the only one. */
static inline void trax_fast_execute_at_issue(struct trax_fast_tm *ftm, unsigned number, uint16_t step, uint32_t index,
                                              uint32_t address) {
  struct trax_fast_tp *ftp = &ftm->tp[number];
  ftm->executes_at_issue |= (uint64_t)1 << number;
  ftm->watched[number] = 0;
  ftp->step[0] = step | TRAX_STEP_SLOW;
  ftp->segment[0] = 0;
  ftp->origin[0] = index;
  ftp->address[0] = address;
  ftm->heads.last[number] = ftm->heads.load[number] = 0;
  trax_fast_set_head(&ftm->heads, number, 0);
}

#endif
