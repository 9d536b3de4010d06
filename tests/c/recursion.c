// RUN: %run_c %s %t
// Recursion within 512 bytes of stack, direct and mutual.
#include <stdio.h>

__attribute__((noinline)) static int fibonacci(int n) {
  return n < 2 ? n : fibonacci(n - 1) + fibonacci(n - 2);
}

__attribute__((noinline)) static int ackermann(int m, int n) {
  if (m == 0)
    return n + 1;
  return ackermann(m - 1, n == 0 ? 1 : ackermann(m, n - 1));
}

static int is_odd(int n);
__attribute__((noinline)) static int is_even(int n) {
  return n == 0 ? 1 : is_odd(n - 1);
}
__attribute__((noinline)) static int is_odd(int n) {
  return n == 0 ? 0 : is_even(n - 1);
}

static int moves;
__attribute__((noinline)) static void hanoi(int n, int from, int to) {
  if (n == 0)
    return;
  hanoi(n - 1, from, 6 - from - to);
  moves += from * to;
  hanoi(n - 1, 6 - from - to, to);
}

int main(void) {
  hanoi(7, 1, 3);
  printf("%d %d %d %d %d\n", fibonacci(9), ackermann(1, 4), is_even(8), is_odd(8), moves);
  return 0;
}
