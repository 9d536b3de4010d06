/* On a chip whose TPs do not fit in the host's caches: while a TM is simulated, the next one is brought into the
   second-level cache, TP by TP. What it will use is found by the heads that it had at the end of its latest quantum, of
   which it leaves a copy: another thread may simulate it meanwhile, and then a prefetch is in vain. Included by
   cycle.c. */
#ifndef TRAX_FAST_PREFETCH_H
#define TRAX_FAST_PREFETCH_H

#include "fast/chip.h"

enum { HOST_LINE = 64, NEAR_END = 32 /* steps of a burst: the next one begins in a quantum */ };

/* Inlined like its callers: gcc removes calls of functions that only prefetch. */
static ALWAYS_INLINE void prefetch(const void *begin, size_t bytes) {
  for (size_t at = 0; at < bytes; at += HOST_LINE)
    __builtin_prefetch((const char *)begin + at, 1, 2);
}

/* Prefetches one of the TPs' equal parts of an array. */
static ALWAYS_INLINE void prefetch_part(const struct trax_tm *tm, unsigned number, const void *array, size_t bytes) {
  const size_t part = (bytes / tm->tps + HOST_LINE) / HOST_LINE * HOST_LINE;
  prefetch((const char *)array + number * part, part);
}

/* Returns byte `number` of an array of the outlook. */
static ALWAYS_INLINE unsigned look(const uint64_t *words, unsigned number) {
  return __atomic_load_n(&words[number / 8], __ATOMIC_RELAXED) >> number % 8 * 8 & 0xFF;
}

static ALWAYS_INLINE void prefetch_tp(const struct trax_tm *tm, unsigned number) {
  const struct trax_fast_outlook *const outlook = &tm->outlook;
  const struct trax_tp *const tp = &tm->tp[number];
  const struct trax_cache_tags *const tags = &tm->dcache.tags;
  const unsigned at = look(outlook->at, number);
  if (!number)
    prefetch(tm, offsetof(struct trax_tm, busy_registers));
  prefetch(&tp->burst.step[at], HOST_LINE + 1);
  prefetch(&tp->burst.access[look(outlook->load, number)], HOST_LINE);
  prefetch(tp->usable, sizeof tp->usable);
  prefetch(&tm->tp_stats[number], sizeof *tm->tp_stats);
  if (look(outlook->last, number) - at < NEAR_END) {
    prefetch(tp->reg, sizeof tp->reg);
    prefetch(tp->local, offsetof(struct trax_tp, burst) - offsetof(struct trax_tp, local));
    prefetch(tp->burst.step, 3 * HOST_LINE);
    prefetch(tp->burst.index, 3 * HOST_LINE);
    prefetch(tp->burst.access, 4 * HOST_LINE);
  }
  prefetch_part(tm, number, tags->lines, (tags->set_mask + 1) * tags->ways * sizeof *tags->lines);
  prefetch_part(tm, number, tm->count_deltas, tm->chip->program.inst_count * sizeof *tm->count_deltas);
}

static void leave(uint64_t *words, const uint8_t *bytes) {
  for (unsigned i = 0; i < TRAX_MAX_TPS_PER_TM / 8; i++) {
    uint64_t word;
    memcpy(&word, bytes + 8 * i, sizeof word);
    __atomic_store_n(&words[i], word, __ATOMIC_RELAXED);
  }
}

/* To be called at the end of a quantum. */
static void leave_outlook(struct trax_tm *tm) {
  leave(tm->outlook.at, tm->heads.at);
  leave(tm->outlook.last, tm->heads.last);
  leave(tm->outlook.load, tm->heads.load);
}

#endif
