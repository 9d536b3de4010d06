/* Global memory as the stores of an epoch have changed it, in lines of 32 bytes: a thread's stores are often
   neighbours. A table of them by number, which is emptied in a time that depends on the lines in use. */
#ifndef TRAX_FAST_WRITTEN_H
#define TRAX_FAST_WRITTEN_H

#include "machine/address_space.h"
#include "translate/burst.h"
#include "trax/grow.h"

#include <string.h>

#define TRAX_WRITTEN_BLOCK ((1u << TRAX_BLOCK) - 1) /* the bits of the bytes of a line's first block */
enum { TRAX_WRITTEN_BYTES = 32, TRAX_WRITTEN_SLOTS = 1024 };

struct trax_written_line {
  uint32_t number, next;  /* address / 32; the line after it in its slot, + 1; 0: there is none */
  uint32_t written, read; /* a bit for each byte */
  uint8_t bytes[TRAX_WRITTEN_BYTES];
  uint8_t writer[TRAX_WRITTEN_BYTES / 4]; /* of each word, for a merge */
};

struct trax_written {
  struct trax_written_line *lines; /* [count] */
  size_t count, capacity;
  uint32_t recent;                    /* the index of the line that was put most recently */
  uint32_t slots[TRAX_WRITTEN_SLOTS]; /* the number of the first line, + 1 */
};

static inline uint32_t *trax_written_slot(struct trax_written *written, uint32_t number) {
  return &written->slots[number * 0x9E3779B1u / (UINT32_MAX / TRAX_WRITTEN_SLOTS + 1)];
}

/* NULL: the line is not in use. */
static inline struct trax_written_line *trax_written_find(struct trax_written *written, uint32_t number) {
  for (uint32_t i = *trax_written_slot(written, number); i; i = written->lines[i - 1].next)
    if (written->lines[i - 1].number == number)
      return &written->lines[i - 1];
  return NULL;
}

/* Returns the line, which is empty if it has not been in use. NULL: out of memory. */
static inline struct trax_written_line *trax_written_put(struct trax_written *written, uint32_t number) {
  if (written->recent < written->count && written->lines[written->recent].number == number)
    return &written->lines[written->recent];
  struct trax_written_line *const found = trax_written_find(written, number);
  if (found) {
    written->recent = (uint32_t)(found - written->lines);
    return found;
  }
  if (!trax_grow((void **)&written->lines, written->count, &written->capacity, sizeof *written->lines))
    return NULL;
  uint32_t *const slot = trax_written_slot(written, number);
  written->recent = (uint32_t)written->count++;
  struct trax_written_line *const line = &written->lines[written->recent];
  *line = (struct trax_written_line){.number = number, .next = *slot};
  *slot = (uint32_t)written->count;
  return line;
}

static inline void trax_written_empty(struct trax_written *written) {
  while (written->count)
    *trax_written_slot(written, written->lines[--written->count].number) = 0;
}

/* Returns the bits of an aligned access. */
static inline uint32_t trax_written_bits(uint32_t address, unsigned bytes) {
  return ((1u << bytes) - 1) << address % TRAX_WRITTEN_BYTES;
}

/* Returns a byte of ones for each of four bits. */
static inline uint32_t trax_written_mask(uint32_t bits) {
  return ((bits & 15) * 0x204081 & 0x1010101) * 0xFF;
}

/* Writes those of a line's bytes that are in a mask. */
static inline void trax_written_copy(uint8_t *to, const uint8_t *from, uint32_t bits) {
  if (bits == UINT32_MAX) {
    memcpy(to, from, TRAX_WRITTEN_BYTES);
    return;
  }
  for (; bits; bits >>= 4, to += 4, from += 4) {
    uint32_t old, new;
    memcpy(&old, to, sizeof old);
    memcpy(&new, from, sizeof new);
    old ^= (old ^ new) & trax_written_mask(bits);
    memcpy(to, &old, sizeof old);
  }
}

/* Returns the bytes of an aligned access as the line and the memory before it have them. */
static inline uint32_t trax_written_load(const struct trax_written_line *line, const struct trax_space *space,
                                         uint32_t address, unsigned bytes) {
  uint32_t old, new;
  memcpy(&old, space->bytes + (address & ~3u), sizeof old);
  memcpy(&new, line->bytes + (address & 28), sizeof new);
  old ^= (old ^ new) & trax_written_mask(line->written >> (address & 28));
  return old >> address % 4 * 8 & UINT32_MAX >> (32 - 8 * bytes);
}

static inline void trax_written_store(struct trax_written_line *line, uint32_t address, uint32_t value,
                                      unsigned bytes) {
  uint32_t word;
  memcpy(&word, line->bytes + (address & 28), sizeof word);
  word ^= (word ^ value << address % 4 * 8) & trax_written_mask(trax_written_bits(address, bytes) >> (address & 28));
  memcpy(line->bytes + (address & 28), &word, sizeof word);
  line->written |= trax_written_bits(address, bytes);
}

#endif
