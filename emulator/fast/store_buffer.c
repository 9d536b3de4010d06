#include "fast/store_buffer.h"

void trax_store_buffer_destroy(struct trax_store_buffer *buffer) {
  for (unsigned i = 0; i < TRAX_SIDES; i++)
    free(buffer->sides[i].entries);
  free(buffer->written.lines);
}

void trax_store_buffer_begin(struct trax_store_buffer *buffer) {
  trax_written_empty(&buffer->written);
  buffer->stop = false;
}

void trax_store_buffer_begin_quantum(struct trax_store_buffer *buffer, unsigned side) {
  buffer->side = &buffer->sides[side];
  buffer->side->count = buffer->side->done = 0;
}

void trax_store_buffer_record(struct trax_store_buffer *buffer, struct trax_store_buffer_entry entry) {
  struct trax_store_buffer_side *const side = buffer->side;
  if (trax_grow((void **)&side->entries, side->count, &side->capacity, sizeof *side->entries))
    side->entries[side->count++] = entry;
  else
    buffer->stop = true; /* the epoch is given up */
}
