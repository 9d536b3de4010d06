#include "host/png.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "trax/output.h"

enum { CHANNELS = 3, FILTER_UP = 2 };

/* Each row as its differences from the row above, three bytes for a pixel, behind the number of this filter. Returns
   NULL if memory is short. */
static uint8_t *filter(const uint8_t *pixels, uint32_t width, uint32_t height) {
  uint8_t *const rows = malloc(((size_t)width * CHANNELS + 1) * height), *to = rows;
  const uint8_t *above = NULL;
  for (uint32_t y = 0; rows && y < height; y++, above = pixels, pixels += (size_t)4 * width) {
    *to++ = FILTER_UP;
    for (size_t x = 0; x < width; x++)
      for (size_t i = 0; i < CHANNELS; i++)
        *to++ = (uint8_t)(pixels[4 * x + i] - (above ? above[4 * x + i] : 0));
  }
  return rows;
}

static void set_word(uint8_t bytes[4], uint32_t word) {
  for (unsigned i = 0; i < 4; i++)
    bytes[i] = (uint8_t)(word >> (24 - 8 * i));
}

static void put_word(FILE *file, uint32_t word) {
  uint8_t bytes[4];
  set_word(bytes, word);
  fwrite(bytes, 1, sizeof bytes, file);
}

static void put_chunk(FILE *file, const char name[4], const uint8_t *bytes, size_t size) {
  put_word(file, (uint32_t)size);
  fwrite(name, 1, 4, file);
  if (size)
    fwrite(bytes, 1, size, file);
  const uLong sum = crc32_z(0, (const uint8_t *)name, 4);
  put_word(file, (uint32_t)(size ? crc32_z(sum, bytes, size) : sum));
}

trax_status trax_png_write(const char *path, const uint8_t *pixels, uint32_t width, uint32_t height,
                           trax_error *error) {
  uint8_t header[13] = {[8] = 8 /* bits */, [9] = 2 /* red, green, blue */};
  const size_t size = ((size_t)width * CHANNELS + 1) * height;
  uint8_t *rows = filter(pixels, width, height);
  uLongf packed_size = compressBound(size);
  uint8_t *packed = malloc(packed_size);
  trax_output output;
  set_word(header, width);
  set_word(header + 4, height);
  trax_status status = rows && packed && compress(packed, &packed_size, rows, size) == Z_OK
                           ? trax_output_open(&output, path, error)
                           : trax_fail(error, "%s: out of memory", path);
  if (status == TRAX_OK) {
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, output.file);
    put_chunk(output.file, "IHDR", header, sizeof header);
    put_chunk(output.file, "IDAT", packed, packed_size);
    put_chunk(output.file, "IEND", NULL, 0);
    status = trax_output_commit(&output, error); /* which reports an error of the file */
  }
  free(rows);
  free(packed);
  return status;
}
