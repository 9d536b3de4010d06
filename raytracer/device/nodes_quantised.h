/* Quantised nodes: planes are numbers of 16 bits on one grid for the whole scene (struct trax_quantised_node).

   The bits of a plane's number are used as a float: a subnormal, the number times 2^-149, which this machine multiplies
   like any other. So conversion takes no instruction, but 2^149 must be in the factors:
   distances along the ray are in units of 2^64 here, which keeps all of them within the range of floats as long as the
   direction's largest component is within 2^-2 and 2^10 and cells within 2^-44 and 2^6 (trax_normalise). */
#ifndef TRAX_DEVICE_NODES_QUANTISED_H
#define TRAX_DEVICE_NODES_QUANTISED_H

#include "algebra.h"
#include "nodes.h"
#include "trax/render_params.h"

#define GRID_EXPONENT 64

static inline void prepare_for_quantised(struct box_ray *box, struct vector origin, struct vector inverse,
                                         struct vector margin, const struct trax_ray_grid *grid) {
  const float unit = 0x1p-64f; /* the reciprocal of the unit of distances */
  struct vector cell = times(unit, load_vector(grid->cell)), step = times(unit, inverse);
  struct vector from = minus(origin, load_vector(grid->origin));
  box->near_origin = filtered(plus(from, margin), step);
  box->far_origin = filtered(minus(from, margin), step);
  box->inverse = times(0x1p74f, times(0x1p75f, filtered(inverse, cell)));
}

/* number x 2^-149 x factor, rounded once. Binary64 has the exact product. The host's processor may take an assist of
   microcode, some 40 ns, to multiply a subnormal number; the TP does not. */
static inline float times_plane(uint16_t number, float factor) {
#ifdef __trax__
  return bits_float(number) * factor;
#else
  return (float)(number * 0x1p-149 * (double)factor);
#endif
}

static inline int32_t quantised_plane(const char *plane, float origin, float inverse) {
  return float_bits(times_plane(*(const uint16_t *)(const void *)plane, inverse) - origin);
}

/* The bits of a distance in units of 2^exponent. Nearly 0 becomes a little more. */
static inline int32_t distance_in_units(int32_t distance_bits, int exponent) {
  return larger(distance_bits - (exponent << 23), 0x00800000);
}

#endif
