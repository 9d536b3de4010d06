// RUN: %run_c %s %t
// asm with register and immediate operands, clobbers and memory; register variables. (Expected output by hand.)
#include <stdio.h>

static int cells[4];

__attribute__((noinline)) static unsigned high_product(unsigned a, unsigned b) {
  unsigned r;
  __asm__("mulhu %0, %1, %2" : "=r"(r) : "r"(a), "r"(b));
  return r;
}
__attribute__((noinline)) static int add_constant(int a) {
  int r;
  __asm__("addi %0, %1, %2" : "=r"(r) : "r"(a), "I"(-123));
  return r;
}
__attribute__((noinline)) static int increment(int x) {
  __asm__ volatile("addi %0, %0, 1" : "+r"(x));
  return x;
}
__attribute__((noinline)) static void store(int *p, int value) {
  __asm__ volatile("sw %1, 0(%0)" : : "r"(p), "r"(value) : "memory");
}
__attribute__((noinline)) static float reciprocal_root(float x) {
  float r;
  __asm__("frsqrt %0, %1" : "=r"(r) : "r"(x));
  return r;
}
__attribute__((noinline)) static int clobbers(int a, int b) {
  int kept = a * b;
  __asm__ volatile("addi r20, r0, 0\n\taddi r21, r0, 0\n\taddi r12, r0, 0" : : : "r20", "r21", "r12");
  return kept + a + b;
}
__attribute__((noinline)) static int lower_half(long long a) { // a word in the register of a double word
  int low;
  __asm__("" : "=r"(low) : "0"(a));
  return low;
}
__attribute__((noinline)) static long long swapped(long long a) { // each in two registers
  long long r;
  __asm__("mv %0, %H1\n\tmv %H0, %1" : "=&r"(r) : "r"(a));
  return r;
}
__attribute__((noinline)) static double negated(double a) {
  unsigned sign = 0x80000000;
  __asm__("xor %H0, %H0, %1" : "+r"(a) : "r"(sign));
  return a;
}
__attribute__((noinline)) static int sign(int a) {
  __asm__ goto("blt %0, r0, %l1\n\tbeq %0, r0, %l[zero]" : : "r"(a) : : negative, zero);
  return 1;
negative:
  return -1;
zero:
  return 0;
}
__attribute__((noinline)) static int steps(int a, int *p) { // results on both ways out
  int r = a;
  __asm__ goto("addi %0, %0, 1\n\tblt %0, r0, %l[out]\n\tsw %0, %1" : "+r"(r), "=m"(*p) : : : out);
  return r;
out:
  return -r;
}

int main(void) {
  printf("%x %d %d\n", high_product(0xFFFFFFFF, 0x80000000), add_constant(1000), increment(41));
  store(&cells[2], 77);
  printf("%d %g %d\n", cells[2], (double)reciprocal_root(16.0f), clobbers(6, 7));
  printf("%x %d %d %d\n", (unsigned)lower_half(0x123456789ABCDEF0), sign(-5), sign(0), sign(7));
  printf("%llx %g\n", (unsigned long long)swapped(0x123456789ABCDEF0), negated(2.5));
  int cell = 0, up = steps(4, &cell);
  printf("%d %d %d %d\n", up, cell, steps(-4, &cell), cell);
  return 0;
}
