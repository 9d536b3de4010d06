// RUN: %run_c %s %t
// Code that optimisers rewrite: loops that become closed forms or library calls, selections, tail calls, induction.
#include <stdio.h>
#include <string.h>

static int array[64];
static char text[64];

__attribute__((noinline)) static unsigned triangle(unsigned n) {
  unsigned sum = 0;
  for (unsigned i = 1; i <= n; i++)
    sum += i;
  return sum;
}
__attribute__((noinline)) static void fill(int *p, int n) {
  for (int i = 0; i < n; i++)
    p[i] = 0;
  for (int i = 0; i < n; i += 2)
    p[i] = i * 3;
}
__attribute__((noinline)) static int length(const char *s) {
  int n = 0;
  while (*s++)
    n++;
  return n;
}
__attribute__((noinline)) static unsigned gcd(unsigned a, unsigned b) {
  return b ? gcd(b, a % b) : a;
}
__attribute__((noinline)) static int saturate(int x) {
  return x > 255 ? 255 : x < 0 ? 0 : x;
}
__attribute__((noinline)) static int sign(int x) {
  return (x > 0) - (x < 0);
}
__attribute__((noinline)) static int collatz(unsigned n) {
  int steps = 0;
  for (; n != 1; steps++)
    n = n & 1 ? 3 * n + 1 : n / 2;
  return steps;
}

int main(void) {
  fill(array, 64);
  int sum = 0;
  for (int i = 0; i < 64; i++)
    sum += array[i] * (i & 3);
  memset(text, 'x', 20);
  printf("%u %d %d %u %d %d %d %d\n", triangle(100000), sum, length(text), gcd(3528, 3780), saturate(300), saturate(-2),
         sign(-7), collatz(27));
  return 0;
}
