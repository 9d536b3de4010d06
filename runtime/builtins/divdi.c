/* 64-bit division and remainder. */
#include "../internal/divide.h"
#include "builtins.h"

struct divided64 {
  uint64_t quotient, remainder;
};

/* Out of line: its six callers would each hold a copy of some 150 instructions. */
struct divided64 trax_divide64(uint64_t n, uint64_t d);

struct divided64 trax_divide64(uint64_t n, uint64_t d) {
  if (n < d)
    return (struct divided64){0, n};
  if (high_word(n) == 0)
    return (struct divided64){low_word(n) / low_word(d), low_word(n) % low_word(d)};
  unsigned shift;
  uint32_t over; /* the bits of n that the shift moves to a third word */
  if (high_word(d) == 0) {
    shift = (unsigned)leading_zeros(low_word(d));
    uint32_t divisor = low_word(d) << shift;
    over = shift ? high_word(n) >> (32 - shift) : 0;
    n <<= shift;
    uint32_t v = reciprocal_2by1(divisor);
    struct divided first = divide_2by1(over, high_word(n), divisor, v);
    struct divided second = divide_2by1(first.remainder, low_word(n), divisor, v);
    return (struct divided64){words(first.quotient, second.quotient), second.remainder >> shift};
  }
  shift = (unsigned)leading_zeros(high_word(d));
  over = shift ? high_word(n) >> (32 - shift) : 0;
  n <<= shift;
  d <<= shift;
  struct divided_3by2 r = divide_3by2(words(over, high_word(n)), low_word(n), d, reciprocal_3by2(d));
  return (struct divided64){r.quotient, r.remainder >> shift};
}

uint64_t __udivdi3(uint64_t n, uint64_t d) {
  return trax_divide64(n, d).quotient;
}

uint64_t __umoddi3(uint64_t n, uint64_t d) {
  return trax_divide64(n, d).remainder;
}

uint64_t __udivmoddi4(uint64_t n, uint64_t d, uint64_t *remainder) {
  struct divided64 r = trax_divide64(n, d);
  *remainder = r.remainder;
  return r.quotient;
}

static inline uint64_t sign_mask(int64_t x) {
  return (uint64_t)(x >> 63);
}

static inline struct divided64 divide_signed(int64_t n, int64_t d) {
  uint64_t sn = sign_mask(n), sd = sign_mask(d), sq = sn ^ sd;
  struct divided64 r = trax_divide64(((uint64_t)n ^ sn) - sn, ((uint64_t)d ^ sd) - sd);
  return (struct divided64){(r.quotient ^ sq) - sq, (r.remainder ^ sn) - sn};
}

int64_t __divdi3(int64_t n, int64_t d) {
  return (int64_t)divide_signed(n, d).quotient;
}

int64_t __moddi3(int64_t n, int64_t d) {
  return (int64_t)divide_signed(n, d).remainder;
}

int64_t __divmoddi4(int64_t n, int64_t d, int64_t *remainder) {
  struct divided64 r = divide_signed(n, d);
  *remainder = (int64_t)r.remainder;
  return (int64_t)r.quotient;
}
