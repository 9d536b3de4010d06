/* Files that are read completely into memory. */
#ifndef TRAX_INPUT_H
#define TRAX_INPUT_H

#include "trax/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The limit, in bytes, of text files that people write: configurations, views, materials. The project's largest one has
   a hundredth of it. */
#define TRAX_TEXT_LIMIT ((size_t)1 << 20)

/* A file that is read piece by piece. */
typedef struct trax_input {
  const char *path; /* for messages */
  int descriptor;
  bool is_regular; /* neither a pipe nor a device */
  uint8_t *bytes;  /* from malloc, with a NUL after the last byte */
  size_t size, capacity;
  size_t expected; /* the file's size when it was opened, if it is regular; else 0 */
} trax_input;

trax_status trax_input_open(trax_input *input, const char *path, trax_error *error);
/* As trax_input_open, of a path that stays beneath a folder (trax/beneath.h). shown: the path in messages. */
trax_status trax_input_open_beneath(trax_input *input, int folder, const char *path, const char *shown,
                                    trax_error *error);
/* Reads until `size` bytes or the whole file are in memory. Returns TRAX_INTERRUPTED if a signal arrives while it waits
   for a pipe or a terminal (trax/signals.h). */
trax_status trax_input_read(trax_input *input, size_t size, trax_error *error);
/* Closes the file and releases its bytes. A caller that keeps the bytes sets input->bytes to NULL before. */
void trax_input_close(trax_input *input);

/* Reads a file of at most limit bytes whole and closes it, whether trax_input_open succeeded (`opened`) or not.
 *bytes and *size as trax_read_file. */
trax_status trax_input_read_all(trax_input *input, trax_status opened, size_t limit, uint8_t **bytes, size_t *size,
                                trax_error *error);
/* Reads a whole file of at most limit bytes. *bytes is from malloc, has a NUL after the last byte, and belongs to the
   caller. */
trax_status trax_read_file(const char *path, size_t limit, uint8_t **bytes, size_t *size, trax_error *error);

#endif
