// RUN: %run_c %s %t
// SHA-256 (FIPS 180-4): rotations, additions modulo 2^32, a schedule in a ring; its published digests.
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static uint32_t round_constants[64];
static uint32_t state[8], schedule[16];

static uint32_t rotate(uint32_t x, int n) {
  return x >> n | x << (32 - n);
}

/* The first 32 bits of the fraction of the root of a prime, by bisection on
 * integers. */
__attribute__((noinline)) static uint32_t fraction_of_root(uint32_t prime, int degree) {
  uint32_t whole = 1;
  while ((degree == 2 ? (whole + 1) * (whole + 1) : (whole + 1) * (whole + 1) * (whole + 1)) <= prime)
    whole++;
  uint32_t fraction = 0;
  for (uint32_t bit = 0x80000000u; bit; bit >>= 1) {
    /* Compare (whole + x / 2^32)^degree with the prime: 64-bit products of the
     * 36-bit root, rounded down where low bits fall. */
    uint32_t x = fraction | bit;
    uint64_t cross = (uint64_t)whole * x;                       /* 2^-32 */
    uint64_t low = (uint64_t)x * x;                             /* 2^-64 */
    uint64_t high = (uint64_t)whole * whole + (cross >> 31);    /* 1 */
    uint64_t middle = (cross << 1 & 0xFFFFFFFFu) + (low >> 32); /* 2^-32 */
    uint32_t rest = (uint32_t)low;                              /* 2^-64 */
    high += middle >> 32;
    middle &= 0xFFFFFFFFu;
    if (degree == 3) { /* (high, middle, rest) * (whole, x) */
      uint64_t a = (uint64_t)rest * x, b = middle * x, c = high * x, d = (uint64_t)rest * whole, e = middle * whole;
      uint64_t t = (a >> 32) + (b & 0xFFFFFFFFu) + (d & 0xFFFFFFFFu);                /* 2^-64 */
      t = (t >> 32) + (b >> 32) + (d >> 32) + (c & 0xFFFFFFFFu) + (e & 0xFFFFFFFFu); /* 2^-32 */
      high = (t >> 32) + (c >> 32) + (e >> 32) + high * whole;
    }
    if (high < prime)
      fraction = x;
  }
  return fraction;
}

__attribute__((noinline)) static void initialise(void) {
  int count = 0;
  for (uint32_t n = 2; count < 64; n++) {
    int prime = 1;
    for (uint32_t d = 2; d * d <= n; d++)
      if (n % d == 0)
        prime = 0;
    if (!prime)
      continue;
    if (count < 8)
      state[count] = fraction_of_root(n, 2);
    round_constants[count++] = fraction_of_root(n, 3);
  }
}

__attribute__((noinline)) static void compress(void) {
  uint32_t a = state[0], b = state[1], c = state[2], d = state[3];
  uint32_t e = state[4], f = state[5], g = state[6], h = state[7];
  for (int i = 0; i < 64; i++) {
    uint32_t *w = &schedule[i & 15];
    if (i >= 16) {
      uint32_t x = schedule[(i + 1) & 15], y = schedule[(i + 14) & 15];
      *w +=
          (rotate(x, 7) ^ rotate(x, 18) ^ x >> 3) + schedule[(i + 9) & 15] + (rotate(y, 17) ^ rotate(y, 19) ^ y >> 10);
    }
    uint32_t t = h + (rotate(e, 6) ^ rotate(e, 11) ^ rotate(e, 25)) + ((e & f) ^ (~e & g)) + round_constants[i] + *w;
    uint32_t u = (rotate(a, 2) ^ rotate(a, 13) ^ rotate(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
    h = g, g = f, f = e, e = d + t, d = c, c = b, b = a, a = t + u;
  }
  state[0] += a, state[1] += b, state[2] += c, state[3] += d;
  state[4] += e, state[5] += f, state[6] += g, state[7] += h;
}

__attribute__((noinline)) static void digest(const char *text) {
  size_t length = strlen(text), blocks = (length + 9 + 63) / 64;
  uint32_t saved[8];
  memcpy(saved, state, sizeof state);
  for (size_t block = 0; block < blocks; block++) {
    memset(schedule, 0, sizeof schedule);
    for (size_t i = 0; i < 64; i++) {
      size_t at = block * 64 + i;
      uint32_t byte = at < length ? (unsigned char)text[at] : at == length ? 0x80 : 0;
      schedule[i / 4] |= byte << (24 - i % 4 * 8);
    }
    if (block == blocks - 1)
      schedule[15] = (uint32_t)length * 8;
    compress();
  }
  for (int i = 0; i < 8; i++)
    printf("%08x", (unsigned)state[i]);
  puts("");
  memcpy(state, saved, sizeof state);
}

int main(void) {
  initialise();
  printf("%08x %08x %08x\n", (unsigned)state[7], (unsigned)round_constants[0], (unsigned)round_constants[63]);
  digest("");
  digest("abc");
  digest("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq");
  return 0;
}
