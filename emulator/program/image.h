/* An executable, independent of a machine: checked segments, symbols and, on demand, source lines. docs/emulator.md,
   "Loading", lists the checks. */
#ifndef TRAX_PROGRAM_IMAGE_H
#define TRAX_PROGRAM_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trax/emulator.h"

struct trax_load_segment {
  uint32_t address;
  uint32_t memory_bytes; /* the file's bytes, then zeros */
  uint32_t file_bytes;
  const uint8_t *bytes; /* into the image */
  unsigned permissions; /* TRAX_PERMIT_READ | ... */
};

struct trax_symbol {
  const char *name; /* into the image */
  uint32_t address;
  uint32_t bytes; /* 0: unknown */
  bool global;
  bool absolute; /* a number, not an address */
  enum { TRAX_SYMBOL_PLAIN, TRAX_SYMBOL_FUNCTION, TRAX_SYMBOL_OBJECT, TRAX_SYMBOL_THREAD_LOCAL } type;
};

typedef struct trax_image trax_image;

/* Opens a TRaX executable. NULL, with the reason in *error: the file is not a complete, consistent one. */
trax_image *trax_image_open(const char *path, trax_error *error);
/* Opens an executable whose bytes are given, and copies them. path: for messages. */
trax_image *trax_image_of(const char *path, const uint8_t *bytes, size_t size, trax_error *error);
void trax_image_close(trax_image *image);

const char *trax_image_path(const trax_image *image);
/* The file. */
const uint8_t *trax_image_bytes(const trax_image *image, size_t *size);
uint32_t trax_image_entry(const trax_image *image);
const struct trax_load_segment *trax_image_segments(const trax_image *image, size_t *count);
const struct trax_symbol *trax_image_symbols(const trax_image *image, size_t *count);

/* Finds a defined symbol by name, a global one before a local one; NULL if there is none. */
const struct trax_symbol *trax_image_symbol(const trax_image *image, const char *name);
/* Finds the symbol that contains an address; NULL if there is none. */
const struct trax_symbol *trax_image_symbol_at(const trax_image *image, uint32_t address);

struct trax_source_line {
  const char *function; /* the innermost, inlined ones included; NULL if unknown */
  const char *file;
  int line, column;    /* 0: unknown */
  const char *linkage; /* the function's name to the linker; NULL if unknown */
  int function_line;   /* where the function begins; 0 if unknown */
  int discriminator;   /* of blocks of one line, in LLVM's encoding */
};

/* Finds the source lines of an instruction: [0] is the line itself, and [i] the line of the call through which the
   function of [i - 1] was inlined. Returns their number, at most capacity; 0 without debug information. The strings are
   valid as long as the image. */
size_t trax_image_lines(trax_image *image, uint32_t pc, struct trax_source_line *lines, size_t capacity);

/* Calls visit for every function whose frame has a size that the compiler stated (docs/abi.md, "Stack sizes"). */
void trax_image_frames(const trax_image *image, void (*visit)(void *context, uint32_t function, uint32_t bytes),
                       void *context);

/* An automatic variable: its place as distances from a register. */
struct trax_frame_variable {
  const char *name; /* valid as long as the image */
  int32_t begin, end;
  bool is_array;
};

/* Finds the variables that have one place in the frame of the function at pc, if it is of C, also those of inlined
   functions. Returns their number and, in *items, an array from malloc; *base: the register from which their distances
   count. */
size_t trax_image_variables(trax_image *image, uint32_t pc, struct trax_frame_variable **items, unsigned *base);

/* Returns how many compilation folders the debug information names, and sets *folders to them. They are as it says, and
   valid as long as the image. */
size_t trax_image_folders(trax_image *image, const char *const **folders);

#endif
