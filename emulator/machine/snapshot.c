#include "machine/snapshot.h"

#include <stdlib.h>
#include <string.h>

struct trax_snapshot_piece {
  uint8_t *bytes;
  size_t size, place; /* place: in the copy */
};

/* Counts the section, or lists it if there is a list. No piece is within another one: threads that copy parts of the
   list must not meet in the same bytes. */
static void add_section(void *context, const struct trax_section *section) {
  struct trax_snapshot *snapshot = context;
  const size_t size = section->size * section->count;
  if (!size || section->within)
    return;
  if (snapshot->pieces)
    snapshot->pieces[snapshot->count] = (struct trax_snapshot_piece){section->bytes, size, snapshot->size};
  snapshot->count++;
  snapshot->size += size;
}

bool trax_snapshot_create(struct trax_snapshot *snapshot,
                          void (*visit_all)(void *state, trax_section_visitor *visit, void *context), void *state) {
  visit_all(state, add_section, snapshot);
  snapshot->pieces = calloc(snapshot->count, sizeof *snapshot->pieces);
  snapshot->copy = malloc(snapshot->size);
  if (!snapshot->pieces || !snapshot->copy)
    return false;
  snapshot->count = snapshot->size = 0;
  visit_all(state, add_section, snapshot);
  return true;
}

void trax_snapshot_destroy(struct trax_snapshot *snapshot) {
  free(snapshot->pieces);
  free(snapshot->copy);
}

static size_t begin_of(const struct trax_snapshot *snapshot, uint32_t part, uint32_t parts) {
  return snapshot->count * part / parts;
}

void trax_snapshot_save(struct trax_snapshot *snapshot, uint32_t part, uint32_t parts) {
  for (size_t i = begin_of(snapshot, part, parts); i < begin_of(snapshot, part + 1, parts); i++)
    memcpy(snapshot->copy + snapshot->pieces[i].place, snapshot->pieces[i].bytes, snapshot->pieces[i].size);
}

void trax_snapshot_restore(const struct trax_snapshot *snapshot, uint32_t part, uint32_t parts) {
  for (size_t i = begin_of(snapshot, part, parts); i < begin_of(snapshot, part + 1, parts); i++)
    memcpy(snapshot->pieces[i].bytes, snapshot->copy + snapshot->pieces[i].place, snapshot->pieces[i].size);
}
