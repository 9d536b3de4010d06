/* Planes that are numbers: their bits are used as a subnormal float, the number times 2^-149. */
#ifndef TRAX_LAYOUTS_NUMBERS_H
#define TRAX_LAYOUTS_NUMBERS_H

#include <stdint.h>

/* number x 2^-149 x factor, rounded once. Binary64 has the exact product. The host's processor may take an assist of
   microcode, some 40 ns, to multiply a subnormal number; the TP does not. */
static inline float times_plane(uint16_t number, float factor) {
#ifdef __trax__
  return bits_float(number) * factor;
#else
  return (float)(number * 0x1p-149 * (double)factor);
#endif
}

/* The bits of a distance in units of 2^exponent. Nearly 0 becomes a little more. */
static inline int32_t distance_in_units(int32_t distance_bits, int exponent) {
  return larger(distance_bits - (exponent << 23), 0x00800000);
}

#endif
