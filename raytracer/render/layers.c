/* Layers of a picture, from the first ray through each pixel. */
#include "layers.h"

#include "placed.h"

#include "../device/camera.h"

#include <stdlib.h>

trax_status trax_layers_init(struct trax_picture *picture, const struct trax_frame *frame, trax_error *error) {
  const size_t pixels = (size_t)picture->width * picture->height;
  const bool shaded = !(frame->params->features & TRAX_PATH_FEATURES); /* else a picture of floats has them already */
  picture->layers = calloc(pixels, sizeof *picture->layers);
  if (shaded && !picture->radiance)
    picture->radiance = calloc(3 * pixels, sizeof *picture->radiance);
  if (picture->layers && (picture->radiance || !shaded))
    return TRAX_OK;
  trax_picture_release(picture);
  return trax_fail(error, "out of memory for the layers of %u x %u pixels", frame->params->width,
                   frame->params->height);
}

uint64_t trax_record_bytes(const struct trax_render_params *params) {
  return (uint64_t)params->width * params->height *
         (sizeof(struct trax_pixel_record) + params->samples * sizeof(struct trax_sample_record));
}

trax_status trax_layers_take(struct trax_picture *picture, const struct trax_frame *frame, const void *record,
                             trax_error *error) {
  const size_t pixels = (size_t)picture->width * picture->height;
  const struct trax_pixel_record *channels = record;
  const struct trax_sample_record *samples = (const struct trax_sample_record *)(channels + pixels);
  if (trax_layers_init(picture, frame, error) != TRAX_OK)
    return TRAX_ERROR;
  for (size_t i = 0; i < pixels; i++) {
    const struct trax_sample_record *first = &samples[i * frame->params->samples];
    picture->layers[i].triangle = trax_number_of_hit(frame->scene, first->triangle, first->instance);
    picture->layers[i].shadow = first->shadow;
    if (frame->params->features & TRAX_PATH_FEATURES)
      continue;
    for (int channel = 0; channel < 3; channel++) {
      const double root = (double)channels[i].channel[channel] / 255;
      picture->radiance[3 * i + (size_t)channel] = (float)(root * root);
    }
  }
  return TRAX_OK;
}

/* Along the ray, to a triangle's plane. */
static void find_plane(struct trax_layers *layers, const struct trax_frame *frame, struct pixel pixel, int scaled) {
  struct placed_triangle placed;
  trax_place(&placed, frame->scene, layers->triangle);
  const struct trax_triangle *triangle = &placed.triangle;
  const struct vector camera = camera_direction(frame->params, pixel, sample_place(0));
  const struct double3 direction = {camera.x, camera.y, camera.z}, v0 = from(triangle->v0),
                       normal = cross(minus(from(triangle->v1), v0), minus(from(triangle->v2), v0));
  const double slope = dot(normal, direction), size = copysign(sqrt(dot(normal, normal)), -slope);
  layers->depth =
      (float)ldexp(dot(normal, minus(v0, from(frame->params->eye))) / slope * sqrt(dot(direction, direction)), -scaled);
  layers->normal[0] = (float)(normal.x / size);
  layers->normal[1] = (float)(normal.y / size);
  layers->normal[2] = (float)(normal.z / size);
}

void trax_layers_finish(struct trax_picture *picture, const struct trax_frame *frame, int scaled) {
  for (uint32_t y = 0; y < picture->height; y++)
    for (uint32_t x = 0; x < picture->width; x++) {
      struct trax_layers *layers = &picture->layers[(size_t)y * picture->width + x];
      const uint32_t number = layers->triangle;
      if (number != TRAX_NO_TRIANGLE)
        find_plane(layers, frame, pixel_at(x, y), scaled);
      layers->triangle = 1 + (number == TRAX_NO_TRIANGLE ? number : trax_source_of(frame->scene, number));
    }
}

void trax_layers_compare(struct trax_layers_difference *difference, const struct trax_picture *picture,
                         const struct trax_picture *right) {
  *difference = (struct trax_layers_difference){0};
  for (size_t i = 0; i < (size_t)picture->width * picture->height; i++) {
    const struct trax_layers *is = &picture->layers[i], *should = &right->layers[i];
    if (is->triangle != should->triangle) {
      const double apart = fabs((double)is->depth - (double)should->depth);
      uint64_t *kind = !should->triangle                                 ? &difference->grown
                       : !is->triangle                                   ? &difference->missed
                       : apart <= TRAX_TIE * fabs((double)should->depth) ? &difference->tied
                                                                         : &difference->other;
      ++*kind;
      if (kind != &difference->tied)
        continue;
    }
    difference->shadow += (is->shadow == TRAX_SHADOW_LIT) != (should->shadow == TRAX_SHADOW_LIT);
  }
  difference->wrong = difference->missed + difference->grown + difference->other;
}
