/* Radiance's HDR pictures: a header of lines, then rows of pixels with one exponent for three mantissas, plain or
   packed by runs (Ward, "Real pixels", Graphics Gems II, 1991). */
#include "radiance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct reader {
  const uint8_t *at, *end;
};

static const char magic[] = "#?";

bool trax_is_hdr(const uint8_t *bytes, size_t size) {
  return size > 10 && memcmp(bytes, magic, sizeof magic - 1) == 0;
}

/* A line without its end; false if there is none of fewer than 256 bytes. */
static bool take_line(char line[256], struct reader *reader) {
  size_t length = 0;
  while (reader->at < reader->end && *reader->at != '\n' && length < 255)
    line[length++] = (char)*reader->at++;
  line[length] = 0;
  if (reader->at == reader->end || *reader->at != '\n')
    return false;
  reader->at++;
  return true;
}

/* One mantissa of each pixel of a row, by runs: a count above 128 is of one byte that repeats. */
static bool take_runs(uint8_t *row, uint32_t width, struct reader *reader) {
  for (uint32_t x = 0; x < width;) {
    if (reader->end - reader->at < 2)
      return false;
    const unsigned code = *reader->at++;
    const uint32_t count = code > 128 ? code - 128 : code;
    if (count == 0 || count > width - x || (code <= 128 && (size_t)(reader->end - reader->at) < count))
      return false;
    for (uint32_t i = 0; i < count; i++)
      row[4 * x++] = code > 128 ? *reader->at : reader->at[i];
    reader->at += code > 128 ? 1 : count;
  }
  return true;
}

/* Plain pixels, in which 1, 1, 1, n repeats the one before n times; n of the next ones counts 256 times as much. */
static bool take_plain(uint8_t *row, uint32_t width, struct reader *reader) {
  unsigned shift = 0;
  for (uint32_t x = 0; x < width;) {
    if (reader->end - reader->at < 4)
      return false;
    const uint8_t *pixel = reader->at;
    reader->at += 4;
    if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
      memcpy(row + 4 * (size_t)x++, pixel, 4);
      shift = 0;
      continue;
    }
    const uint64_t count = shift > 24 ? UINT64_MAX : (uint64_t)pixel[3] << shift;
    if (x == 0 || count > width - x)
      return false;
    for (uint64_t i = 0; i < count; i++, x++)
      memcpy(row + 4 * (size_t)x, row + 4 * (size_t)(x - 1), 4);
    shift += 8;
  }
  return true;
}

static bool take_row(uint8_t *row, uint32_t width, struct reader *reader) {
  const uint8_t *at = reader->at;
  if (width < 8 || width > 0x7FFF || reader->end - at < 4 || at[0] != 2 || at[1] != 2 ||
      (at[2] << 8 | at[3]) != (int)width)
    return take_plain(row, width, reader);
  reader->at += 4;
  for (int channel = 0; channel < 4; channel++)
    if (!take_runs(row + channel, width, reader))
      return false;
  return true;
}

static trax_status take_header(double *exposure, uint32_t *width, uint32_t *height, struct reader *reader,
                               const char *name, trax_error *error) {
  char line[256];
  bool known = false;
  *exposure = 1;
  do {
    double value;
    if (!take_line(line, reader))
      return trax_fail(error, "%s: an HDR picture whose header does not end", name);
    known |= strcmp(line, "FORMAT=32-bit_rle_rgbe") == 0;
    if (sscanf(line, "EXPOSURE=%lf", &value) == 1)
      *exposure *= value;
  } while (line[0]);
  if (!known || !(*exposure > 0 && isfinite(*exposure)))
    return trax_fail(error, "%s: an HDR picture of another format than 32-bit_rle_rgbe, or without exposure", name);
  if (!take_line(line, reader) || sscanf(line, "-Y %u +X %u", height, width) != 2)
    return trax_fail(error, "%s: an HDR picture whose rows do not go down from the left: \"%.40s\"", name, line);
  return TRAX_OK;
}

/* Whether a file of so many bytes may have so many pixels. Packed rows have at most 64 a byte; plain pixels that repeat
   may have more, and a small file of them would take gigabytes. */
static bool has_room(size_t bytes, uint32_t width, uint32_t height) {
  return (uint64_t)width * height / 256 <= bytes || width > TRAX_RENDER_MAX_SIDE || height > TRAX_RENDER_MAX_SIDE;
}

trax_status trax_hdr_decode(struct trax_picture *picture, const uint8_t *bytes, size_t size, const char *name,
                            trax_error *error) {
  struct reader reader = {bytes, bytes + size};
  uint32_t width = 0, height = 0;
  double exposure;
  if (take_header(&exposure, &width, &height, &reader, name, error) != TRAX_OK)
    return TRAX_ERROR;
  if (!has_room(size, width, height))
    return trax_fail(error, "%s: an HDR picture of %u x %u pixels in %zu bytes is cut off or damaged", name, width,
                     height, size);
  if (trax_radiance_allocate(picture, width, height, name, error) != TRAX_OK)
    return TRAX_ERROR;
  uint8_t *row = malloc(4 * (size_t)width);
  trax_status status = row ? TRAX_OK : trax_fail(error, "%s: out of memory", name);
  for (uint32_t y = 0; y < height && status == TRAX_OK; y++) {
    if (!take_row(row, width, &reader))
      status =
          trax_fail(error, "%s: row %u of an HDR picture of %u x %u is cut off or damaged", name, y, width, height);
    for (uint32_t x = 0; x < width && status == TRAX_OK; x++)
      for (uint32_t channel = 0; channel < 3 && row[4 * x + 3]; channel++)
        picture->radiance[3 * ((size_t)y * width + x) + channel] =
            (float)(ldexp(row[4 * x + channel] + 0.5, row[4 * x + 3] - 136) / exposure);
  }
  free(row);
  return status;
}
