/* What a twin compiled with TRAX_ACCESSES tells of its way through the scene: which nodes and triangles it reads, slot
   by slot. One thread at a time. */
#ifndef TRAX_ACCESS_H
#define TRAX_ACCESS_H

#include <stdint.h>

/* An access: the record's offset in the scene, a multiple of 8, with a 1 added for a triangle. */
typedef uint32_t trax_access;
#define TRAX_ACCESS_TRIANGLE 1u

struct trax_access_log {
  trax_access *end, *limit; /* where the next one goes, and how far there is room */
  /* There is none: makes some, or discards what is there. */
  void (*full)(struct trax_access_log *log);
  /* The slot is done, with this many rays; its accesses are in the log since the call before. */
  void (*slot)(struct trax_access_log *log, uint32_t slot, uint32_t rays);
};

#endif
