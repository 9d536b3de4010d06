/* The sequences of operands. Each chunk follows from its number alone, so any thread can do any part of the work. */
#include <math.h>
#include <string.h>

#include "../operands.h"
#include "accuracy.h"

/* Limits of formulas, poles and thresholds of overflow, with either sign, and their neighbours. */
static const uint32_t specials[] = {0x00000000, 0x00000001, 0x007FFFFF, 0x00800000, 0x34000000, 0x39800000, 0x3E800000,
                                    0x3ED413CC, 0x3F000000, 0x3F3504F3, 0x3F490FDB, 0x3F800000, 0x3FC00000, 0x3FC90FDB,
                                    0x40000000, 0x40400000, 0x40490FDB, 0x41A00000, 0x420E1490, 0x42AEAC50, 0x42B17218,
                                    0x42CE8ED0, 0x42FE0000, 0x43000000, 0x43150000, 0x4AFFFFFF, 0x4B000000, 0x4B7FFFFF,
                                    0x4C000000, 0x4F000000, 0x5F000000, 0x7E800000, 0x7F7FFFFF, 0x7F800000, 0x7FC00000};
enum { SPECIALS = 2 * COUNT(specials) };

static uint32_t special(uint64_t i) {
  return specials[i / 2 % COUNT(specials)] | (uint32_t)(i & 1) << 31;
}

enum { RUN = 64 }; /* neighbours */

static uint32_t single(uint64_t number, bool whole) {
  if (whole)
    return (uint32_t)number;
  if (number < 4 * SPECIALS)
    return special(number / 4) + (uint32_t)(number % 4) - 1;
  /* An odd factor makes a permutation of the numbers of runs. */
  uint32_t run = (uint32_t)(number / RUN) * 0x9E3779B1u % (1u << 26);
  return run * RUN + (uint32_t)(number % RUN);
}

/* An operand for which the function's result is neither too great nor too small: for those that scale like x^y. */
static float power_for(float x, uint64_t random) {
  float y = (float)((double)(int64_t)random * 0x1p-63 * 152 / log2(fabs((double)x)));
  return random & 1 && fabsf(y) < 1e9f ? rintf(y * 2) / 2 : y;
}

static void several(uint32_t *operand, const char *name, uint64_t number) {
  if (number < (uint64_t)SPECIALS * SPECIALS) {
    operand[0] = special(number / SPECIALS);
    operand[1] = special(number);
    operand[2] = special(number * 7);
    return;
  }
  uint64_t state = number * 0xD1342543DE82EF95u, random = random64(&state);
  float x = random_float(&state), y = random_float(&state), z = random_float(&state);
  int small = (int)(random >> 8 & 0xFF), kind = (int)(random & 7);
  if (kind < 2 && !strcmp(name, "powf")) {
    y = power_for(x, random64(&state));
  } else if (kind == 2) { /* close in size */
    y = x * (1 + (float)small / 64);
  } else if (kind == 3) { /* neighbours */
    y = float_of(float_bits_of(x) + (uint32_t)small - 128);
  } else if (kind == 4) { /* quotients that are integers, or halfway between them */
    y = x / ((float)small / 2);
    y = float_of(float_bits_of(y) + (uint32_t)(random >> 16 & 3) - 1);
  } else if (kind == 5) { /* both from 2^-8 to 2^8 */
    x = float_of((float_bits_of(x) & 0x807FFFFFu) | (119 + (uint32_t)(random >> 20 & 15)) << 23);
    y = float_of((float_bits_of(y) & 0x807FFFFFu) | (119 + (uint32_t)(random >> 24 & 15)) << 23);
  }
  if (random & 0x10000) /* sums that cancel, and halfway cases */
    z = -(x * y) + (random & 0x20000 ? 0 : x * y * 0x1p-24f);
  operand[0] = float_bits_of(x);
  operand[1] = float_bits_of(y);
  operand[2] = float_bits_of(z);
}

void operands_fill(struct chunk *chunk, const struct function *function, uint64_t number, bool whole) {
  chunk->first = number * CHUNK;
  for (uint64_t i = 0; i <= CHUNK; i++)
    if (function->operands == 1) {
      chunk->operand[0][i] = single(chunk->first + i, whole);
    } else {
      uint32_t operand[3];
      several(operand, function->name, chunk->first + i);
      for (int n = 0; n < 3; n++)
        chunk->operand[n][i] = operand[n];
    }
}
