/* Operands by number: the same on every machine, so that two of them can compare hashes of their results. */
#ifndef TRAX_TEST_SWEEP_H
#define TRAX_TEST_SWEEP_H

#include <stddef.h>
#include <stdint.h>

#include "operands.h"

struct operands {
  uint64_t a, b, c;
};

#define SIGN ((uint64_t)1 << 63)
#define FRACTION 0x000FFFFFFFFFFFFFu

/* The bits with another exponent, which may be out of range: it is taken modulo 2^11. */
static inline uint64_t with_exponent(uint64_t bits, int exponent) {
  return (bits & (SIGN | FRACTION)) | (uint64_t)(exponent & 0x7FF) << 52;
}

/* Bits of three doubles, c for the sum of a multiply-add. Number by number every kind that has a path of its own. */
static inline struct operands double_operands(uint32_t number) {
  uint64_t state = (uint64_t)number << 3;
  struct operands o = {random64(&state), random64(&state), random64(&state)};
  uint32_t kind = number & 15, index = number >> 4;
  int exponent = (int)(o.c & 0x3F) + 1023 - 32;
  switch (kind) {
  case 0: /* any bits */
    break;
  case 1: /* all differences of exponents that matter to a sum */
    o.b = with_exponent(o.b, (int)(o.a >> 52 & 0x7FF) + (int)(index % 131) - 65);
    break;
  case 2: /* cancellation */
    o.b = o.a + (index & 15) - 8;
    o.b ^= (uint64_t)(index & 16) << 59;
    break;
  case 3: /* few bits: halfway cases of sums and products */
    o.a = with_exponent(o.a & ~(uint64_t)0 << (index % 52), exponent);
    o.b = with_exponent(o.b & ~(uint64_t)0 << (52 - index % 52), exponent + (int)(index >> 6 & 63) - 32);
    break;
  case 4: /* subnormal numbers */
    o.a &= SIGN | FRACTION >> (index % 52);
    if (index & 1)
      o.b &= SIGN | FRACTION >> (index / 2 % 52);
    break;
  case 5: /* powers of two and their neighbours */
    o.a = with_exponent(0, (int)(o.a >> 52)) + (index % 3) - 1;
    o.b = with_exponent(0, (int)(o.b >> 52)) + (index / 3 % 3) - 1;
    break;
  case 6: /* all pairs of special numbers */
    o.a = special_doubles[index % COUNT(special_doubles)] | (o.a & SIGN);
    o.b = special_doubles[index / COUNT(special_doubles) % COUNT(special_doubles)] | (o.b & SIGN);
    break;
  case 7: /* products and quotients where subnormal numbers begin */
    exponent = (int)(index % 1000) + 12;
    o.a = with_exponent(o.a, exponent);
    o.b = with_exponent(o.b,
                        index & 1024 ? 1023 - exponent + (int)(o.c % 70) - 56 : exponent + 1023 + (int)(o.c % 70) - 10);
    break;
  case 8: /* where sums and products overflow */
    o.a = with_exponent(o.a, 2046 - (int)(index % 3));
    o.b = with_exponent(o.b, index & 4 ? 2046 - (int)(o.c % 60) : 1022 + (int)(o.c % 5));
    break;
  case 9: /* the size of integers */
    o.a = with_exponent(o.a & ~(uint64_t)0 << (o.c & 31), 1020 + (int)(index % 70));
    break;
  case 10: /* between two floats, and next to that */
    o.a = with_exponent((o.a & ~(uint64_t)0x1FFFFFFF) + 0x10000000 + (index % 3) - 1,
                        1023 - 152 + (int)(index / 3 % 284));
    break;
  case 11: { /* quotients and roots that are exact or nearly */
    double q = double_of(with_exponent(o.a & ~(uint64_t)0 << 27, exponent));
    double d = double_of(with_exponent(o.b & ~(uint64_t)0 << 27, 1023));
    o.b = index & 1 ? bits_of(d) : bits_of(q);
    o.a = bits_of(index & 1 ? q * d : q * q) + (index >> 1 & 3) - 1;
    break;
  }
  case 12: /* runs of ones */
    o.a |= (((uint64_t)1 << (index & 63)) - 1) & FRACTION;
    o.b &= ~(FRACTION >> (index >> 6 & 63));
    break;
  default: /* ordinary numbers */
    o.a = with_exponent(o.a, exponent);
    o.b = with_exponent(o.b, (int)(o.c >> 6 & 0x3F) + 1023 - 32);
  }
  switch (index & 7) { /* the sum of a multiply-add: cancellation and halfway cases of the product, or anything */
  case 0: {
    double product = double_of(o.a) * double_of(o.b);
    if (product == product) /* a NaN's bits would be the machine's */
      o.c = bits_of(-product) + (o.c & 3) - 1;
    break;
  }
  case 1:
    o.c = with_exponent(o.c & ~(uint64_t)0 << (o.c & 63),
                        (int)((o.a >> 52 & 0x7FF) + (o.b >> 52 & 0x7FF)) - 1023 + (int)(o.c >> 8 & 127) - 64);
    break;
  case 2:
    o.c = o.a;
    break;
  default:
    break;
  }
  return o;
}

/* Two integers of 64 bits; c is any. b is never 0, and a / b fits. */
static inline struct operands integer_operands(uint32_t number) {
  uint64_t state = ((uint64_t)number << 3) + 1;
  struct operands o = {random64(&state), random64(&state), random64(&state)};
  uint32_t kind = number & 7, index = number >> 3;
  switch (kind) {
  case 0:
    break;
  case 1: /* all lengths of both */
    o.a >>= index & 63;
    o.b >>= index >> 6 & 63;
    break;
  case 2: /* near powers of two */
    o.a = ((uint64_t)1 << (index & 63)) + (o.a % 5) - 2;
    o.b = ((uint64_t)1 << (index >> 6 & 63)) + (o.b % 5) - 2;
    break;
  case 3: /* multiples of the divisor and their neighbours */
    o.b = (o.b >> (index & 63)) | 1;
    o.a >>= o.c & 63;
    o.a =
        (index & 1 ? o.a % (UINT64_MAX / o.b) : (uint64_t)(uint32_t)o.a) * o.b + (index & 2 ? o.b - 1 : index >> 2 & 1);
    break;
  case 4: /* a divisor of one word */
    o.b = (uint32_t)o.b >> (index & 31);
    break;
  case 5: /* all pairs of special numbers */
    o.a = special_integers[index % COUNT(special_integers)];
    o.b = special_integers[index / COUNT(special_integers) % COUNT(special_integers)];
    o.a = o.c & 1 ? 0 - o.a : o.a;
    o.b = o.c & 2 ? 0 - o.b : o.b;
    break;
  case 6: /* negative numbers of all lengths */
    o.a = 0 - (o.a >> (index & 63));
    o.b = o.c & 1 ? 0 - (o.b >> (index >> 6 & 63)) : o.b >> (index >> 6 & 63);
    break;
  default: /* between two floats or doubles, and next to that */
    o.a = ((o.a | SIGN) & ~(uint64_t)0 << (10 + 30 * (index & 1))) + ((uint64_t)(index & 2) << (8 + 30 * (index & 1))) +
          (index >> 2 & 3) - 1;
    o.a >>= index >> 4 & 15;
  }
  if ((uint32_t)o.b == 0)
    o.b |= 1;
  if ((o.a == SIGN && o.b == ~(uint64_t)0) || ((uint32_t)o.a == 0x80000000u && (uint32_t)o.b == 0xFFFFFFFFu))
    o.b = 3;
  return o;
}

#endif
