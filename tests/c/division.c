// RUN: %run_c %s %t --levels -O2,-Os --also -O3
// RUN: %trax_sim --set special.precision_bits=1 %t-Os | diff %S/division.expected -
// RUN: %trax_sim --set special.precision_bits=7 %t-O2 | diff %S/division.expected -
// Integer division in every form that the compiler writes out, and the library's, against what defines it:
// n = q * d + r, and r below d. The special unit has 24 bits, or so few that nearly every estimate is wrong.
// docs/results/division.md has the command for more operands: the argument is a multiple of these.
#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define NOINLINE __attribute__((noinline))

uint32_t __udivsi3(uint32_t n, uint32_t d);
uint32_t __umodsi3(uint32_t n, uint32_t d);
uint32_t __udivmodsi4(uint32_t n, uint32_t d, uint32_t *r);
int32_t __divsi3(int32_t n, int32_t d);
int32_t __modsi3(int32_t n, int32_t d);
int32_t __divmodsi4(int32_t n, int32_t d, int32_t *r);

static unsigned failures;

static NOINLINE void complain(const char *form, uint32_t n, uint32_t d, uint32_t q, uint32_t r) {
  if (failures++ < 10)
    printf("%s: %#x / %#x = %#x, rest %#x\n", form, (unsigned)n, (unsigned)d, (unsigned)q, (unsigned)r);
}

static inline bool is_right(uint32_t n, uint32_t d, uint32_t q, uint32_t r) {
  return r < d && (uint64_t)q * d + r == n;
}

static inline bool is_right_signed(int32_t n, int32_t d, int32_t q, int32_t r) {
  return (n < 0 ? r <= 0 : r >= 0) && llabs((long long)r) < llabs((long long)d) && (int64_t)q * d + r == n;
}

#define CHECK(form, n, d, q, r)                                                                                        \
  if (!is_right(n, d, q, r))                                                                                           \
    complain(form, n, d, q, r);
#define CHECK_SIGNED(form, n, d, q, r)                                                                                 \
  if (!is_right_signed(n, d, q, r))                                                                                    \
    complain(form, (uint32_t)(n), (uint32_t)(d), (uint32_t)(q), (uint32_t)(r));

static NOINLINE uint32_t quotient(uint32_t n, uint32_t d) {
  return n / d;
}
static NOINLINE uint32_t remainder_of(uint32_t n, uint32_t d) {
  return n % d;
}
static NOINLINE int32_t quotient_signed(int32_t n, int32_t d) {
  return n / d;
}
static NOINLINE int32_t remainder_signed(int32_t n, int32_t d) {
  return n % d;
}

static NOINLINE void divide_unsigned(uint32_t n, uint32_t d) {
  uint32_t rest;
  CHECK("unsigned", n, d, quotient(n, d), remainder_of(n, d));
  CHECK("both", n, d, n / d, n % d);
  CHECK("library", n, d, __udivsi3(n, d), __umodsi3(n, d));
  uint32_t q = __udivmodsi4(n, d, &rest);
  CHECK("library, both", n, d, q, rest);
  uint16_t n16 = (uint16_t)n, d16 = (uint16_t)d;
  if (d16) {
    CHECK("16 bits", n16, d16, (uint16_t)(n16 / d16), (uint16_t)(n16 % d16));
    CHECK("half the divisor", n, d16, n / d16, n % d16);
  }
  uint8_t n8 = (uint8_t)n, d8 = (uint8_t)(d >> 3);
  if (d8)
    CHECK("8 bits", n8, d8, (uint8_t)(n8 / d8), (uint8_t)(n8 % d8));
}

