/* Function, ahead of time. A burst ends before an instruction whose effect others can see or whose value depends on
   time: atomic increments, stores to global memory, loads from blocks that are written during the run, loads and stores
   past the cache, reads of the cycle counter, traps, ends of threads, and everything that faults. */
#include "fast/fast.h"
#include "trax/semantics.h"

#include <string.h>

#define NOWHERE UINT64_MAX /* no pc */

#define LIKELY(CONDITION) __builtin_expect(CONDITION, true)

static inline unsigned data_bank(const struct trax_fast_tm *ftm, uint32_t address) {
  const uint32_t banks = ftm->data_banks;
  return LIKELY((banks & (banks - 1)) == 0) ? address / 4 & (banks - 1) : address / 4 % banks;
}

/* Bit line % 64 of the lines from one instruction to another. */
static uint64_t lines_of(const struct trax_fast_inst *first, const struct trax_fast_inst *last) {
  const unsigned count = (unsigned)(last->line - first->line), begin = first->line % 64u;
  const uint64_t lines = count < 63 ? ((uint64_t)2 << count) - 1 : ~(uint64_t)0;
  return begin ? lines << begin | lines >> (64 - begin) : lines;
}

/* Notes the rest of a stretch from one of its instructions on, as steps `at`... */
static inline void note_stretch(struct trax_fast_tp *ftp, unsigned at, const uint16_t *asks, uint32_t index) {
  typedef uint32_t indices __attribute__((vector_size(32), aligned(4), may_alias));
  memcpy(ftp->asks + at, asks, TRAX_STRETCH * sizeof *asks);
  indices of = (indices){0, 1, 2, 3, 4, 5, 6, 7} + index;
#pragma GCC unroll 4
  for (unsigned i = 0; i < TRAX_STRETCH; i += 8, of += 8)
    *(indices *)(ftp->index + at + i) = of;
}

#define BURST burst_whole
#define EXACTLY 0
#include "fast/burst_steps.h"
#define BURST burst_exactly
#define EXACTLY 1
#include "fast/burst_steps.h"

const void *const *trax_fast_operations(void) {
  const void *const *operations;
  burst_whole(NULL, NULL, 0, 0, &operations);
  return operations;
}

unsigned trax_fast_burst(struct trax_fast *fast, struct trax_fast_tm *ftm, unsigned number, unsigned limit) {
  return limit == TRAX_BURST ? burst_whole(fast, ftm, number, limit, NULL)
                             : burst_exactly(fast, ftm, number, limit, NULL);
}
