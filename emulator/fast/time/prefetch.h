/* On a chip whose TPs do not fit in the host's caches: while a TM is simulated, the next one is brought into the
   second-level cache, TP by TP. What it will use is found by the heads that it had at the end of its latest epoch, of
   which it leaves a copy: another thread may simulate it meanwhile. Included by cycle.c. */
#ifndef TRAX_FAST_PREFETCH_H
#define TRAX_FAST_PREFETCH_H

#include "fast/chip.h"

enum { HOST_LINE = 64, NEAR_END = 32 /* steps of a burst: the next one begins in an epoch */ };

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

static ALWAYS_INLINE void prefetch_tp(const struct trax_tm *tm, unsigned number, unsigned epoch) {
  const struct trax_fast_outlook *const outlook = &tm->outlook[epoch % 2];
  const struct trax_tp *const tp = &tm->tp[number];
  const struct trax_cache_tags *const tags = &tm->dcache.tags;
  const unsigned at = outlook->at[number];
  if (!number)
    prefetch(tm, offsetof(struct trax_tm, busy_registers));
  prefetch(&tp->burst.step[at], HOST_LINE + 1);
  prefetch(&tp->burst.access[outlook->load[number]], HOST_LINE);
  prefetch(tp->usable, sizeof tp->usable);
  prefetch(&tm->tp_stats[number], sizeof *tm->tp_stats);
  if (outlook->last[number] - at < NEAR_END) {
    prefetch(tp->reg, sizeof tp->reg);
    prefetch(tp->local, offsetof(struct trax_tp, burst) - offsetof(struct trax_tp, local));
    prefetch(tp->burst.step, 3 * HOST_LINE);
    prefetch(tp->burst.index, 3 * HOST_LINE);
    prefetch(tp->burst.access, 4 * HOST_LINE);
  }
  prefetch_part(tm, number, tags->lines, (tags->set_mask + 1) * tags->ways * sizeof *tags->lines);
  prefetch_part(tm, number, tm->count_deltas, tm->chip->program.inst_count * sizeof *tm->count_deltas);
}

/* To be called at the end of an epoch. */
static void leave_outlook(struct trax_tm *tm) {
  struct trax_fast_outlook *const outlook = &tm->outlook[++tm->epoch % 2];
  memcpy(outlook->at, tm->heads.at, sizeof outlook->at);
  memcpy(outlook->last, tm->heads.last, sizeof outlook->last);
  memcpy(outlook->load, tm->heads.load, sizeof outlook->load);
}

#endif
