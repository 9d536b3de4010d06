/* An executable as the loader sees it: checked segments, symbols and, on demand, source lines. Independent of a
   machine; what the checks are is in docs/emulator.md, "Loading". */
#ifndef TRAX_PROGRAM_IMAGE_H
#define TRAX_PROGRAM_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trax/emulator.h"

struct trax_load_segment {
  uint32_t address;
  uint32_t memory_bytes; /* zeros behind the file's bytes */
  uint32_t file_bytes;
  const uint8_t *bytes; /* into the image */
  unsigned permissions; /* TRAX_PERMIT_READ | ... */
};

struct trax_symbol {
  const char *name; /* into the image */
  uint32_t address;
  uint32_t bytes; /* 0: unknown */
  bool global;
  bool absolute; /* a number, not a place */
  enum { TRAX_SYMBOL_PLAIN, TRAX_SYMBOL_FUNCTION, TRAX_SYMBOL_OBJECT, TRAX_SYMBOL_THREAD_LOCAL } type;
};

typedef struct trax_image trax_image;

/* NULL, with the reason in *error, for anything but a complete, consistent TRaX executable. */
trax_image *trax_image_open(const char *path, trax_error *error);
void trax_image_close(trax_image *image);

const char *trax_image_path(const trax_image *image);
uint32_t trax_image_entry(const trax_image *image);
const struct trax_load_segment *trax_image_segments(const trax_image *image, size_t *count);
const struct trax_symbol *trax_image_symbols(const trax_image *image, size_t *count);

/* A defined symbol by name, a global one before a local one; NULL if there is none. */
const struct trax_symbol *trax_image_symbol(const trax_image *image, const char *name);
/* The symbol an address belongs to, and NULL if no symbol claims it. */
const struct trax_symbol *trax_image_symbol_at(const trax_image *image, uint32_t address);

struct trax_source_line {
  const char *function; /* the innermost, inlined ones included; NULL if unknown */
  const char *file;
  int line, column; /* 0: unknown */
};

/* Where in the source an instruction comes from: [0] is the place itself, [i] the call that [i - 1] was inlined
   through, innermost first. Returns how many of at most capacity there are; 0 without debug information. Strings live
   as long as the image. */
size_t trax_image_lines(trax_image *image, uint32_t pc, struct trax_source_line *lines, size_t capacity);

/* The bytes of an executable as far as its headers say that it goes, from malloc: a device that never ends is read no
   further. What is no executable is left to trax_image_open to refuse. */
trax_status trax_image_read(const char *path, uint8_t **bytes, size_t *size, trax_error *error);

#endif
