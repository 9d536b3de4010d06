// RUN: %run_c %s %t
// Control flow: nested loops, continue, break out of two, goto into and out of blocks, loops without end, Duff's
// device.
#include <stdio.h>

static unsigned char from[23], to[23];

__attribute__((noinline)) static void copy(unsigned char *d, const unsigned char *s, int n) {
  int rounds = (n + 7) / 8;
  switch (n % 8) {
  case 0:
    do {
      *d++ = *s++;
      __attribute__((fallthrough));
    case 7:
      *d++ = *s++;
      __attribute__((fallthrough));
    case 6:
      *d++ = *s++;
      __attribute__((fallthrough));
    case 5:
      *d++ = *s++;
      __attribute__((fallthrough));
    case 4:
      *d++ = *s++;
      __attribute__((fallthrough));
    case 3:
      *d++ = *s++;
      __attribute__((fallthrough));
    case 2:
      *d++ = *s++;
      __attribute__((fallthrough));
    case 1:
      *d++ = *s++;
    } while (--rounds > 0);
  }
}

__attribute__((noinline)) static int triples(int limit) {
  int found = 0;
  for (int a = 1; a < limit; a++)
    for (int b = a; b < limit; b++) {
      if ((a ^ b) & 1 && a % 3 && b % 3)
        continue;
      for (int c = b + 1; c < limit; c++) {
        int d = a * a + b * b - c * c;
        if (d < 0)
          break;
        if (d == 0)
          found += a * b * c;
      }
    }
  return found;
}

__attribute__((noinline)) static int search(int key) {
  for (int i = 0; i < 10; i++)
    for (int j = 0; j < 10; j++)
      if (i * i + j * j * j == key) {
        key = i * 10 + j;
        goto found;
      }
  return -1;
found:
  return key;
}

__attribute__((noinline)) static int spaghetti(int n) {
  int sum = 0;
  if (n & 1)
    goto inside;
again:
  for (; n > 0; n -= 3) {
    sum += 100;
  inside:
    sum += n;
    if (sum % 7 == 0)
      goto outside;
  }
  return sum;
outside:
  n -= 2;
  sum ^= 5;
  goto again;
}

__attribute__((noinline)) static unsigned endless(unsigned x) {
  unsigned rounds = 0;
  for (;;) {
    x = x & 1 ? x * 5 + 1 : x >> 1;
    if (x % 16 == 9)
      return rounds << 8 | (x & 0xFF);
    if (++rounds == 100)
      break;
  }
  do
    x -= 3;
  while (x % 5 && x > 1000);
  return x;
}

__attribute__((noinline)) static int descending(void) {
  unsigned hash = 0;
  for (unsigned char i = 255; i != 250; i++, i -= 2)
    hash = hash * 3 + i;
  for (signed char c = -128; c < 127; c = (signed char)(c + 17 > 127 ? 127 : c + 17))
    hash = hash * 3 + (unsigned)c;
  for (unsigned long long l = 1ull << 40; l; l >>= 9)
    hash ^= (unsigned)(l >> 4);
  return (int)hash;
}

int main(void) {
  for (int i = 0; i < 23; i++)
    from[i] = (unsigned char)(i * 11);
  for (int n = 1; n < 23; n += 5) {
    copy(to, from, n);
    printf("%d %d %d\n", to[n - 1], to[n], to[0]);
  }
  printf("%d %d %d %d\n", triples(30), search(73), search(24), search(1000));
  for (int i = 0; i < 12; i += 3)
    printf("%d %d\n", spaghetti(i), spaghetti(i * 7));
  for (unsigned i = 1; i < 60; i += 13)
    printf("%u ", endless(i));
  printf("%x\n", (unsigned)descending());
  return 0;
}
