#include "host/png.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "trax/output.h"

enum { RGB = 2, BITS = 8, HEADER = 13, CHANNELS = 3, CHUNK = 1 << 30 };

static void put_32(uint8_t *to, uint32_t value) {
  for (int i = 0; i < 4; ++i)
    to[i] = (uint8_t)(value >> (24 - 8 * i));
}

static void write_chunk(FILE *file, const char *type, const uint8_t *bytes, uint32_t size) {
  uint8_t word[4];
  put_32(word, size);
  fwrite(word, 1, sizeof word, file);
  fwrite(type, 1, 4, file);
  fwrite(bytes, 1, size, file);
  put_32(word, (uint32_t)crc32(crc32(0, (const uint8_t *)type, 4), bytes, size));
  fwrite(word, 1, sizeof word, file);
}

/* The rows, each with a zero before it: it is not filtered. Returns NULL if memory is short. */
static uint8_t *rows_of(const uint8_t *pixels, uint32_t width, uint32_t height) {
  uint8_t *rows = malloc(((size_t)width * CHANNELS + 1) * height), *to = rows;
  for (uint32_t y = 0; rows && y < height; ++y) {
    *to++ = 0;
    for (uint32_t x = 0; x < width; ++x, pixels += 4, to += CHANNELS)
      memcpy(to, pixels, CHANNELS);
  }
  return rows;
}

trax_status trax_png_write(const char *path, const uint8_t *pixels, uint32_t width, uint32_t height,
                           trax_error *error) {
  static const uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  uint8_t header[HEADER] = {[8] = BITS, [9] = RGB};
  put_32(header, width);
  put_32(header + 4, height);
  const uLong size = ((uLong)width * CHANNELS + 1) * height;
  uLongf packed_size = compressBound(size);
  uint8_t *rows = rows_of(pixels, width, height), *packed = rows ? malloc(packed_size) : NULL;
  trax_status status = TRAX_OK;
  trax_output output;
  if (!packed || compress(packed, &packed_size, rows, size) != Z_OK)
    status = trax_fail(error, "%s: out of memory", path);
  else
    status = trax_output_open(&output, path, error);
  if (status == TRAX_OK) {
    fwrite(signature, 1, sizeof signature, output.file);
    write_chunk(output.file, "IHDR", header, sizeof header);
    for (uLongf at = 0; at < packed_size; at += CHUNK) /* a chunk's length has 31 bits */
      write_chunk(output.file, "IDAT", packed + at, (uint32_t)(packed_size - at < CHUNK ? packed_size - at : CHUNK));
    write_chunk(output.file, "IEND", header, 0); /* crc32 takes no NULL */
    status = trax_output_commit(&output, error);
  }
  free(packed);
  free(rows);
  return status;
}
