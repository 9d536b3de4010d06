/* The kind of ray that a thread works for (docs/isa.md, "Traps"): the kind that it counted last, from the trap that
   counts it until the thread's next count of items. */
#ifndef TRAX_EXPLAIN_RAY_KINDS_H
#define TRAX_EXPLAIN_RAY_KINDS_H

#include "explain/span.h"
#include "trax/abi.h"

enum { TRAX_NO_RAY = TRAX_RAY_KIND_COUNT }; /* the work for no ray */

extern const char *const trax_ray_kind_names[TRAX_RAY_KIND_COUNT];

/* The kind of the rays that the span's trap counts; TRAX_NO_RAY if it counts no rays, or several kinds. */
static inline unsigned trax_counted_kind(const struct trax_span *span) {
  const uint32_t field = (1u << TRAX_KIND_BITS) - 1;
  if (!span->issue || span->inst.op != TRAX_OP_TRAP || span->issue->result == 0)
    return TRAX_NO_RAY;
  if (span->inst.imm == TRAX_TRAP_RAYS)
    return TRAX_RAY_KIND_COUNT - 1;
  if (span->inst.imm != TRAX_TRAP_KINDS)
    return TRAX_NO_RAY;
  const unsigned lowest = (unsigned)__builtin_ctz(span->issue->result) / TRAX_KIND_BITS;
  return span->issue->result & ~(field << lowest * TRAX_KIND_BITS) ? TRAX_NO_RAY : lowest;
}

static inline bool trax_ends_item(const struct trax_span *span) {
  return span->issue && span->inst.op == TRAX_OP_TRAP && span->inst.imm == TRAX_TRAP_ITEMS;
}

#endif
