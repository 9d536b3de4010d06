// RUN: %run_c %s %t --turns -O0,-O2,-Oz
// Generators: PCG, xorshift, Mersenne Twister, a linear congruence modulo a prime, floats from bits, a shuffle.
#include <stdint.h>
#include <stdio.h>

static uint64_t pcg_state = 42;
__attribute__((noinline)) static uint32_t pcg(void) {
  uint64_t old = pcg_state;
  pcg_state = old * 6364136223846793005u + 109;
  uint32_t x = (uint32_t)((old >> 18 ^ old) >> 27), n = (uint32_t)(old >> 59);
  return x >> n | x << (-n & 31);
}

static uint64_t shift_state[2] = {1, 2};
__attribute__((noinline)) static uint64_t xorshift(void) {
  uint64_t s = shift_state[0], t = shift_state[1];
  shift_state[0] = t;
  s ^= s << 23;
  shift_state[1] = s ^ t ^ s >> 17 ^ t >> 26;
  return shift_state[1] + t;
}

static uint32_t minimal = 1;
__attribute__((noinline)) static uint32_t standard(void) {
  return minimal = (uint32_t)(16807ull * minimal % 2147483647);
}

static uint32_t twister[624];
static int used = 624;
__attribute__((noinline)) static uint32_t mersenne(void) {
  if (used == 624) {
    for (int i = 0; i < 624; i++) {
      uint32_t y = (twister[i] & 0x80000000) | (twister[(i + 1) % 624] & 0x7FFFFFFF);
      twister[i] = twister[(i + 397) % 624] ^ y >> 1 ^ (y & 1 ? 0x9908B0DF : 0);
    }
    used = 0;
  }
  uint32_t y = twister[used++];
  y ^= y >> 11;
  y ^= y << 7 & 0x9D2C5680;
  y ^= y << 15 & 0xEFC60000;
  return y ^ y >> 18;
}

__attribute__((noinline)) static float uniform(void) {
  return (float)(pcg() >> 8) * 0x1p-24f;
}

int main(void) {
  for (int i = 0; i < 5; i++)
    printf("%08x %016llx %u\n", (unsigned)pcg(), (unsigned long long)xorshift(), (unsigned)standard());
  twister[0] = 5489;
  for (uint32_t i = 1; i < 624; i++)
    twister[i] = 1812433253 * (twister[i - 1] ^ twister[i - 1] >> 30) + i;
  uint32_t first = mersenne();
  for (int i = 0; i < 700; i++)
    mersenne();
  printf("%u %u\n", (unsigned)first, (unsigned)mersenne());
  float sum = 0, inside = 0;
  for (int i = 0; i < 200; i++) {
    float x = uniform(), y = uniform();
    sum += x;
    inside += x * x + y * y < 1;
  }
  printf("%a %g\n", (double)sum, (double)inside);
  unsigned char deck[26] = {0};
  for (int i = 0; i < 26; i++) {
    unsigned j = pcg() % (unsigned)(i + 1);
    deck[i] = deck[j];
    deck[j] = (unsigned char)('a' + i);
  }
  printf("%.26s\n", (const char *)deck);
  return 0;
}
