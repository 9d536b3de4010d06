/* A copy of the bytes of a state's sections (machine/section.h), to go back to it. Threads may copy different parts at
   the same time. */
#ifndef TRAX_MACHINE_SNAPSHOT_H
#define TRAX_MACHINE_SNAPSHOT_H

#include "machine/section.h"

struct trax_snapshot {
  struct trax_snapshot_piece *pieces; /* [count] */
  size_t count, size;
  uint8_t *copy; /* [size] */
};

/* `visit_all` visits the sections of `state`, which stay where they are. False: out of memory. The snapshot, which was
   zero, must be destroyed in either case. */
bool trax_snapshot_create(struct trax_snapshot *snapshot,
                          void (*visit_all)(void *state, trax_section_visitor *visit, void *context), void *state);
void trax_snapshot_destroy(struct trax_snapshot *snapshot);

/* Copy part `part` of `parts` of the state to the snapshot, or back. */
void trax_snapshot_save(struct trax_snapshot *snapshot, uint32_t part, uint32_t parts);
void trax_snapshot_restore(const struct trax_snapshot *snapshot, uint32_t part, uint32_t parts);

#endif
