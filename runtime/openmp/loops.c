/* The parts of loops. */
#include "kmp.h"

#ifdef __trax__

enum {
  STATIC_CHUNKS = 33,
  GUIDED = 36,
  MODIFIERS = 7 << 29 /* monotonic and the like: all of these are */
};

/* The number of iterations of a loop from lower to upper, both included. */
static unsigned long long trips_of(unsigned long long distance, long long step) {
  const unsigned long long width = step < 0 ? 0 - (unsigned long long)step : (unsigned long long)step;
  if (width == 1)
    return distance + 1;
  if (distance >> 32 || width >> 32)
    return distance / width + 1;
  return (unsigned)distance / (unsigned)width + 1;
}

/* Sets a thread's first part: the only one, or with chunks every `stride`-th. */
#define STATIC_INIT(NAME, TYPE, UNSIGNED, SIGNED)                                                                      \
  void __kmpc_for_static_init_##NAME(void *place, int thread, int schedule, int *last, TYPE *lower, TYPE *upper,       \
                                     SIGNED *stride, SIGNED step, SIGNED chunk) {                                      \
    (void)place;                                                                                                       \
    (void)thread;                                                                                                      \
    const unsigned size = team_size(), rank = __kmp_region.rank;                                                       \
    const UNSIGNED distance =                                                                                          \
        step < 0 ? (UNSIGNED) * lower - (UNSIGNED) * upper : (UNSIGNED) * upper - (UNSIGNED) * lower;                  \
    if (step < 0 ? *lower < *upper : *upper < *lower) {                                                                \
      *last = 0;                                                                                                       \
      return;                                                                                                          \
    }                                                                                                                  \
    const unsigned long long trips = trips_of(distance, step);                                                         \
    UNSIGNED first, length;                                                                                            \
    if ((schedule & ~MODIFIERS) == STATIC_CHUNKS) {                                                                    \
      length = chunk < 1 ? 1 : (UNSIGNED)chunk;                                                                        \
      const UNSIGNED before_last = (UNSIGNED)(trips - 1) / length; /* chunks */                                        \
      first = rank <= before_last ? length * rank : (UNSIGNED)trips;                                                   \
      length = before_last ? length : (UNSIGNED)trips;                                                                 \
      /* If a thread has no second chunk, the stride is the rest of the loop: a longer one could overflow. */          \
      *stride = (SIGNED)((before_last < size ? (UNSIGNED)trips - first : length * size) * (UNSIGNED)step);             \
      *last = before_last % size == rank;                                                                              \
    } else {                                                                                                           \
      const UNSIGNED each = (UNSIGNED)trips / size, more = (UNSIGNED)trips % size;                                     \
      length = each + (rank < more);                                                                                   \
      first = each * rank + (rank < more ? rank : more);                                                               \
      *stride = (SIGNED)((UNSIGNED)trips * (UNSIGNED)step);                                                            \
      *last = length && first + length == (UNSIGNED)trips;                                                             \
    }                                                                                                                  \
    *lower = (TYPE)((UNSIGNED) * lower + first * (UNSIGNED)step);                                                      \
    *upper = (TYPE)((UNSIGNED) * lower + length * (UNSIGNED)step - (UNSIGNED)step);                                    \
  }
STATIC_INIT(4, int, unsigned, int)
STATIC_INIT(4u, unsigned, unsigned, int)
STATIC_INIT(8, long long, unsigned long long, long long)
STATIC_INIT(8u, unsigned long long, unsigned long long, long long)

void __kmpc_for_static_fini(void *place, int thread) {
  (void)place;
  (void)thread;
}

static void start_loop(int schedule, unsigned long long lower, unsigned long long distance, int empty, long long step,
                       long long chunk) {
  struct dispatch *d = &__kmp_region.dispatch;
  d->kind = (unsigned)(schedule & ~MODIFIERS);
  d->lower = lower;
  d->stride = (unsigned long long)step;
  d->trips = empty ? 0 : trips_of(distance, step);
  d->chunk = chunk < 1 ? 1 : (unsigned long long)chunk;
  if (d->kind > GUIDED) /* runtime, auto: as static */
    d->chunk = d->trips / team_size() + 1;
  d->part = d->round = 0;
  d->start = 0;
  d->length = d->kind == GUIDED ? d->trips / (2 * team_size()) : 0;
  if (d->length < d->chunk)
    d->length = d->chunk;
}

