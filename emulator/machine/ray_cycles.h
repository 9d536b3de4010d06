/* The thread-cycles of the rays of each kind, which the engines fast and simt count if the run's options ask for them:
   at each trap that counts rays, the thread's charges since the trap before go to the kind that it worked for. */
#ifndef TRAX_MACHINE_RAY_CYCLES_H
#define TRAX_MACHINE_RAY_CYCLES_H

#include "machine/machine.h"

#include <string.h>

enum {
  TRAX_NO_RAY = TRAX_RAY_KIND_COUNT, /* the work for no ray */
  TRAX_RAY_ROWS
};

extern const char *const trax_ray_kind_names[TRAX_RAY_ROWS];

typedef uint64_t trax_ray_counts[TRAX_RAY_ROWS][TRAX_CAUSE_COUNT]; /* thread-cycles */

struct trax_thread_rays {
  uint64_t counted[TRAX_CAUSE_COUNT]; /* the charges that have gone to a kind */
  uint64_t kind;                      /* that the thread works for */
};

/* A measured part of a sampled run. The weighted sum of all parts is the estimate. */
struct trax_ray_part {
  double weight;
  uint64_t rays[TRAX_RAY_KIND_COUNT]; /* counted in it */
  trax_ray_counts counts;
};

struct trax_ray_cycles {
  trax_ray_counts *tms;             /* [tms]; after a sampled run the first has the estimates, and the others nothing */
  struct trax_thread_rays *threads; /* [threads] */
  struct trax_ray_part *parts;      /* [part_count]: beginning and end, then the draws; none if nothing is sampled */
  size_t part_count;
};

trax_status trax_ray_cycles_create(struct trax_machine *machine, trax_error *error);
void trax_ray_cycles_destroy(struct trax_ray_cycles *rays); /* may be NULL */

/* The sum over the TMs. */
void trax_ray_cycles_sum(const struct trax_machine *machine, trax_ray_counts sum);

/* The kind of the rays that a trap counts; TRAX_NO_RAY if it counts no rays, or several kinds. */
static inline unsigned trax_ray_kind_of(int32_t code, uint32_t value) {
  const uint32_t field = (1u << TRAX_KIND_BITS) - 1;
  if (value == 0)
    return TRAX_NO_RAY;
  if (code == TRAX_TRAP_RAYS)
    return TRAX_RAY_KIND_COUNT - 1;
  if (code != TRAX_TRAP_KINDS)
    return TRAX_NO_RAY;
  const unsigned lowest = (unsigned)__builtin_ctz(value) / TRAX_KIND_BITS;
  return value & ~(field << lowest * TRAX_KIND_BITS) ? TRAX_NO_RAY : lowest;
}

/* Gives the thread's charges so far, [TRAX_CAUSE_COUNT], to the kind that it works for. */
static inline void trax_ray_cycles_add(trax_ray_counts *counts, struct trax_thread_rays *thread,
                                       const uint64_t *charges) {
  uint64_t *to = (*counts)[thread->kind];
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    to[cause] += charges[cause] - thread->counted[cause];
  memcpy(thread->counted, charges, sizeof thread->counted);
}

/* The same, after the issue of a trap. The trap that counts a ray belongs to it. */
static inline void trax_ray_cycles_trap(trax_ray_counts *counts, struct trax_thread_rays *thread,
                                        const uint64_t *charges, int32_t code, uint32_t value) {
  const unsigned kind = trax_ray_kind_of(code, value);
  if (kind == TRAX_NO_RAY && code != TRAX_TRAP_ITEMS)
    return;
  trax_ray_cycles_add(counts, thread, charges);
  if (kind != TRAX_NO_RAY) {
    (*counts)[thread->kind][TRAX_CAUSE_ISSUED]--;
    (*counts)[kind][TRAX_CAUSE_ISSUED]++;
  }
  thread->kind = kind;
}

#endif
