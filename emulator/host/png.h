/* Pictures of --dump SYMBOL=FILE.png:WIDTHxHEIGHT. */
#ifndef TRAX_HOST_PNG_H
#define TRAX_HOST_PNG_H

#include <stdint.h>

#include "trax/status.h"

/* Writes a picture row by row from the top left. A pixel has four bytes: red, green, blue, and one that is ignored. */
trax_status trax_png_write(const char *path, const uint8_t *pixels, uint32_t width, uint32_t height, trax_error *error);

#endif
