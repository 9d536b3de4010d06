/* A reader of DWARF sections: numbers of fixed size, and LEB128 (DWARF 5, section 7.6). */
#ifndef TRAX_PROGRAM_DWARF_READER_H
#define TRAX_PROGRAM_DWARF_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A read beyond `end` returns 0 or NULL and sets `bad`. */
typedef struct {
  const uint8_t *at, *end;
  bool bad;
} trax_dwarf_reader;

/* Returns the next `bytes` bytes and moves past them. */
static inline const uint8_t *trax_dwarf_take(trax_dwarf_reader *reader, uint64_t bytes) {
  const uint8_t *at = reader->at;
  if (bytes > (uint64_t)(reader->end - at)) {
    reader->bad = true;
    reader->at = reader->end;
    return NULL;
  }
  reader->at += bytes;
  return at;
}

/* Reads a little-endian number of at most 4 bytes. */
static inline uint32_t trax_dwarf_fixed(trax_dwarf_reader *reader, unsigned bytes) {
  uint32_t value = 0;
  const uint8_t *at = trax_dwarf_take(reader, bytes);
  for (unsigned i = 0; at && i < bytes; ++i)
    value |= (uint32_t)at[i] << 8 * i;
  return value;
}

/* Reads a LEB128 number; bits above 64 are dropped. */
static inline uint64_t trax_dwarf_leb(trax_dwarf_reader *reader, bool is_signed) {
  uint64_t value = 0;
  for (unsigned shift = 0;; shift += 7) {
    const uint8_t *at = trax_dwarf_take(reader, 1);
    if (!at)
      return 0;
    if (shift < 64)
      value |= (uint64_t)(*at & 0x7F) << shift;
    if (*at & 0x80)
      continue;
    if (is_signed && (*at & 0x40) && shift + 7 < 64)
      value |= ~(uint64_t)0 << (shift + 7);
    return value;
  }
}

#endif
