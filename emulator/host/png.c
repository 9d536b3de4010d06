#include "host/png.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

#include "trax/output.h"

enum { CHANNELS = 3 };

/* Leaves out the fourth byte of each pixel. Returns NULL if memory is short. */
static uint8_t *colours_of(const uint8_t *pixels, size_t count) {
  uint8_t *colours = malloc(count * CHANNELS);
  for (size_t i = 0; colours && i < count; i++)
    memcpy(colours + i * CHANNELS, pixels + 4 * i, CHANNELS);
  return colours;
}

trax_status trax_png_write(const char *path, const uint8_t *pixels, uint32_t width, uint32_t height,
                           trax_error *error) {
  png_image image = {.version = PNG_IMAGE_VERSION, .width = width, .height = height, .format = PNG_FORMAT_RGB};
  uint8_t *colours = colours_of(pixels, (size_t)width * height);
  if (!colours)
    return trax_fail(error, "%s: out of memory", path);
  trax_output output;
  trax_status status = trax_output_open(&output, path, error);
  if (status == TRAX_OK && !png_image_write_to_stdio(&image, output.file, 0, colours, 0, NULL) &&
      !ferror(output.file)) { /* trax_output_commit reports an error of the file */
    status = trax_fail(error, "%s: %s", path, image.message);
    trax_output_discard(&output);
  } else if (status == TRAX_OK) {
    status = trax_output_commit(&output, error);
  }
  free(colours);
  return status;
}
