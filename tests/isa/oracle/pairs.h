/* Pairs of binary32 operands by number, the same on every machine: the host's comparisons, the TP's sweep and the
   builds of several compilers draw from this one sequence. Every 16 numbers have one pair of each kind below, so that
   any run of numbers has its share of all; a kind goes through its grid (exponents, corner values) with number / 16 and
   draws the rest. */
#ifndef TRAX_ISA_ORACLE_PAIRS_H
#define TRAX_ISA_ORACLE_PAIRS_H

#include "../../numerics/operands.h"

struct pair {
  uint32_t a, b;
};

#define SIGN_BIT 0x80000000u
#define FRACTION_BITS 0x7FFFFFu
#define EXPONENT_BITS 0x7F800000u

/* The limits of rules, used with both signs. */
static const uint32_t corner_values[] = {
    0x00000000, 0x00000001, 0x00000002, 0x00000003, 0x00000007, 0x000000FF,
    0x00001000, 0x003FFFFF, 0x00400000, 0x00400001, 0x007FFFFE, 0x007FFFFF, /* subnormal */
    0x00800000, 0x00800001, 0x00800002, 0x00FFFFFE, 0x00FFFFFF, 0x01000000,
    0x01000001, 0x017FFFFF, 0x01800000, /* just normal */
    0x0B800000, 0x0C000000, 0x0C800000, 0x1F7FFFFF, 0x1F800000, 0x1FB504F3,
    0x1FB504F4, 0x20000000, /* 2^-104 to 2^-102; 2^-64, 2^-63.5 */
    0x32800000, 0x33000000, 0x33000001, 0x337FFFFF, 0x33800000, 0x33800001,
    0x33FFFFFF, 0x34000000, 0x34000001, /* 2^-26 to 2^-23 */
    0x3A000000, 0x3EAAAAAA, 0x3EAAAAAB, 0x3EFFFFFF, 0x3F000000, 0x3F000001,
    0x3F3504F3, 0x3F3504F4, 0x3F7FFFFD, 0x3F7FFFFE, 0x3F7FFFFF, 0x3F800000,
    0x3F800001, 0x3F800002, 0x3F800003, 0x3F800800, 0x3F800FFF, 0x3F801000,
    0x3FAAAAAB, 0x3FB504F3, /* around 1 */
    0x3FB504F4, 0x3FC00000, 0x3FFFFFFE, 0x3FFFFFFF, 0x40000000, 0x40000001,
    0x40400000, 0x40490FDB, 0x40800000, 0x40A00000, 0x4AFFFFFF, 0x4B000000,
    0x4B000001, 0x4B7FFFFF, 0x4B800000, 0x4B800001, 0x4C000000, 0x4C000001, /* 2^23 to 2^25 */
    0x4EFFFFFE, 0x4EFFFFFF, 0x4F000000, 0x4F000001, 0x4F7FFFFE, 0x4F7FFFFF,
    0x4F800000, 0x4F800001, 0x5F000000, /* 2^31, 2^32, 2^63 */
    0x5F7FFFFF, 0x5F800000, 0x5F800001, 0x727FFFFF, 0x72800000, 0x72FFFFFF,
    0x73000000, 0x73000001, 0x73800000, /* half a place of the greatest */
    0x7E800000, 0x7EFFFFFF, 0x7F000000, 0x7F000001, 0x7F3FFFFF, 0x7F400000,
    0x7F7FFFFE, 0x7F7FFFFF, /* greatest */
    0x7F800000, 0x7F800001, 0x7FA00000, 0x7FBFFFFF, 0x7FC00000, 0x7FC00001,
    0x7FFFFFFF, /* infinity; signalling and quiet NaNs */
};
#define CORNERS (2 * COUNT(corner_values))

static inline uint32_t corner(uint32_t index) {
  return corner_values[index / 2 % COUNT(corner_values)] | index << 31;
}

