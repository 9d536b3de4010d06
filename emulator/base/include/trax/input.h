/* Files that are read whole. */
#ifndef TRAX_INPUT_H
#define TRAX_INPUT_H

#include "trax/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The most that a text which people write may have: configurations, views, materials. The largest of the project has a
   hundredth of it. */
#define TRAX_TEXT_LIMIT ((size_t)1 << 20)

/* A file that is read bit by bit. */
typedef struct trax_input {
  const char *path; /* for messages */
  int descriptor;
  bool is_regular; /* no pipe, no device */
  uint8_t *bytes;  /* from malloc, with a NUL behind the last */
  size_t size, capacity;
  size_t expected; /* its size when it was opened, if it is regular */
} trax_input;

trax_status trax_input_open(trax_input *input, const char *path, trax_error *error);
/* Reads on until there are `size` bytes, or all. What is no regular file (a pipe, a terminal) is waited for until a
   signal comes (trax/signals.h): TRAX_INTERRUPTED. */
trax_status trax_input_read(trax_input *input, size_t size, trax_error *error);
/* Closes it; its bytes are released unless they were taken (and set to NULL). */
void trax_input_close(trax_input *input);

/* A whole file of at most limit bytes. *bytes is from malloc, has a NUL behind the last byte, and is the caller's. */
trax_status trax_read_file(const char *path, size_t limit, uint8_t **bytes, size_t *size, trax_error *error);

#endif
