/* Vectors in binary64, for Embree's pictures. */
#ifndef TRAX_RENDER_DOUBLE3_H
#define TRAX_RENDER_DOUBLE3_H

#include <math.h>

struct double3 {
  double x, y, z;
};

static inline struct double3 from(const float v[3]) {
  return (struct double3){v[0], v[1], v[2]};
}
static inline struct double3 minus(struct double3 a, struct double3 b) {
  return (struct double3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline struct double3 plus_scaled(struct double3 a, double factor, struct double3 b) {
  return (struct double3){a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}
static inline double dot(struct double3 a, struct double3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline struct double3 cross(struct double3 a, struct double3 b) {
  return (struct double3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double greatest(struct double3 v) {
  return fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z));
}

#endif
