/* Whether a ray hits a triangle, and where, without error: for scenes in which binary32 cannot tell
   (TRAX_FEATURE_EXACT). Edge values, determinant and distance are sums of products of three floats. Each product is
   added, as an integer, to an accumulator as wide as all products (U. Kulisch, "Computer Arithmetic and Validity",
   2008), so that signs are certain and a quotient is rounded once. */
#ifndef TRAX_DEVICE_EXACT_H
#define TRAX_DEVICE_EXACT_H

#include "bits.h"

#include <stdbool.h>
#include <stdint.h>

/* In units of 2^-447, the product of three of the least floats. trax_normalise sees to it that no factor is beyond
   2^33: then the sum of 36 products has less than 32 * EXACT_WORDS bits. */
#define EXACT_WORDS 18

/* Functions of their own: they run rarely, and the traversal's registers stay free. */
#define EXACT_STEP static __attribute__((noinline, unused))

struct exact_ray {
  float origin[3], direction[3];
};

/* value * 2^exponent, but for a power of two that all sums have in common. */
struct exact_value {
  float value;
  int32_t exponent;
};

/* A float's digits as an integer. */
static inline uint32_t digits_of(uint32_t bits) {
  return (bits & 0x7FFFFFu) | (bits & 0x7F800000u ? 0x800000u : 0);
}

/* The exponent of the last of them, from that of 2^-149. */
static inline uint32_t weight_of(uint32_t bits) {
  uint32_t exponent = bits >> 23 & 255;
  return exponent ? exponent - 1 : 0;
}

/* *sum += a b c, or -= if the sign bit of `sign` is set. */
static inline void add_product(uint32_t *sum, uint32_t a, uint32_t b, uint32_t c, uint32_t sign) {
  uint32_t place = weight_of(a) + weight_of(b) + weight_of(c), shift = place & 31;
  uint64_t ab = (uint64_t)digits_of(a) * digits_of(b);
  uint64_t low = (ab & 0xFFFFFFFFu) * digits_of(c), high = (ab >> 32) * digits_of(c) + (low >> 32);
  uint32_t word[3] = {(uint32_t)low, (uint32_t)high, (uint32_t)(high >> 32)};
  /* Two's complement: of what is subtracted all bits are turned and one is added. */
  uint32_t turned = (uint32_t)((int32_t)(a ^ b ^ c ^ sign) >> 31), carry = turned & 1, below = 0;
  uint32_t *at = sum + (place >> 5), *end = sum + EXACT_WORDS;
  for (int i = 0; i < 4; i++) {
    uint32_t part = below;
    if (i < 3)
      part |= word[i] << shift, below = word[i] >> 1 >> (31 - shift);
    uint32_t old = *at, added = old + (part ^ turned), both = added + carry;
    carry = (added < old) | (both < added);
    *at++ = both;
  }
  KEEP_ROLLED
  for (; at != end && carry != (turned & 1); at++) {
    uint32_t both = *at + turned + carry;
    carry = turned ? *at != 0 : both == 0;
    *at = both;
  }
}

/* The sum of det(x, p, q), det(x, q, r) and det(x, r, p), or of the last of them alone. */
EXACT_STEP void add_determinants(uint32_t *sum, const float *x, const float *p, const float *q, const float *r,
                                 bool last_alone, uint32_t sign) {
  const float *corner[4] = {p, q, r, p};
  for (int i = last_alone ? 2 : 0; i < 3; i++) {
    const float *y = corner[i], *z = corner[i + 1];
    KEEP_ROLLED
    for (uint32_t term = 0; term < 6; term++) {
      uint32_t first = term >> 1, odd = term & 1, second = first + 1 + odd, third = first + 2 - odd;
      second -= second > 2 ? 3 : 0, third -= third > 2 ? 3 : 0;
      add_product(sum, (uint32_t)float_bits(x[first]), (uint32_t)float_bits(y[second]), (uint32_t)float_bits(z[third]),
                  sign ^ odd << 31);
    }
  }
}