/* The greatest and least exponents are those of zeros and infinities; others beyond are taken to the nearest. */
static inline uint32_t with_biased(uint32_t bits, int biased) {
  biased = biased < 0 ? 0 : biased > 255 ? 255 : biased;
  return (bits & (SIGN_BIT | FRACTION_BITS)) | (uint32_t)biased << 23;
}

/* The bits with a significand that ends in a run of zeros or of ones, or begins with a run of zeros. */
static inline uint32_t with_runs(uint32_t bits, uint32_t how) {
  uint32_t low = FRACTION_BITS >> how % 24;
  return how / 32 % 4 == 0 ? bits & ~low : how / 32 % 4 == 1 ? bits | low : bits & (low | ~FRACTION_BITS);
}

/* integer * 2^exponent: 0 if that is below all numbers, infinity if above. The integer has at most 24 bits; those that
   a subnormal number has no place for are cut off. */
static inline uint32_t from_integer(uint32_t sign, uint32_t integer, int exponent) {
  if (integer == 0)
    return sign;
  int shift = __builtin_clz(integer) - 8, biased = exponent - shift + 150;
  uint32_t significand = integer << shift;
  if (biased >= 255)
    return sign | EXPONENT_BITS;
  if (biased > 0)
    return sign | (uint32_t)biased << 23 | (significand & FRACTION_BITS);
  return sign | (biased > -23 ? significand >> (1 - biased) : 0);
}

/* An odd integer of exactly `length` bits, 1 to 24. */
static inline uint32_t odd_integer(uint32_t bits, uint32_t length) {
  return ((bits | 0x80000000u) >> (32 - length)) | 1;
}

/* The operand, or one of its neighbours. */
static inline uint32_t about(uint32_t bits, uint32_t how) {
  return bits + (how % 4 == 1) - (how % 4 == 2);
}

