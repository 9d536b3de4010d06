/* The TMs whose store buffers have entries left at the end of an epoch, in the order of (cycle of the next entry, TM):
   a heap. */
#ifndef TRAX_FAST_SCHEDULE_H
#define TRAX_FAST_SCHEDULE_H

#include "machine/config.h"
#include "machine/watch.h" /* TRAX_NEVER */

struct trax_schedule {
  uint32_t count;
  uint64_t key[TRAX_MAX_TMS]; /* cycle * TRAX_MAX_TMS + TM */
};

static inline uint64_t trax_schedule_next(const struct trax_schedule *schedule) {
  return schedule->count ? schedule->key[0] / TRAX_MAX_TMS : TRAX_NEVER;
}

/* Returns the TM with the next entry; there must be one. */
static inline uint32_t trax_schedule_first(const struct trax_schedule *schedule) {
  return (uint32_t)(schedule->key[0] % TRAX_MAX_TMS);
}

static inline void trax_schedule_add(struct trax_schedule *schedule, uint64_t cycle, uint32_t tm) {
  const uint64_t key = cycle * TRAX_MAX_TMS + tm;
  uint32_t at = schedule->count++;
  for (; at && key < schedule->key[(at - 1) / 2]; at = (at - 1) / 2)
    schedule->key[at] = schedule->key[(at - 1) / 2];
  schedule->key[at] = key;
}

/* The first TM's next entry is one of the given cycle; TRAX_NEVER: it has none. */
static inline void trax_schedule_go_on(struct trax_schedule *schedule, uint64_t cycle) {
  const uint64_t key =
      cycle == TRAX_NEVER ? schedule->key[--schedule->count] : cycle * TRAX_MAX_TMS + trax_schedule_first(schedule);
  uint32_t at = 0;
  for (uint32_t child = 1; child < schedule->count; child = 2 * at + 1) {
    child += child + 1 < schedule->count && schedule->key[child + 1] < schedule->key[child];
    if (key < schedule->key[child])
      break;
    schedule->key[at] = schedule->key[child];
    at = child;
  }
  schedule->key[at] = key;
}

#endif
