/* An overlay of memory: the bytes that stores have changed, in lines of 32, since neighbours are often stored together.
   A table of lines by number, which is emptied in a time that depends on those in use. */
#ifndef TRAX_MACHINE_OVERLAY_H
#define TRAX_MACHINE_OVERLAY_H

#include "trax/grow.h"

#include <stdint.h>
#include <string.h>

enum { TRAX_OVERLAY_BYTES = 32, TRAX_OVERLAY_SLOTS = 1024 };

struct trax_overlay_line {
  uint32_t number, next;                  /* address / 32; the line after it in its slot, + 1; 0: there is none */
  uint32_t written, read;                 /* a bit for each byte; read: for the owner of the overlay */
  uint8_t bytes[TRAX_OVERLAY_BYTES];      /* valid if they are written */
  uint8_t writer[TRAX_OVERLAY_BYTES / 4]; /* of each word, for the owner */
};

struct trax_overlay {
  struct trax_overlay_line *lines; /* [count], in the order in which they were put */
  size_t count, capacity;
  uint32_t slots[TRAX_OVERLAY_SLOTS]; /* the index of the first line, + 1 */
};

static inline void trax_overlay_destroy(struct trax_overlay *overlay) {
  free(overlay->lines);
}

static inline uint32_t *trax_overlay_slot(struct trax_overlay *overlay, uint32_t number) {
  return &overlay->slots[number * 0x9E3779B1u / (UINT32_MAX / TRAX_OVERLAY_SLOTS + 1)];
}

/* NULL: the line is not in use. */
static inline struct trax_overlay_line *trax_overlay_find(struct trax_overlay *overlay, uint32_t number) {
  for (uint32_t i = *trax_overlay_slot(overlay, number); i; i = overlay->lines[i - 1].next)
    if (overlay->lines[i - 1].number == number)
      return &overlay->lines[i - 1];
  return NULL;
}

/* Returns the line, with nothing written if it has not been in use. NULL: out of memory. Earlier lines may move. */
static inline struct trax_overlay_line *trax_overlay_put(struct trax_overlay *overlay, uint32_t number) {
  struct trax_overlay_line *const found = trax_overlay_find(overlay, number);
  if (__builtin_expect(found != NULL, true))
    return found;
  if (!trax_grow((void **)&overlay->lines, overlay->count, &overlay->capacity, sizeof *overlay->lines))
    return NULL;
  uint32_t *const slot = trax_overlay_slot(overlay, number);
  struct trax_overlay_line *const line = &overlay->lines[overlay->count++];
  *line = (struct trax_overlay_line){.number = number, .next = *slot};
  *slot = (uint32_t)overlay->count;
  return line;
}

static inline void trax_overlay_empty(struct trax_overlay *overlay) {
  while (overlay->count)
    *trax_overlay_slot(overlay, overlay->lines[--overlay->count].number) = 0;
}

/* Returns the bits of an aligned access. */
static inline uint32_t trax_overlay_bits(uint32_t address, unsigned bytes) {
  return ((1u << bytes) - 1) << address % TRAX_OVERLAY_BYTES;
}

/* Returns a byte of ones for each of four bits. */
static inline uint32_t trax_overlay_mask(uint32_t bits) {
  return ((bits & 15) * 0x204081 & 0x1010101) * 0xFF;
}

/* Copies those of a line's bytes that are in a mask. */
static inline void trax_overlay_copy(uint8_t *to, const uint8_t *from, uint32_t bits) {
  if (bits == UINT32_MAX) {
    memcpy(to, from, TRAX_OVERLAY_BYTES);
    return;
  }
  for (unsigned at = 0; at < TRAX_OVERLAY_BYTES; at += 4) {
    uint32_t old, new;
    memcpy(&old, to + at, sizeof old);
    memcpy(&new, from + at, sizeof new);
    old ^= (old ^ new) & trax_overlay_mask(bits >> at);
    memcpy(to + at, &old, sizeof old);
  }
}

/* Returns the bytes of an aligned access as the line and the memory below it have them. */
static inline uint32_t trax_overlay_load(const struct trax_overlay_line *line, const uint8_t *memory, uint32_t address,
                                         unsigned bytes) {
  const uint32_t written = line->written >> (address & 28) & 15;
  uint32_t old, new;
  memcpy(&old, memory + (address & ~3u), sizeof old);
  memcpy(&new, line->bytes + (address & 28), sizeof new);
  if (bytes == sizeof old && (!written || written == 15))
    return written ? new : old;
  old ^= (old ^ new) & trax_overlay_mask(written);
  return old >> address % 4 * 8 & UINT32_MAX >> (32 - 8 * bytes);
}

static inline void trax_overlay_store(struct trax_overlay_line *line, uint32_t address, uint32_t value,
                                      unsigned bytes) {
  line->written |= trax_overlay_bits(address, bytes);
  if (__builtin_expect(bytes == sizeof value, true))
    memcpy(line->bytes + address % TRAX_OVERLAY_BYTES, &value, sizeof value);
  else
    memcpy(line->bytes + address % TRAX_OVERLAY_BYTES, &value, bytes);
}

#endif
