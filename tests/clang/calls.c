// Calls between separately compiled files agree on where aggregates and unnamed arguments are, at every level and between
// different ones.
// RUN: %clang -O0 -DCALLEE -c %s -o %t.callee.O0.o && %clang -O0 -DCALLER -c %s -o %t.caller.O0.o
// RUN: %clang -O2 -DCALLEE -c %s -o %t.callee.O2.o && %clang -O2 -DCALLER -c %s -o %t.caller.O2.o
// RUN: %clang %t.caller.O0.o %t.callee.O0.o -o %t && %trax_sim %t | FileCheck %s
// RUN: %clang %t.caller.O0.o %t.callee.O2.o -o %t && %trax_sim %t | FileCheck %s
// RUN: %clang %t.caller.O2.o %t.callee.O0.o -o %t && %trax_sim %t | FileCheck %s
// RUN: %clang %t.caller.O2.o %t.callee.O2.o -o %t && %trax_sim %t | FileCheck %s
#include <stdarg.h>
#include <stdio.h>

typedef struct { float x, y, z; } vec3;
typedef struct { char r, g, b; } rgb;
typedef struct { char c; long long l; short s; } mixed;
typedef struct { int v[6]; } big;
typedef struct { _Alignas(16) int v[5]; } aligned;
typedef struct { unsigned a : 3, b : 20, c : 17; } fields;
typedef union { float f; unsigned u; } bits;

vec3 cross(vec3 a, vec3 b);
rgb swap(rgb c);
mixed grow(mixed m, int by);
big reverse(big b);
int is_aligned(aligned a, int i);
fields more(fields f);
bits negate(bits b);
// Seven words of arguments before it: the double straddles the last register and the stack.
double straddle(int a, int b, int c, int d, int e, int f, int g, double h, vec3 v);
float sum(int n, ...);
_Complex float conjugate(_Complex float z);

#ifdef CALLEE
vec3 cross(vec3 a, vec3 b) { return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
rgb swap(rgb c) { return (rgb){c.b, c.g, c.r}; }
mixed grow(mixed m, int by) { return (mixed){m.c + by, m.l + by, m.s + by}; }
big reverse(big b) { return (big){{b.v[5], b.v[4], b.v[3], b.v[2], b.v[1], b.v[0]}}; }
int is_aligned(aligned a, int i) {
  aligned *volatile p = &a;
  return (unsigned)p % 16 == 0 ? p->v[i] : -1;
}
fields more(fields f) { return (fields){f.a + 1, f.b + 1, f.c + 1}; }
bits negate(bits b) { return (bits){.u = b.u ^ 0x80000000u}; }
double straddle(int a, int b, int c, int d, int e, int f, int g, double h, vec3 v) {
  return a + b + c + d + e + f + g + h + v.x + v.y + v.z;
}
// i int, l long long, d double, v vec3, b big, c rgb
float sum(int n, ...) {
  float total = 0;
  va_list list;
  va_start(list, n);
  const char *kinds = va_arg(list, const char *);
  for (int i = 0; i < n; ++i)
    switch (kinds[i]) {
    case 'i': total += va_arg(list, int); break;
    case 'l': total += va_arg(list, long long); break;
    case 'd': total += va_arg(list, double); break;
    case 'v': total += va_arg(list, vec3).z; break;
    case 'b': total += va_arg(list, big).v[5]; break;
    case 'c': total += va_arg(list, rgb).g; break;
    }
  va_end(list);
  return total;
}
_Complex float conjugate(_Complex float z) { return ~z; }
#endif

#ifdef CALLER
// One function for each case: main's frame would not leave printf enough of the 512 bytes.
static void __attribute__((noinline)) say(const char *name, int a, int b, int c) { printf("%s %d %d %d\n", name, a, b, c); }

static __attribute__((noinline)) void vectors(void) {
  // CHECK: cross -3 6 -3
  vec3 c = cross((vec3){1, 2, 3}, (vec3){4, 5, 6});
  say("cross", c.x, c.y, c.z);
}
static __attribute__((noinline)) void small(void) {
  // CHECK: swap 3 -2 1
  rgb c = swap((rgb){1, -2, 3});
  say("swap", c.r, c.g, c.b);
  // CHECK: bits -1 0 0
  say("bits", negate((bits){.f = 1}).f, 0, 0);
}
static __attribute__((noinline)) void padded(void) {
  // CHECK: grow 11 1010 -90
  mixed m = grow((mixed){1, 1000000000000, -100}, 10);
  say("grow", m.c, m.l - 999999999000, m.s);
}
static __attribute__((noinline)) void large(void) {
  // CHECK: reverse 6 5 1
  big r = reverse((big){{1, 2, 3, 4, 5, 6}});
  say("reverse", r.v[0], r.v[1], r.v[5]);
}
static __attribute__((noinline)) void overaligned(void) {
  // CHECK: aligned 5 0 0
  say("aligned", is_aligned((aligned){{1, 2, 3, 4, 5}}, 4), 0, 0);
}
static __attribute__((noinline)) void bit_fields(void) {
  // CHECK: fields 0 1000001 65537
  fields f = more((fields){7, 1000000, 65536});
  say("fields", f.a, f.b, f.c);
}
static __attribute__((noinline)) void stack(void) {
  // CHECK: straddle 42 0 0
  say("straddle", straddle(1, 2, 3, 4, 5, 6, 7, 8.0, (vec3){1, 2, 3}), 0, 0);
}
static __attribute__((noinline)) void unnamed(void) {
  // CHECK: sum 1111111 0 0
  float total = sum(6, "ildvbc", 1, 10ll, 100.0, (vec3){9, 9, 1000}, (big){{9, 9, 9, 9, 9, 1110000}}, (rgb){1, 0, 1});
  say("sum", total, 0, 0);
}
static __attribute__((noinline)) void complex_numbers(void) {
  // CHECK: complex 1 -2 0
  _Complex float z = conjugate(1 + 2.0if);
  say("complex", __real z, __imag z, 0);
}
int main(void) {
  vectors();
  small();
  padded();
  large();
  overaligned();
  bit_fields();
  stack();
  unnamed();
  complex_numbers();
  return 0;
}
#endif
