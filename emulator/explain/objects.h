/* The objects in memory: symbols, bound buffers, heap, stacks, local memory, and the parts of buffers that the caller
   names, such as the sections of a scene. */
#ifndef TRAX_EXPLAIN_OBJECTS_H
#define TRAX_EXPLAIN_OBJECTS_H

#include "explain/span.h"

struct trax_object {
  const char *name;
  uint64_t begin, end;
};

struct trax_objects {
  struct trax_object *objects; /* by address, not overlapping; the last is for all other addresses */
  size_t count, capacity;
  const struct trax_explain_options *options; /* for their parts */
};

/* After an error, too, the objects must be released. */
trax_status trax_objects_list(struct trax_objects *objects, const struct trax_explain *explain, trax_error *error);
void trax_objects_release(struct trax_objects *objects);
/* The number of the object at an address. */
size_t trax_objects_at(const struct trax_objects *objects, uint32_t address);
/* The number of the first part at an address, behind those of the objects; without one, the object's. */
size_t trax_objects_part_at(const struct trax_objects *objects, uint32_t address);
/* The name of an object or part. */
const char *trax_objects_name(const struct trax_objects *objects, size_t number);
/* Writes a name as CSV (RFC 4180). */
void trax_objects_put_name(FILE *out, const char *name);

#endif
