// RUN: %run_c %s %t --turns -O0,-O1,-O3,-Os
// Numbers of many words: a factorial, a power, a remainder, digits of pi.
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { WORDS = 10 };
static uint32_t number[WORDS], scratch[WORDS];

__attribute__((noinline)) static uint32_t multiply(uint32_t *n, uint32_t by, uint32_t carry) {
  for (int i = 0; i < WORDS; i++) {
    uint64_t t = (uint64_t)n[i] * by + carry;
    n[i] = (uint32_t)t;
    carry = (uint32_t)(t >> 32);
  }
  return carry;
}

__attribute__((noinline)) static uint32_t divide(uint32_t *n, uint32_t by) {
  uint64_t rest = 0;
  for (int i = WORDS; i-- > 0;) {
    rest = rest << 32 | n[i];
    n[i] = (uint32_t)(rest / by);
    rest %= by;
  }
  return (uint32_t)rest;
}

__attribute__((noinline)) static int subtract(uint32_t *n, const uint32_t *m) {
  uint32_t borrow = 0;
  for (int i = 0; i < WORDS; i++) {
    uint32_t d = n[i] - m[i], e = d - borrow;
    borrow = (uint32_t)(n[i] < m[i]) | (uint32_t)(d < borrow);
    n[i] = e;
  }
  return (int)borrow;
}

__attribute__((noinline)) static void decimal(const uint32_t *n) {
  static uint32_t copy[WORDS];
  static char digits[100];
  memcpy(copy, n, sizeof copy);
  char *p = digits + sizeof digits - 1;
  for (int more = 1; more;) {
    *--p = (char)('0' + divide(copy, 10));
    more = 0;
    for (int i = 0; i < WORDS; i++)
      more |= copy[i] != 0;
  }
  puts(p);
}

__attribute__((noinline)) static void pi(int digits) { /* Rabinowitz and Wagon's spigot */
  static uint16_t rest[80];
  int length = digits * 10 / 3 + 1, held = 0, nines = 0;
  for (int i = 0; i < length; i++)
    rest[i] = 2;
  for (int d = 0; d <= digits; d++) {
    int carry = 0;
    for (int i = length; i-- > 0;) {
      int x = 10 * rest[i] + carry * (i + 1), odd = 2 * i + 1;
      rest[i] = (uint16_t)(i ? x % odd : x % 10);
      carry = i ? x / odd : x / 10;
    }
    if (carry == 9) {
      nines++;
      continue;
    }
    if (d)
      putchar('0' + held + carry / 10);
    for (; nines; nines--)
      putchar(carry / 10 ? '0' : '9');
    held = carry % 10;
  }
  puts("");
}

int main(void) {
  number[0] = 1;
  for (uint32_t i = 2; i <= 50; i++)
    multiply(number, i, 0);
  decimal(number);
  memcpy(scratch, number, sizeof number);
  uint32_t overflow = multiply(scratch, 0xFFFFFFFF, 0xFFFFFFFF);
  uint32_t low = scratch[5];
  int borrow = subtract(scratch, number);
  printf("%x %x %d %x\n", (unsigned)overflow, (unsigned)low, borrow, (unsigned)scratch[7]);
  uint32_t r = divide(number, 53);
  uint32_t t = divide(number, 4294967291u);
  printf("%u %u\n", (unsigned)r, (unsigned)t);
  decimal(number);
  pi(22);
  return 0;
}
