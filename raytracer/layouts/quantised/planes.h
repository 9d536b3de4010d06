#include "../numbers.h"

/* Planes are numbers of 16 bits on one grid for the whole scene.

   The bits of a plane's number are used as a float: a subnormal, the number times 2^-149, which this machine multiplies
   like any other. So conversion takes no instruction, but 2^149 must be in the factors:
   distances along the ray are in units of 2^64 here, which keeps all of them within the range of floats as long as the
   direction's largest component is within 2^-2 and 2^10 and cells within 2^-44 and 2^6 (trax_normalise). */
enum { quantised_unit = 64 };

static inline void quantised_prepare(struct box_ray *box, struct vector origin, struct vector inverse,
                                     struct vector margin, const struct trax_ray_grid *grid) {
  const float unit = 0x1p-64f; /* the reciprocal of the unit of distances */
  struct vector cell = times(unit, load_vector(grid->cell)), step = times(unit, inverse);
  struct vector from = minus(origin, load_vector(grid->origin));
  box->near_origin = filtered(plus(from, margin), step);
  box->far_origin = filtered(minus(from, margin), step);
  box->inverse = times(0x1p74f, times(0x1p75f, filtered(inverse, cell)));
}

static inline int32_t quantised_plane(const char *plane, float origin, float inverse) {
  return float_bits(times_plane(*(const uint16_t *)(const void *)plane, inverse) - origin);
}
