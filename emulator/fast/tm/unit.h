/* Units that TPs share (docs/timing.md, "Units"). Adders and multipliers have masks instead of arbiters if these give
   the same (time/masks.h). */
#ifndef TRAX_FAST_UNIT_H
#define TRAX_FAST_UNIT_H

#include "fast/tm/arbiter.h"
#include "machine/section.h"
#include "machine/timing.h"

#define TRAX_SHARED_UNIT_STATE(X, S) X(S, trax_arbiter, arbiter, [64]) /* [groups] */

/* All units of a kind in a TM. */
struct trax_shared_unit {
  struct trax_shared_kind kind;
  uint64_t *free_from; /* [group][unit]: a cycle; NULL if they are always free */
  TRAX_SHARED_UNIT_STATE(TRAX_FIELD, )
};

/* The number of elements of free_from. */
static inline size_t trax_shared_unit_count(const struct trax_shared_unit *unit) {
  return unit->free_from ? (size_t)unit->kind.groups * unit->kind.per_group : 0;
}

#endif