/* Threads may be in different loops; the last one to leave a loop prepares its counter for a later one. */
static unsigned next_part(struct dispatch *d, unsigned size) {
  if (size == 1)
    return d->part++;
  const unsigned counter = d->number % COUNTERS;
  for (; !d->part; d->part = 1)
    while (load_shared(&__kmp_counters[counter].rounds) != d->number / COUNTERS)
      ;
  return trax_atomic_inc(&__kmp_counters[counter].next);
}

static void leave_loop(struct dispatch *d, unsigned size) {
  const unsigned counter = d->number++ % COUNTERS;
  if (size == 1 || trax_atomic_inc(&__kmp_counters[counter].left) != size - 1)
    return;
  store_shared(&__kmp_counters[counter].next, 0);
  store_shared(&__kmp_counters[counter].left, 0);
  release_fence();
  store_shared(&__kmp_counters[counter].rounds, load_shared(&__kmp_counters[counter].rounds) + 1);
}

/* The next part, by number from *first; its length, 0 at the end. */
static unsigned long long take_part(unsigned long long *first) {
  struct dispatch *d = &__kmp_region.dispatch;
  const unsigned size = team_size(), part = next_part(d, size);
  if (d->kind == GUIDED) {
    for (; part / size != d->round && d->start < d->trips; d->round++) {
      d->start += d->length * size;
      const unsigned long long rest = d->start < d->trips ? (d->trips - d->start) / (2 * size) : 0;
      d->length = rest < d->chunk ? d->chunk : rest;
    }
    *first = d->start + part % size * d->length;
  } else {
    *first = part * d->chunk;
  }
  if (*first >= d->trips) {
    leave_loop(d, size);
    return 0;
  }
  return d->trips - *first < d->length ? d->trips - *first : d->length;
}

#define DISPATCH(NAME, TYPE, UNSIGNED, SIGNED)                                                                         \
  void __kmpc_dispatch_init_##NAME(void *place, int thread, int schedule, TYPE lower, TYPE upper, SIGNED step,         \
                                   SIGNED chunk) {                                                                     \
    (void)place;                                                                                                       \
    (void)thread;                                                                                                      \
    start_loop(schedule, (unsigned long long)lower,                                                                    \
               step < 0 ? (UNSIGNED)lower - (UNSIGNED)upper : (UNSIGNED)upper - (UNSIGNED)lower,                       \
               step < 0 ? lower < upper : upper < lower, step, chunk);                                                 \
  }                                                                                                                    \
  int __kmpc_dispatch_next_##NAME(void *place, int thread, int *last, TYPE *lower, TYPE *upper, SIGNED *stride) {      \
    (void)place;                                                                                                       \
    (void)thread;                                                                                                      \
    const struct dispatch *d = &__kmp_region.dispatch;                                                                 \
    unsigned long long first, length = take_part(&first);                                                              \
    if (!length)                                                                                                       \
      return 0;                                                                                                        \
    if (last)                                                                                                          \
      *last = first + length == d->trips;                                                                              \
    *lower = (TYPE)(d->lower + first * d->stride);                                                                     \
    *upper = (TYPE)(d->lower + (first + length - 1) * d->stride);                                                      \
    if (stride)                                                                                                        \
      *stride = (SIGNED)d->stride;                                                                                     \
    return 1;                                                                                                          \
  }
DISPATCH(4, int, unsigned, int)
DISPATCH(4u, unsigned, unsigned, int)
DISPATCH(8, long long, unsigned long long, long long)
DISPATCH(8u, unsigned long long, unsigned long long, long long)

void __kmpc_dispatch_deinit(void *place, int thread) {
  (void)place;
  (void)thread;
}

#endif
