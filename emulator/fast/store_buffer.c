#include "fast/store_buffer.h"

#include "trax/grow.h"

#include <stdlib.h>
#include <string.h>

void trax_store_buffer_destroy(struct trax_store_buffer *buffer) {
  for (unsigned i = 0; i < TRAX_SIDES; i++)
    free(buffer->sides[i].entries);
  free(buffer->reads);
  trax_map_free(&buffer->lines);
}

void trax_store_buffer_begin(struct trax_store_buffer *buffer) {
  buffer->read_count = 0;
  trax_map_empty(&buffer->lines, sizeof(struct trax_store_buffer_line));
  buffer->stop = false;
}

void trax_store_buffer_begin_quantum(struct trax_store_buffer *buffer, unsigned side) {
  buffer->side = &buffer->sides[side];
  buffer->side->count = buffer->side->done = 0;
}

/* Makes room for one more element. False: out of memory; the epoch is then given up. */
static bool grow(struct trax_store_buffer *buffer, void **array, size_t count, size_t *capacity, size_t size) {
  const bool enough = trax_grow(array, count, capacity, size);
  buffer->stop |= !enough;
  return enough;
}

void trax_store_buffer_record(struct trax_store_buffer *buffer, struct trax_store_buffer_entry entry) {
  struct trax_store_buffer_side *const side = buffer->side;
  if (grow(buffer, (void **)&side->entries, side->count, &side->capacity, sizeof *side->entries))
    side->entries[side->count++] = entry;
}

void trax_store_buffer_read(struct trax_store_buffer *buffer, uint32_t address) {
  if (grow(buffer, (void **)&buffer->reads, buffer->read_count, &buffer->read_capacity, sizeof *buffer->reads))
    buffer->reads[buffer->read_count++] = address & ~3u;
}

uint32_t trax_store_buffer_load(struct trax_store_buffer *buffer, const struct trax_space *space, uint32_t address,
                                unsigned bytes) {
  const unsigned at = address % sizeof(((struct trax_store_buffer_line *)NULL)->bytes);
  uint32_t value = 0;
  trax_store_buffer_read(buffer, address);
  memcpy(&value, space->bytes + address, bytes);
  const struct trax_store_buffer_line *own =
      (struct trax_store_buffer_line *)trax_map_find(&buffer->lines, sizeof *own, address / sizeof own->bytes);
  for (unsigned i = 0; own && i < bytes; i++)
    if (own->entry.value >> (at + i) & 1)
      memcpy((uint8_t *)&value + i, &own->bytes[at + i], 1);
  return value;
}

void trax_store_buffer_store(struct trax_store_buffer *buffer, uint64_t t, uint32_t address, uint32_t value,
                             unsigned bytes) {
  trax_store_buffer_record(buffer, (struct trax_store_buffer_entry){t, address, value, bytes});
  struct trax_store_buffer_line *own =
      (struct trax_store_buffer_line *)trax_map_put(&buffer->lines, sizeof *own, address / sizeof own->bytes, 0);
  if (!own) {
    buffer->stop = true;
    return;
  }
  const unsigned at = address % sizeof own->bytes;
  own->entry.value |= ((1u << bytes) - 1) << at;
  memcpy(&own->bytes[at], &value, bytes);
}
