/* Bursts: instructions that are executed before their issue. A burst ends before an instruction whose effect is visible
   to other TPs or whose result depends on time: atomic increments, stores to global memory unless the thread is alone,
   loads from shared blocks, loads and stores past the cache, fences, reads of the cycle counter, traps, ends of
   threads, and all instructions that fault. */
#include "fast/chip.h"
#define inline __inline__ __attribute__((always_inline)) /* a call costs as much as an instruction */
#include "trax/semantics.h"
#undef inline

#include <string.h>

#define NOWHERE UINT64_MAX /* next_pc of an instruction that does not jump */

#define LIKELY(CONDITION) __builtin_expect(CONDITION, true)

/* `mask`: banks - 1 if banks is a power of two, else 0. */
static inline unsigned data_bank(uint32_t banks, uint32_t mask, uint32_t address) {
  return LIKELY(mask) ? address / 4 & mask : address / 4 % banks;
}

/* Records `count` instructions from index on as the steps from `at` on, a segment of the burst. */
static inline void record_segment(struct trax_tp *tp, unsigned segment, unsigned at, const uint16_t *step,
                                  uint32_t index, const unsigned count) {
  memcpy(tp->step + at, step, count * sizeof *step);
  memset(tp->segment + at, (int)segment, count);
  tp->origin[segment] = index - at;
}

/* Loads from a WRITTEN block: before the word is written again, the TP rolls back. */
static __attribute__((noinline, cold)) uint32_t load_written(struct trax_tm *tm, unsigned number, uint32_t address,
                                                             unsigned bytes) {
  tm->watched[number] |= trax_fast_word_bit(address);
  return trax_tm_load(tm, address, bytes);
}

/* Stores to global memory ahead of the issue: the thread is alone. False: the store must execute at issue. */
static __attribute__((noinline)) bool store_ahead(const struct trax_chip *chip, struct trax_tp *tp, uint32_t address,
                                                  uint32_t value, unsigned bytes) {
  const struct trax_space *space = &chip->machine->space;
  if (trax_space_check(space, address, bytes, true) || address - chip->blocks.input < chip->blocks.input_bytes)
    return false;
  struct trax_fast_undo *const undo = &tp->undo[tp->undo_count++];
  undo->address = address & ~3u;
  memcpy(&undo->word, space->bytes + undo->address, sizeof undo->word);
  memcpy(space->bytes + address, &value, bytes);
  return true;
}

#define BURST burst_whole
#define EXACTLY 0
#include "fast/function/burst_steps.h"
#define BURST burst_exactly
#define EXACTLY 1
#include "fast/function/burst_steps.h"

const void *const *trax_fast_operations(void) {
  const void *const *operations;
  burst_whole(NULL, NULL, 0, 0, &operations);
  return operations;
}

unsigned trax_fast_burst(struct trax_chip *chip, struct trax_tm *tm, unsigned number, unsigned limit) {
  return limit == TRAX_BURST && !tm->tp[number].atomics ? burst_whole(chip, tm, number, limit, NULL)
                                                        : burst_exactly(chip, tm, number, limit, NULL);
}
