/* Tells which nodes and triangles are read (trax/access.h), if compiled with TRAX_ACCESSES; in other programs nothing
   of it is left. */
#ifndef TRAX_DEVICE_ACCESS_H
#define TRAX_DEVICE_ACCESS_H

#ifdef TRAX_ACCESSES

#include "run.h"
#include "trax/access.h"

extern struct trax_access_log *trax_access_log;

static inline void log_access(const char *record, trax_access kind) {
  struct trax_access_log *log = trax_access_log;
  if (log->end == log->limit)
    log->full(log);
  *log->end++ = (trax_access)(record - (const char *)scene.data) | kind;
}

static inline void log_slot(uint32_t slot) {
  trax_access_log->slot(trax_access_log, slot, (uint32_t)trax_native.rays);
  trax_native.rays = 0;
}

#define ACCESS_NODE(node) log_access(node, 0)
#define ACCESS_TRIANGLE(triangle) log_access(triangle, TRAX_ACCESS_TRIANGLE)
#define ACCESS_SLOT(slot) log_slot(slot)

#else
#define ACCESS_NODE(node) ((void)0)
#define ACCESS_TRIANGLE(triangle) ((void)0)
#define ACCESS_SLOT(slot) ((void)0)
#endif

#endif
