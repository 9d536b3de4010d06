/* The places of an instance's triangles (struct trax_instance). Only for programs compiled with TRAX_INSTANCES. */
#ifndef TRAX_DEVICE_PLACED_H
#define TRAX_DEVICE_PLACED_H

#include "algebra.h"
#include "bits.h"
#include "trax/scene_format.h"

#include <stdbool.h>

static inline const struct trax_instance *instance_at(const char *record) {
  return (const struct trax_instance *)(const void *)record;
}

/* rows (vector) */
static inline struct vector turned_by(const float rows[3][3], struct vector v) {
  return (struct vector){rows[0][0] * v.x + rows[0][1] * v.y + rows[0][2] * v.z,
                         rows[1][0] * v.x + rows[1][1] * v.y + rows[1][2] * v.z,
                         rows[2][0] * v.x + rows[2][1] * v.y + rows[2][2] * v.z};
}

/* A point of an instance's mesh, in the scene. */
static inline struct vector placed_point(const char *record, const float *point) {
  const struct trax_instance *instance = instance_at(record);
  return plus(turned_by(instance->to_world, load_vector(point)), load_vector(instance->origin));
}

/* The bits of a coordinate of a triangle's corners, as placed_point gives it. */
static inline int32_t placed_coordinate(const char *triangle, const char *record, uint32_t number) {
  uint32_t corner = number > 5 ? 6 : number > 2 ? 3 : 0, row = number - corner;
  const struct trax_instance *instance = instance_at(record);
  const float *v = (const float *)(const void *)triangle + corner, *a = instance->to_world[row];
  return float_bits(a[0] * v[0] + a[1] * v[1] + a[2] * v[2] + instance->origin[row]);
}

/* The order of triangle.h's comes_first, of the vertices as they are in the scene. Of triangles at one place, the first
   in the order of import comes first. */
static inline __attribute__((always_inline)) bool placed_first(const char *triangle, const char *record,
                                                               const char *other, const char *other_record) {
  KEEP_ROLLED
  for (uint32_t i = 0; i < 9; i++) {
    const int32_t bits = placed_coordinate(triangle, record, i), other_bits = placed_coordinate(other, other_record, i);
    if (bits != other_bits)
      return (uint32_t)bits < (uint32_t)other_bits;
  }
  if (record != other_record)
    return instance_at(record)->first_source < instance_at(other_record)->first_source;
  return triangle < other;
}

#endif
