#include "metrics.h"

#include "double3.h"

#include "../device/camera.h"

void trax_channel_errors(struct trax_channel_errors *errors, const double *picture, const double *reference,
                         size_t pixels) {
  double sum = 0, largest = 0;
  for (size_t i = 0; i < 3 * pixels; i++) {
    const double difference = fabs(picture[i] - reference[i]);
    sum += difference * difference;
    largest = fmax(largest, difference);
  }
  *errors = (struct trax_channel_errors){.rmse = pixels ? sqrt(sum / (3 * (double)pixels)) : 0, .largest = largest};
}

/* Along the ray, to a triangle's plane. */
static double plane_distance(const struct trax_triangle *triangle, struct double3 eye, struct double3 direction) {
  const struct double3 v0 = from(triangle->v0);
  const struct double3 normal = cross(minus(from(triangle->v1), v0), minus(from(triangle->v2), v0));
  return dot(normal, minus(v0, eye)) / dot(normal, direction);
}

/* The number of the triangle that the program names by its place; TRAX_NO_TRIANGLE for nothing, or for what is none. */
static uint32_t triangle_number(const struct trax_scene *scene, uint32_t place) {
  const struct trax_scene_section *section = &scene->header->sections[TRAX_SCENE_TRIANGLES];
  if (place < section->offset || (place - section->offset) / sizeof(struct trax_triangle) >= section->count)
    return TRAX_NO_TRIANGLE;
  return (place - section->offset) / (uint32_t)sizeof(struct trax_triangle);
}

/* A triangle may stand in the file several times. */
static bool same_triangle(const struct trax_scene *scene, uint32_t a, uint32_t b) {
  return a == b || (scene->source_ids && scene->source_ids[a] == scene->source_ids[b]);
}

void trax_hit_errors(struct trax_hit_errors *errors, const struct trax_exact *exact,
                     const struct trax_sample_record *recorded, const struct trax_frame *frame) {
  const struct trax_render_params *params = frame->params;
  *errors = (struct trax_hit_errors){.samples = (uint64_t)exact->width * exact->height * exact->samples};
  size_t i = 0;
  for (uint32_t y = 0; y < exact->height; y++)
    for (uint32_t x = 0; x < exact->width; x++) {
      uint64_t wrong = 0;
      for (uint32_t sample = 0; sample < exact->samples; sample++, i++) {
        const uint32_t should = exact->seen[i].triangle, is = triangle_number(frame->scene, recorded[i].triangle);
        if (should == TRAX_NO_TRIANGLE && is == TRAX_NO_TRIANGLE)
          continue;
        if (should == TRAX_NO_TRIANGLE) {
          wrong++, errors->grown++;
          continue;
        }
        if (is == TRAX_NO_TRIANGLE) {
          wrong++, errors->missed++;
          continue;
        }
        if (!same_triangle(frame->scene, is, should)) {
          const struct vector camera = camera_direction(params, pixel_at(x, y), sample_place(sample));
          const struct double3 direction = {camera.x, camera.y, camera.z};
          const double distance = plane_distance(&frame->scene->triangles[is], from(params->eye), direction);
          if (!(fabs(distance - exact->seen[i].distance) <= TRAX_TIE * exact->seen[i].distance)) {
            wrong++, errors->other++;
            continue;
          }
          errors->tied++;
        }
        errors->shadow += (recorded[i].shadow == TRAX_SHADOW_LIT) != (exact->seen[i].shadow == TRAX_SHADOW_LIT);
      }
      errors->wrong_pixels += wrong > 0;
    }
}
