/* Greatest common divisors and decimal digits by any base: divisions by variables. */
#include "../bench.h"

void kernel_setup(void) {}

static unsigned greatest_common_divisor(unsigned a, unsigned b) {
  while (b != 0) {
    unsigned rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

static unsigned digit_sum(unsigned value, unsigned base) {
  unsigned sum = 0;
  for (; value != 0; value /= base)
    sum += value % base;
  return sum;
}

struct result kernel_run(void) {
  uint32_t random = 77, checksum = 0;
  for (unsigned i = 0; i < 500; i++) {
    unsigned value = next_random(&random);
    checksum = mix(checksum, greatest_common_divisor(value, next_random(&random) >> 8));
    checksum = mix(checksum, digit_sum(value, 2 + i % 15));
  }
  return (struct result){checksum, 0};
}
