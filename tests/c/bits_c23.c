// RUN: %run_c %s %t --turns -O0,-O2
// <stdbit.h>. (Expected output by hand: the host of Debian 12 has no such header.)
#include <stdbit.h>
#include <stdio.h>

int main(void) {
  unsigned char c = 0x16;
  unsigned long long x = 1ull << 40;
  printf("%u %u %u %u\n", stdc_count_ones(c), stdc_count_zeros(c), stdc_leading_zeros(c), stdc_trailing_zeros(c));
  printf("%u %u %u %u\n", stdc_leading_zeros(x), stdc_bit_width(x), stdc_first_trailing_one(x), stdc_leading_ones(x));
  printf("%u %u %u %d %d\n", stdc_bit_floor(100u), stdc_bit_ceil(100u), stdc_bit_ceil(0u), stdc_has_single_bit(64u),
         stdc_has_single_bit(0u));
  printf("%u %u\n", stdc_leading_zeros(0u), stdc_first_leading_zero((unsigned char)0xF0));
  return 0;
}
