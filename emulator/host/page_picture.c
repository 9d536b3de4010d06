#include "host/page_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t bytes_of(const struct trax_page_picture *picture) {
  return picture->is_float ? 3 * sizeof(float) : sizeof(uint32_t);
}

trax_status trax_page_picture_find(struct trax_page_picture *picture, struct trax_explain_options *explain,
                                   const struct trax_options *options, trax_machine *machine, trax_error *error) {
  *picture = (struct trax_page_picture){0};
  if (!explain->explore)
    return TRAX_OK;
  if (options->manifest && !trax_manifest_picture(options->manifest, &picture->symbol, &picture->width,
                                                  &picture->height, &picture->is_float))
    picture->symbol = NULL;
  for (size_t i = 0; i < options->assignment_count; i++) {
    const struct trax_assignment *dump = &options->assignments[i];
    if (dump->kind == TRAX_ASSIGN_DUMP && dump->width)
      *picture = (struct trax_page_picture){.symbol = dump->name, .width = dump->width, .height = dump->height};
  }
  if (!picture->symbol || (explain->item_buffer && strcmp(explain->item_buffer, picture->symbol) != 0)) {
    picture->symbol = NULL; /* items have other places than this picture's pixels */
    return TRAX_OK;
  }
  const uint8_t *bytes;
  uint32_t size;
  if (trax_machine_read_buffer(machine, picture->symbol, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  if (size != (uint64_t)picture->width * picture->height * bytes_of(picture))
    return trax_fail(error, "the manifest's picture of %ux%u pixels of %u bytes is not the buffer %s of %u bytes",
                     picture->width, picture->height, bytes_of(picture), picture->symbol, size);
  explain->item_buffer = picture->symbol;
  explain->item_bytes = bytes_of(picture);
  return TRAX_OK;
}

/* Gamma 2, as trax-render's PNG has it. */
static uint32_t pixel_of(const float *radiance) {
  uint32_t pixel = 0;
  for (int channel = 0; channel < 3; channel++)
    pixel |= (uint32_t)(255 * sqrt(fmin(fmax((double)radiance[channel], 0), 1)) + 0.5) << 8 * channel;
  return pixel;
}

trax_status trax_page_picture_give(struct trax_page_picture *picture, trax_machine *machine,
                                   struct trax_explain *explain, trax_error *error) {
  const uint8_t *bytes;
  uint32_t size;
  if (!picture->symbol)
    return TRAX_OK;
  const size_t count = (size_t)picture->width * picture->height;
  if (trax_machine_read_buffer(machine, picture->symbol, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  picture->pixels = malloc(count * sizeof *picture->pixels);
  if (!picture->pixels)
    return trax_fail(error, "out of memory for a picture of %ux%u", picture->width, picture->height);
  if (!picture->is_float)
    memcpy(picture->pixels, bytes, size);
  for (size_t i = 0; i < count && picture->is_float; i++) {
    float radiance[3];
    memcpy(radiance, bytes + i * sizeof radiance, sizeof radiance);
    picture->pixels[i] = pixel_of(radiance);
  }
  trax_explain_picture(explain, &(struct trax_explore_picture){
                                    .width = picture->width, .height = picture->height, .pixels = picture->pixels});
  return TRAX_OK;
}

void trax_page_picture_release(struct trax_page_picture *picture) {
  free(picture->pixels);
  *picture = (struct trax_page_picture){0};
}
