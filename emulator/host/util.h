/* Small things the host side uses: files read whole; from base, names that were mistyped and files written whole. */
#ifndef TRAX_HOST_UTIL_H
#define TRAX_HOST_UTIL_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "trax/names.h"
#include "trax/output.h"

/* Reads a whole file of at most limit bytes. *bytes is allocated with malloc, has a NUL behind the last byte, and is
   the caller's. */
trax_status trax_read_file(const char *path, size_t limit, uint8_t **bytes, size_t *size, trax_error *error);

#endif
