/* 32-bit division and remainder. */
#include "../internal/divide.h"
#include "builtins.h"

uint32_t __udivsi3(uint32_t n, uint32_t d) {
  return divide(n, d).quotient;
}

uint32_t __umodsi3(uint32_t n, uint32_t d) {
  return divide(n, d).remainder;
}

uint32_t __udivmodsi4(uint32_t n, uint32_t d, uint32_t *remainder) {
  struct divided r = divide(n, d);
  *remainder = r.remainder;
  return r.quotient;
}

/* All ones for a negative number, else 0: (x ^ mask) - mask is x or -x. */
static inline uint32_t sign_mask(int32_t x) {
  return (uint32_t)(x >> 31);
}

static inline struct divided divide_signed(int32_t n, int32_t d) {
  uint32_t sn = sign_mask(n), sd = sign_mask(d), sq = sn ^ sd;
  struct divided r = divide(((uint32_t)n ^ sn) - sn, ((uint32_t)d ^ sd) - sd);
  return (struct divided){(r.quotient ^ sq) - sq, (r.remainder ^ sn) - sn};
}

int32_t __divsi3(int32_t n, int32_t d) {
  return (int32_t)divide_signed(n, d).quotient;
}

int32_t __modsi3(int32_t n, int32_t d) {
  return (int32_t)divide_signed(n, d).remainder;
}

int32_t __divmodsi4(int32_t n, int32_t d, int32_t *remainder) {
  struct divided r = divide_signed(n, d);
  *remainder = (int32_t)r.remainder;
  return (int32_t)r.quotient;
}
