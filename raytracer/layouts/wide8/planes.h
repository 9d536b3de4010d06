#include "../numbers.h"

/* Planes are numbers of 8 bits in a frame of the node's own.

   As on the scene's grid (quantised/planes.h), the bits of a plane's number are used as a subnormal float. The factor
   has 2^149 by the frame's scale. Distances are in units of 2^72, because cells are larger than the grid's. */
enum { wide8_unit = 72 };

#define IN_WIDE8(member) ((int)__builtin_offsetof(struct trax_wide8_node, member))

static inline void wide8_prepare(struct box_ray *box, struct vector origin, struct vector inverse, struct vector margin,
                                 const struct trax_ray_grid *grid) {
  (void)grid;
  box->inverse = times(0x1p-72f, inverse);
  box->near_origin = plus(origin, margin);
  box->far_origin = minus(origin, margin);
}

static inline void enter_frame_along(const char *node, int axis, float *near_origin, float *far_origin,
                                     float *inverse) {
  const float first = load_float(node + IN_WIDE8(origin) + 4 * axis);
  const uint32_t scale = *(const uint8_t *)(node + IN_WIDE8(scale) + axis);
  *near_origin = (*near_origin - first) * *inverse;
  *far_origin = (*far_origin - first) * *inverse;
  *inverse = bits_float(float_bits(*inverse) + (int32_t)(scale << 23));
}

/* The ray as the planes of this node take it. */
static inline __attribute__((always_inline)) struct box_ray ray_in_frame(const struct box_ray *ray, const char *node) {
  struct box_ray box = *ray;
  enter_frame_along(node, 0, &box.near_origin.x, &box.far_origin.x, &box.inverse.x);
  enter_frame_along(node, 1, &box.near_origin.y, &box.far_origin.y, &box.inverse.y);
  enter_frame_along(node, 2, &box.near_origin.z, &box.far_origin.z, &box.inverse.z);
  return box;
}

static inline int32_t wide8_plane(const char *plane, float origin, float inverse) {
  return float_bits(times_plane(*(const uint8_t *)plane, inverse) - origin);
}
