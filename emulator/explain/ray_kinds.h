/* The kind of ray that a thread works for (docs/isa.md, "Traps"): the kind that it counted last, from the trap that
   counts it until the thread's next count of items. */
#ifndef TRAX_EXPLAIN_RAY_KINDS_H
#define TRAX_EXPLAIN_RAY_KINDS_H

#include "explain/span.h"
#include "machine/ray_cycles.h"
#include "trax/abi.h"

/* The kind of the rays that the passage's trap counts; TRAX_NO_RAY if it counts no rays, or several kinds. */
static inline unsigned trax_counted_kind(const struct trax_passage *passage) {
  return passage->inst.op == TRAX_OP_TRAP ? trax_ray_kind_of(passage->inst.imm, passage->result) : TRAX_NO_RAY;
}

static inline bool trax_ends_item(const struct trax_passage *passage) {
  return passage->inst.op == TRAX_OP_TRAP && passage->inst.imm == TRAX_TRAP_ITEMS;
}

#endif