static inline struct pair pair_of(uint64_t number) {
  uint64_t state = number << 2, first = random64(&state), second = random64(&state);
  uint32_t kind = number & 15, index = (uint32_t)(number >> 4);
  uint32_t more = (uint32_t)(first >> 32), most = (uint32_t)(second >> 32);
  struct pair p = {(uint32_t)first, (uint32_t)second};
  const uint32_t sign_a = p.a & SIGN_BIT, sign_b = p.b & SIGN_BIT;
  const int ea = (int)(index & 255), eb = (int)(index >> 8 & 255);
  switch (kind) {
  case 0: /* every pair of corner values: NaNs, infinities and zeros among them */
    p.a = corner(index % CORNERS);
    p.b = corner(index / CORNERS % CORNERS);
    break;
  case 1: /* every pair of exponents, any significands */
    p.a = with_biased(p.a, ea);
    p.b = with_biased(p.b, eb);
    break;
  case 2: /* every pair of exponents, significands with runs */
    p.a = with_biased(with_runs(p.a, more), ea);
    p.b = with_biased(with_runs(p.b, most), eb);
    break;
  case 3: { /* halfway cases of sums: b ends in a one half a place below a's last, or a place away, or next to that */
    int distance = 1 + eb % 26, tail = distance - 1 + (int)(most % 3);
    uint32_t half = (uint32_t)1 << (tail < 1 ? 0 : tail > 24 ? 23 : tail - 1);
    p.a = with_biased(p.a, ea);
    p.b = about(with_biased((p.b & ~(2 * half - 1)) | half, ea - distance), more);
    break;
  }
  case 4: /* cancellation: the difference is a few places */
    p.a = with_biased(p.a, ea);
    p.b = (p.a ^ (more % 8 ? SIGN_BIT : 0)) + most % 17 - 8;
    break;
  case 5: /* cancellation across a power of two: 1.0...01 - 0.1...1 */
    p.a = with_biased(p.a & FRACTION_BITS >> eb % 24, ea) | sign_a;
    p.b = with_biased(p.b | ~(FRACTION_BITS >> most % 24), ea - 1 - (int)(more % 2));
    p.b = (p.b & ~SIGN_BIT) | (sign_a ^ (more & 14 ? SIGN_BIT : 0));
    break;
  case 6: { /* halfway cases of products: odd factors of together 25 bits */
    uint32_t length = 1 + most % 24;
    p.a = about(from_integer(sign_a, odd_integer(p.a, length), ea - 150), more);
    p.b = from_integer(sign_b, odd_integer(p.b, 25 - length), eb - 150);
    break;
  }
  case 7: /* products about the least normal number, and about half the least subnormal one */
    p.a = with_biased(with_runs(p.a, more), ea);
    p.b = with_biased(with_runs(p.b, most), (more & 1 ? 127 : 127 - 24) + 4 - eb % 9 - ea);
    break;
  case 8: { /* products halfway between subnormal numbers: odd factors whose last places multiply to 2^-150 */
    uint32_t length = 1 + most % 24;
    int exponent = -1 - (int)(index % 149);
    p.a = about(from_integer(sign_a, odd_integer(p.a, length), exponent), more);
    p.b = from_integer(sign_b, odd_integer(p.b, 1 + (most >> 8) % (25 - length + 1) % 24), -150 - exponent);
    break;
  }
  case 9: /* quotients about the least normal number, and about half the least subnormal one */
    p.a = with_biased(with_runs(p.a, more), ea);
    p.b = with_biased(with_runs(p.b, most), ea + (more & 1 ? 127 - 1 : 127 - 1 + 24) + 4 - eb % 9);
    break;
  case 10: /* sums that overflow, and almost */
    p.a = sign_a | (0x7F7FFFFF - ((more & FRACTION_BITS) >> most % 24));
    p.b = about(with_biased(most & 0x10000 ? with_runs(p.b, more >> 24) : sign_b, 254 - eb % 28), most >> 24);
    break;
  case 11: /* products and quotients about the greatest number */
    p.a = with_biased(with_runs(p.a, more), ea);
    p.b = with_biased(with_runs(p.b, most), more & 1 ? 254 + 127 + 2 - eb % 5 - ea : ea - 127 - 2 + eb % 5);
    break;
  case 12: { /* quotients that are exact: odd ones, every other one halfway between subnormal numbers; or next to that
              */
    uint32_t length = 1 + most % 23, divisor = odd_integer(p.b, length);
    int exponent = index & 1 ? -149 + (int)(index / 2 % 120) : ea - 150;
    p.a = about(from_integer(sign_a, divisor * odd_integer(p.a, 24 - length), exponent), more);
    p.b = from_integer(sign_b, divisor, index & 1 ? exponent + 150 : eb - 150);
    break;
  }
  case 13: { /* quotients as near to halfway as there are: a * 2^25 + c = b * q, q any odd number of 25 bits, c small
                and odd */
    uint32_t b = odd_integer(p.b, 24), inverse = b, c = 2 * (most % 16) - 15;
    for (int i = 0; i < 4; i++) /* each step doubles the bits in which it is right, 3 at first */
      inverse *= 2 - b * inverse;
    uint32_t q = (c * inverse) & 0x1FFFFFF;
    p.a = from_integer(sign_a, (uint32_t)(((uint64_t)b * q - (uint64_t)(int64_t)(int32_t)c) >> 25), ea - 150);
    p.b = from_integer(sign_b, b, more & 1 ? eb - 150 : ea - 150);
    break;
  }
  case 14: /* ordinary numbers; a corner value and anything */
    if (index & 1) {
      p.a = with_biased(p.a, 127 - 16 + (int)(more & 31));
      p.b = with_biased(p.b, 127 - 16 + (int)(most & 31));
    } else if (index & 2) {
      p.a = corner(index / 4);
    } else {
      p.b = corner(index / 4);
    }
    break;
  default: /* any bits */
    break;
  }
  return p;
}

#endif
