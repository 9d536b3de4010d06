// RUN: %run_c %s %t --cflags "-mstack=global"
// Vectors of clang's and gcc's kind: the machine has none, so they are taken apart. (Expected output by clang.)
#include <stdio.h>
#include <string.h>

typedef float float4 __attribute__((vector_size(16)));
typedef int int4 __attribute__((vector_size(16)));
typedef unsigned char byte8 __attribute__((vector_size(8)));
typedef long long long2 __attribute__((vector_size(16)));
typedef double double2 __attribute__((vector_size(16)));
typedef short short3 __attribute__((ext_vector_type(3)));
typedef float float3 __attribute__((ext_vector_type(3)));

#define NOINLINE __attribute__((noinline)) static

NOINLINE float4 scaled(float4 a, float s, float4 b) {
  return a * s + b / 2 - -a;
}
NOINLINE int4 compared(float4 a, float4 b) {
  return (a < b) | (a == 4.0f);
}
NOINLINE int4 bits(int4 a, int4 b) {
  return ((a << 2 ^ b >> 1) & ~b) % 1000;
}
NOINLINE byte8 bytes(byte8 a, byte8 b) {
  return (a + b) * 3 - (((byte8)(a > b) & a) | ((byte8)(a <= b) & b));
}
NOINLINE long2 wide(long2 a, int n) {
  a[n & 1] += 1LL << 40;
  return a * a - 3;
}
NOINLINE double2 doubles(double2 a) {
  return a / (double2){2, 4} + 1;
}
NOINLINE float3 swizzled(float3 a) {
  a.xz = a.zx * 2;
  return a.yzx + a.s210;
}
NOINLINE short3 narrow(short3 a) {
  return a * a - (short3)1;
}
NOINLINE int4 shuffled(int4 a, int4 b) {
  return __builtin_shufflevector(a, b, 7, 0, 5, 2);
}
NOINLINE int many(int4 a, int4 b, int4 c, byte8 d, int e) { // more than the registers hold
  return a[0] + b[1] * 10 + c[2] * 100 + d[7] * 1000 + e * 100000;
}

int main(void) {
  float4 a = {1, 2, 3, 4}, b = {4, 3, 2, 1}, r = scaled(a, 0.5f, b);
  printf("%g %g %g %g\n", (double)r[0], (double)r[1], (double)r[2], (double)r[3]);
  int4 i = compared(a, b), j = {1000, -2000, 3000, 0x12345678}, k = bits(j, i + 77);
  printf("%d %d %d %d\n", i[0], i[1], i[2], i[3]);
  printf("%d %d %d %d\n", k[0], k[1], k[2], k[3]);
  byte8 p = {1, 2, 3, 4, 250, 251, 252, 253}, q = bytes(p, p << 1);
  for (int n = 0; n < 8; n++)
    printf("%d ", q[n]);
  puts("");
  long2 w = wide((long2){1LL << 33, -5}, 1);
  double2 d = doubles((double2){3, -8});
  printf("%llx %llx %g %g\n", w[0], w[1], d[0], d[1]);
  float3 v = swizzled((float3){1, 2, 3});
  short3 s = narrow((short3){10, -300, 181});
  printf("%g %g %g %d %d %d %d %d\n", (double)v.x, (double)v.y, (double)v.z, s.x, s.y, s.z, (int)sizeof v,
         (int)sizeof s);
  int4 t = shuffled(i, j);
  printf("%d %d %d %d %d\n", t[0], t[1], t[2], t[3], many(j, j, j, p, 9));
  printf("%d %d\n", __builtin_reduce_add(j), __builtin_reduce_max(j));
  return 0;
}