/* What the sum is, to 2^-24 of it; it is 0 afterwards. */
EXACT_STEP struct exact_value take_sum(uint32_t *sum) {
  uint32_t negative = (uint32_t)((int32_t)sum[EXACT_WORDS - 1] >> 31), carry = negative & 1, high = 0, low = 0;
  int32_t top = 0;
  KEEP_ROLLED
  for (int32_t i = 0; i < EXACT_WORDS; i++) {
    uint32_t word = (sum[i] ^ negative) + carry;
    carry &= word == 0;
    sum[i] = 0;
    if (word)
      low = top == i - 1 ? high : 0, high = word, top = i;
  }
  if (high == 0)
    return (struct exact_value){0, 0};
  int32_t zeros = __builtin_clz(high);
  uint32_t bits = high << zeros | low >> 1 >> (31 - zeros);
  float value = (float)(int32_t)(bits >> 1);
  return (struct exact_value){bits_float(float_bits(value) | (int32_t)(negative & 0x80000000u)), 32 * top - zeros};
}

/* a / b; of what vanishes beside 1, 0. */
static inline float exact_quotient(struct exact_value a, struct exact_value b) {
  int32_t exponent = a.exponent - b.exponent;
  exponent = exponent < -252 ? -252 : exponent > 252 ? 252 : exponent;
  int32_t half = exponent >> 1;
  return a.value / b.value * bits_float((127 + half) << 23) * bits_float((127 + exponent - half) << 23);
}

static inline bool exactly_opposite(struct exact_value a, struct exact_value b) {
  return (float_bits(a.value) ^ float_bits(b.value)) < 0 && magnitude(a.value) != 0 && magnitude(b.value) != 0;
}

struct exact_result {
  float distance, weight1, weight2;
};

/* Edges and vertices belong to the triangle, one whose plane holds the ray is not hit, nor one at distance 0. */
EXACT_STEP bool exact_hit(const struct exact_ray *ray, const float *a, struct exact_result *answer) {
  const float *b = a + 3, *c = a + 6, *origin = ray->origin, *direction = ray->direction;
  uint32_t sum[EXACT_WORDS] = {0};
  add_determinants(sum, direction, c, b, origin, false, 0);
  struct exact_value edge_a = take_sum(sum);
  add_determinants(sum, direction, a, c, origin, false, 0);
  struct exact_value edge_b = take_sum(sum);
  if (exactly_opposite(edge_a, edge_b))
    return false;
  add_determinants(sum, direction, b, a, origin, false, 0);
  struct exact_value edge_c = take_sum(sum);
  if (exactly_opposite(edge_a, edge_c) || exactly_opposite(edge_b, edge_c))
    return false;
  add_determinants(sum, direction, b, a, c, false, 0);
  struct exact_value determinant = take_sum(sum);
  add_determinants(sum, a, b, a, c, true, 0);
  add_determinants(sum, origin, b, a, c, false, 0x80000000u);
  struct exact_value scaled = take_sum(sum);
  if (magnitude(determinant.value) == 0 || magnitude(scaled.value) == 0 || exactly_opposite(scaled, determinant))
    return false;
  answer->distance = bits_float(larger(float_bits(exact_quotient(scaled, determinant)), 1));
  answer->weight1 = exact_quotient(edge_b, determinant);
  answer->weight2 = exact_quotient(edge_c, determinant);
  return true;
}

/* Does the ray see v0, v1, v2 clockwise? As a sign bit. */
EXACT_STEP int32_t exactly_turned(const float *direction, const float *a) {
  uint32_t sum[EXACT_WORDS] = {0};
  add_determinants(sum, direction, a + 3, a, a + 6, false, 0);
  return float_bits(take_sum(sum).value) & SIGN_BIT;
}

#endif