static NOINLINE void divide_signed(int32_t n, int32_t d) {
  int32_t rest;
  if (d == 0 || (n == INT32_MIN && d == -1))
    return;
  CHECK_SIGNED("signed", n, d, quotient_signed(n, d), remainder_signed(n, d));
  CHECK_SIGNED("signed, both", n, d, n / d, n % d);
  CHECK_SIGNED("library, signed", n, d, __divsi3(n, d), __modsi3(n, d));
  int32_t q = __divmodsi4(n, d, &rest);
  CHECK_SIGNED("library, signed, both", n, d, q, rest);
  int32_t above = n & INT32_MAX, below = d & INT32_MAX;
  CHECK_SIGNED("dividend not negative", above, d, above / d, above % d);
  if (below)
    CHECK_SIGNED("divisor not negative", n, below, n / below, n % below);
  int16_t n16 = (int16_t)n, d16 = (int16_t)d;
  if (d16)
    CHECK_SIGNED("16 bits, signed", n16, d16, n16 / d16, n16 % d16);
}

#define MANY 16

/* Divisors that a loop does not change. */
static NOINLINE void divide_many(const uint32_t *n, uint32_t d, uint32_t *q, uint32_t *r) {
  for (int i = 0; i < MANY; i++) {
    q[i] = n[i] / d;
    r[i] = n[i] % d;
  }
}
static NOINLINE void divide_many_signed(const uint32_t *n, int32_t d, int32_t *q, int32_t *r) {
  for (int i = 0; i < MANY; i++) /* alone, a quotient's dividend is known not to be negative */
    q[i] = (int32_t)(n[i] >> 1) / d;
  for (int i = 0; i < MANY; i++)
    r[i] = (int32_t)(n[i] >> 1) % d;
}

static void divide_all(const uint32_t *n, uint32_t d) {
  static uint32_t q[MANY], r[MANY];
  static int32_t qs[MANY], rs[MANY];
  divide_many(n, d, q, r);
  divide_many_signed(n, (int32_t)d, qs, rs);
  for (int i = 0; i < MANY; i++) {
    CHECK("invariant", n[i], d, q[i], r[i]);
    CHECK_SIGNED("invariant, signed", (int32_t)(n[i] >> 1), (int32_t)d, qs[i], rs[i]);
    divide_unsigned(n[i], d);
    divide_signed((int32_t)n[i], (int32_t)d);
  }
}

static uint64_t state = 36;

static uint32_t next(void) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(state >> 32);
}

/* A random number of 1 to 32 bits. */
static uint32_t next_of_any_length(void) {
  uint32_t length = next() >> 27;
  return next() >> length;
}

/* Dividends beside multiples of the divisor, where estimates go wrong, and others. */
static void divide(uint32_t d) {
  static uint32_t n[MANY];
  uint32_t most = UINT32_MAX / d;
  for (int i = 0; i < MANY; i += 4) {
    uint32_t multiple = (i == 0 ? most : (uint32_t)((uint64_t)most * next_of_any_length() >> 32)) * d;
    n[i] = multiple;
    n[i + 1] = multiple - 1;
    n[i + 2] = multiple + d - 1;
    n[i + 3] = i < 8 ? next_of_any_length() : 0u - (next() >> 20);
  }
  divide_all(n, d);
}

int main(int argc, char **argv) {
  uint32_t times = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 0) : 1;
  for (int bit = 0; bit < 32; bit++)
    for (uint32_t near = 0; near < 9; near++) {
      uint32_t d = (1u << bit) + near - 4;
      if (d)
        divide(d);
    }
  for (uint32_t d = 1; d < 0x10000; d += times < 100 ? 613 : 1)
    divide(d);
  for (uint32_t i = 0; i < 300 * times; i++) {
    uint32_t d = next_of_any_length();
    divide(d ? d : UINT32_MAX - i);
  }
  volatile int zero = 0; /* gives anything, and ends */
  volatile int32_t least = INT32_MIN, minus_one = -1;
  volatile uint32_t any = quotient(next(), (uint32_t)zero) + remainder_of(0, (uint32_t)zero);
  any = (uint32_t)quotient_signed(0, zero) + (uint32_t)remainder_signed((int32_t)next(), zero);
  any = (uint32_t)quotient_signed(least, minus_one) + (uint32_t)remainder_signed(least, minus_one);
  (void)any;
  static uint32_t some[MANY] = {1, 2, 0, UINT32_MAX}, results[MANY], rests[MANY];
  divide_many(some, (uint32_t)zero, results, rests);
  printf("%u\n", failures);
  return failures != 0;
}
