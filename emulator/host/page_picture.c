#include "host/shown.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t bytes_of(const struct trax_shown *shown) {
  return shown->is_float ? 3 * sizeof(float) : sizeof(uint32_t);
}

trax_status trax_shown_find(struct trax_shown *shown, struct trax_explain_options *explain,
                            const struct trax_options *options, trax_machine *machine, trax_error *error) {
  *shown = (struct trax_shown){0};
  if (!explain->explore)
    return TRAX_OK;
  if (options->manifest &&
      !trax_manifest_picture(options->manifest, &shown->symbol, &shown->width, &shown->height, &shown->is_float))
    shown->symbol = NULL;
  for (size_t i = 0; i < options->assignment_count; i++) {
    const struct trax_assignment *dump = &options->assignments[i];
    if (dump->kind == TRAX_ASSIGN_DUMP && dump->width)
      *shown = (struct trax_shown){.symbol = dump->name, .width = dump->width, .height = dump->height};
  }
  if (!shown->symbol || (explain->item_buffer && strcmp(explain->item_buffer, shown->symbol) != 0)) {
    shown->symbol = NULL; /* items have other places than this picture's pixels */
    return TRAX_OK;
  }
  const uint8_t *bytes;
  uint32_t size;
  if (trax_machine_read_buffer(machine, shown->symbol, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  if (size != (uint64_t)shown->width * shown->height * bytes_of(shown))
    return trax_fail(error, "the manifest's picture of %ux%u pixels of %u bytes is not the buffer %s of %u bytes",
                     shown->width, shown->height, bytes_of(shown), shown->symbol, size);
  explain->item_buffer = shown->symbol;
  explain->item_bytes = bytes_of(shown);
  return TRAX_OK;
}

/* Gamma 2, as trax-render's PNG has it. */
static uint32_t pixel_of(const float *radiance) {
  uint32_t pixel = 0;
  for (int channel = 0; channel < 3; channel++)
    pixel |= (uint32_t)(255 * sqrt(fmin(fmax((double)radiance[channel], 0), 1)) + 0.5) << 8 * channel;
  return pixel;
}

trax_status trax_shown_give(struct trax_shown *shown, trax_machine *machine, struct trax_explain *explain,
                            trax_error *error) {
  const uint8_t *bytes;
  uint32_t size;
  if (!shown->symbol)
    return TRAX_OK;
  const size_t count = (size_t)shown->width * shown->height;
  if (trax_machine_read_buffer(machine, shown->symbol, &bytes, &size, error) != TRAX_OK)
    return TRAX_ERROR;
  shown->pixels = malloc(count * sizeof *shown->pixels);
  if (!shown->pixels)
    return trax_fail(error, "out of memory for a picture of %ux%u", shown->width, shown->height);
  if (!shown->is_float)
    memcpy(shown->pixels, bytes, size);
  for (size_t i = 0; i < count && shown->is_float; i++) {
    float radiance[3];
    memcpy(radiance, bytes + i * sizeof radiance, sizeof radiance);
    shown->pixels[i] = pixel_of(radiance);
  }
  trax_explain_picture(explain, &(struct trax_explore_picture){shown->width, shown->height, shown->pixels, {{0}}});
  return TRAX_OK;
}

void trax_shown_release(struct trax_shown *shown) {
  free(shown->pixels);
  *shown = (struct trax_shown){0};
}
