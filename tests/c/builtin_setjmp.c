// RUN: %run_c %s %t --cflags "-mstack=global"
// __builtin_setjmp and __builtin_longjmp: everything in registers, variable-length and over-aligned locals survive,
// twice over. (Expected output by hand.)
#include <stdio.h>

static void *buffer[5], *inner_buffer[5];
static volatile int jumps;

__attribute__((noinline)) static void jump(void **to) {
  jumps++;
  __builtin_longjmp(to, 1);
}

__attribute__((noinline)) static int deep(int n) { // with callee-saved registers and stack of its own
  volatile int here[8];
  here[n & 7] = n;
  if (n == 0) {
    jump(buffer);
    return 0;
  }
  return deep(n - 1) + here[n & 7];
}

__attribute__((noinline)) static void keeps(int a, int b, double c, const char *text) {
  int sum = a * b;
  if (__builtin_setjmp(buffer) == 0) {
    deep(20);
    puts("not reached");
  }
  printf("%d %d %d %g %s, %d jumps\n", a, b, sum, c, text, jumps);
}

__attribute__((noinline)) static void fill(int *array, int size) {
  for (int i = 0; i < size; i++)
    array[i] = i * i;
}

// The base pointer: sp moves, and the frame is over-aligned.
__attribute__((noinline)) static void moves(int size) {
  _Alignas(32) int aligned[4] = {1, 2, 3, size};
  int array[size];
  fill(array, size);
  fill(aligned, 3);
  if (!__builtin_setjmp(buffer))
    jump(buffer);
  unsigned address;
  __asm__("mv %0, %1" : "=r"(address) : "r"(aligned));
  printf("%d %d, aligned to 32: %d, %d\n", array[size - 1], aligned[3], address % 32 == 0, aligned[2]);
}

// Again and again into one function, from itself and from below.
__attribute__((noinline)) static int counts(int limit) {
  volatile int count = 0;
  __builtin_setjmp(inner_buffer);
  if (++count < limit)
    jump(inner_buffer);
  return count;
}

int main(void) {
  keeps(6, 7, 0.5, "text");
  moves(10);
  moves(3);
  printf("%d\n", counts(5));
  printf("%d jumps\n", jumps);
  return 0;
}
