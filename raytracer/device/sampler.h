/* The sampler: for every pixel, sample and dimension a point of the unit square. Integers until the last step, so the
   same on any machine.

   Points are the first two dimensions of Sobol's sequence, Owen-scrambled by hashing, and their order is scrambled too,
   so that any two dimensions of a path are independent of one another: Burley, "Practical Hash-based Owen Scrambling"
   (JCGT 9(4), 2020), after Laine and Karras, "Stratified Sampling for Stochastic Transparency" (EGSR 2011). */
#ifndef TRAX_DEVICE_SAMPLER_H
#define TRAX_DEVICE_SAMPLER_H

#include <stdint.h>

struct place {
  float x, y; /* from 0 up to, but not, 1 */
};

#define PIXEL_MIDDLE ((struct place){0.5f, 0.5f})

/* The dimensions of a path's decisions: for its pixel, and for each surface, */
enum {
  DIMENSION_PIXEL = 0,
  DIMENSION_LIGHT = 1,   /* which point of a light */
  DIMENSION_PICK = 2,    /* which light; which of the emitters */
  DIMENSION_SCATTER = 3, /* which direction */
  DIMENSION_CHOICE = 4,  /* which layer, or whether glass reflects; whether the path ends */
  DIMENSIONS_OF_SURFACE = 4
};

/* The finaliser of Appleby's MurmurHash3. */
static inline uint32_t hash_word(uint32_t x) {
  x = (x ^ x >> 16) * 0x85EBCA6Bu;
  x = (x ^ x >> 13) * 0xC2B2AE35u;
  return x ^ x >> 16;
}

static inline uint32_t reverse_bits(uint32_t x) {
  x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  x = (x & 0x0F0F0F0Fu) << 4 | (x >> 4 & 0x0F0F0F0Fu);
  x = (x & 0x00FF00FFu) << 8 | (x >> 8 & 0x00FF00FFu);
  return x << 16 | x >> 16;
}

/* Flips each bit depending on the bits below it and the seed. This is Owen's scrambling of the number with the reversed
   bits. */
static inline uint32_t scramble_upwards(uint32_t x, uint32_t seed) {
  x += seed;
  x ^= x * 0x6C50B47Cu;
  x ^= x * 0xB82F1E52u;
  x ^= x * 0xC7AFE638u;
  return x ^ x * 0x8D22F6E6u;
}

/* Sobol's second matrix is Pascal's triangle modulo 2: bit k is the sum of the bits whose numbers have all bits of k.
   x is below 2^16. */
static inline uint32_t pascal_sums(uint32_t x) {
  x ^= x >> 1 & 0x5555u;
  x ^= x >> 2 & 0x3333u;
  x ^= x >> 4 & 0x0F0Fu;
  return x ^ (x >> 8 & 0x00FFu);
}

struct words {
  uint32_t x, y;
};

/* The unit is 2^-32. */
static inline struct words scrambled_point(uint32_t sample, uint32_t seed) {
  uint32_t seed_x = hash_word(seed ^ 0x9E3779B9u), seed_y = hash_word(seed ^ 0x3C6EF372u);
  uint32_t number = reverse_bits(scramble_upwards(reverse_bits(sample), hash_word(seed))) & 0xFFFFu;
  return (struct words){reverse_bits(scramble_upwards(number, seed_x)),
                        reverse_bits(scramble_upwards(pascal_sums(number), seed_y))};
}

static inline struct place place_of(struct words words) {
  return (struct place){(float)(int32_t)(words.x >> 8) * 0x1p-24f, (float)(int32_t)(words.y >> 8) * 0x1p-24f};
}

/* Every pixel has the same point, so there is no noise. The first sample takes the middle. */
static inline struct place even_point(uint32_t sample, uint32_t dimension) {
  struct words first = scrambled_point(0, hash_word(dimension)), words = scrambled_point(sample, hash_word(dimension));
  return place_of((struct words){words.x ^ first.x ^ 0x80000000u, words.y ^ first.y ^ 0x80000000u}); /* still a net */
}

/* key: of pixel and seed. */
static inline struct words random_words(uint32_t sample, uint32_t dimension, uint32_t key) {
  return scrambled_point(sample, hash_word(key + dimension * 0x9E3779B9u));
}

static inline struct place random_point(uint32_t sample, uint32_t dimension, uint32_t key) {
  return place_of(random_words(sample, dimension, key));
}

#endif
