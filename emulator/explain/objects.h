/* The objects in memory: symbols, bound buffers, heap, stacks, local memory, and the parts of buffers that the caller
   names, such as the sections of a scene. */
#ifndef TRAX_EXPLAIN_OBJECTS_H
#define TRAX_EXPLAIN_OBJECTS_H

#include "trax/explain.h"

struct trax_object {
  const char *name;
  uint64_t begin, end;
};

/* Addresses that belong to the same object and the same parts. */
struct trax_region {
  uint32_t begin, last;
  size_t number; /* of the first part; without one, of the object */
};

struct trax_explain;

struct trax_objects {
  struct trax_object *objects; /* by address, not overlapping; the last is for all other addresses */
  size_t count, capacity;
  const struct trax_explain_options *options; /* for their parts */
  struct trax_region *regions;                /* by address, without gaps */
  size_t region_count;
};

/* After an error, too, the objects must be released. */
trax_status trax_objects_list(struct trax_objects *objects, const struct trax_explain *explain, trax_error *error);
void trax_objects_release(struct trax_objects *objects);
/* The number of the object at an address. */
size_t trax_objects_at(const struct trax_objects *objects, uint32_t address);
/* The region of an address. */
const struct trax_region *trax_objects_region(const struct trax_objects *objects, uint32_t address);
/* The same, if the latest region of an instruction is probably that of its next access. */
static inline const struct trax_region *trax_objects_region_again(const struct trax_objects *objects, uint32_t address,
                                                                  const struct trax_region **latest) {
  if (!*latest || address - (*latest)->begin > (*latest)->last - (*latest)->begin)
    *latest = trax_objects_region(objects, address);
  return *latest;
}
/* The name of an object or part, whose number is behind those of the objects. */
const char *trax_objects_name(const struct trax_objects *objects, size_t number);
/* Writes a name as CSV (RFC 4180). */
void trax_objects_put_name(FILE *out, const char *name);

#endif
