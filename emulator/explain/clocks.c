#include "explain/clocks.h"
#include "explain/span.h"

#include <stdlib.h>
#include <string.h>

/* A copy of a clock, which releases share. */
struct copy {
  uint32_t uses;
  uint32_t clock[]; /* [threads] */
};

struct trax_release {
  uint32_t uses;
  uint32_t thread, own; /* the thread's part of the clock is `own` instead */
  struct copy *copy;
};

struct trax_thread_clock {
  uint32_t *clock, *seen; /* [threads]; seen: what the next `fence r` adds */
  struct trax_release *release;
  struct copy *copy; /* of clock and seen; NULL: another thread's part has changed since */
};

static void drop_copy(struct copy **copy) {
  if (*copy && --(*copy)->uses == 0)
    free(*copy);
  *copy = NULL;
}

void trax_release_drop(struct trax_release **release) {
  if (*release && --(*release)->uses == 0) {
    drop_copy(&(*release)->copy);
    free(*release);
  }
  *release = NULL;
}

/* Returns whether something has changed. */
static bool join(const struct trax_clocks *clocks, uint32_t *clock, const uint32_t *other) {
  bool changed = false;
  for (uint32_t i = 0; i < clocks->threads; i++) {
    changed |= other[i] > clock[i];
    clock[i] = other[i] > clock[i] ? other[i] : clock[i];
  }
  return changed;
}

static bool join_release(const struct trax_clocks *clocks, uint32_t *clock, const struct trax_release *release) {
  bool changed = join(clocks, clock, release->copy->clock);
  changed |= release->own > clock[release->thread];
  clock[release->thread] = release->own > clock[release->thread] ? release->own : clock[release->thread];
  return changed;
}

static struct copy *new_copy(struct trax_clocks *clocks, const uint32_t *clock) {
  struct copy *copy = malloc(sizeof *copy + clocks->threads * sizeof *clock);
  if (!copy) {
    clocks->out_of_memory = true;
    return NULL;
  }
  copy->uses = 1;
  memcpy(copy->clock, clock, clocks->threads * sizeof *clock);
  return copy;
}

/* The release takes the use of the copy, which may be NULL. */
static struct trax_release *new_release(struct trax_clocks *clocks, uint32_t thread, uint32_t own, struct copy *copy) {
  struct trax_release *release = copy ? malloc(sizeof *release) : NULL;
  if (release) {
    *release = (struct trax_release){1, thread, own, copy};
  } else {
    clocks->out_of_memory = true;
    drop_copy(&copy);
  }
  return release;
}

uint32_t trax_clock_of(const struct trax_clocks *clocks, uint32_t thread) {
  return clocks->thread[thread].clock[thread];
}

bool trax_clocks_know(const struct trax_clocks *clocks, uint32_t thread, uint32_t other, uint32_t clock) {
  return clock <= clocks->thread[thread].clock[other];
}

/* The values that a thread has loaded before a `fence w` were in memory before its stores after it. */
void trax_clocks_fence(struct trax_clocks *clocks, uint32_t thread, int32_t kind) {
  struct trax_thread_clock *it = &clocks->thread[thread];
  if (kind & TRAX_FENCE_R)
    join(clocks, it->clock, it->seen);
  if (!(kind & TRAX_FENCE_W))
    return;
  trax_release_drop(&it->release);
  if (!it->copy && (it->copy = new_copy(clocks, it->clock)))
    join(clocks, it->copy->clock, it->seen);
  if (it->copy) {
    it->copy->uses++;
    it->release = new_release(clocks, thread, it->clock[thread], it->copy);
  }
  it->clock[thread]++;
}

void trax_clocks_store(struct trax_clocks *clocks, uint32_t thread, struct trax_release **word) {
  struct trax_release *release = clocks->thread[thread].release;
  if (*word == release)
    return;
  trax_release_drop(word);
  if ((*word = release))
    release->uses++;
}

void trax_clocks_add(struct trax_clocks *clocks, uint32_t thread, struct trax_release **word) {
  const struct trax_release *release = clocks->thread[thread].release;
  if (!*word)
    trax_clocks_store(clocks, thread, word);
  if (!release || *word == release)
    return;
  struct copy *const sum = new_copy(clocks, (*word)->copy->clock);
  struct trax_release *const both = new_release(clocks, (*word)->thread, (*word)->own, sum);
  if (both)
    join_release(clocks, sum->clock, release);
  trax_release_drop(word);
  *word = both;
}

void trax_clocks_load(struct trax_clocks *clocks, uint32_t thread, const struct trax_release *word) {
  struct trax_thread_clock *it = &clocks->thread[thread];
  const uint32_t own = it->seen[thread];
  it->seen[thread] = UINT32_MAX; /* what the thread reads of itself changes nothing */
  if (word && join_release(clocks, it->seen, word))
    drop_copy(&it->copy);
  it->seen[thread] = own;
}

trax_status trax_clocks_open(struct trax_clocks *clocks, uint32_t threads, trax_error *error) {
  clocks->threads = threads;
  if (!(clocks->thread = trax_explain_array(threads, sizeof *clocks->thread, error)))
    return TRAX_ERROR;
  for (uint32_t i = 0; i < threads; i++) {
    struct trax_thread_clock *it = &clocks->thread[i];
    if (!(it->clock = trax_explain_array(threads, sizeof *it->clock, error)) ||
        !(it->seen = trax_explain_array(threads, sizeof *it->seen, error)))
      return TRAX_ERROR;
    it->clock[i] = 1;
  }
  return TRAX_OK;
}

void trax_clocks_close(struct trax_clocks *clocks) {
  for (uint32_t i = 0; clocks->thread && i < clocks->threads; i++) {
    trax_release_drop(&clocks->thread[i].release);
    drop_copy(&clocks->thread[i].copy);
    free(clocks->thread[i].clock);
    free(clocks->thread[i].seen);
  }
  free(clocks->thread);
}
