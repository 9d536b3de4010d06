// Bit fields: packed from the low bits up, aligned as their type, as on other little-endian ELF targets.
// RUN: %clang -fsyntax-only %s
// RUN: %clang -O1 -S -emit-llvm %s -o - | FileCheck %s

struct a { unsigned x : 3, y : 5, z : 24; };
_Static_assert(sizeof(struct a) == 4, "");
struct b { char c; int x : 30; };
_Static_assert(sizeof(struct b) == 8, "");
struct c { int x : 3; int : 0; int y : 3; };
_Static_assert(sizeof(struct c) == 8, "");
struct d { long long x : 40; int y : 20; };
_Static_assert(sizeof(struct d) == 8 && _Alignof(struct d) == 4, "");

// CHECK-LABEL: define{{.*}} i32 @get(i32 %0)
// CHECK: lshr i32 %0, 3
// CHECK: and i32 {{.*}}, 31
unsigned get(struct a a) { return a.y; }

// CHECK-LABEL: define{{.*}} i32 @get_signed(i32 %0, i32 %1)
// CHECK: shl i32
// CHECK: ashr exact i32
int get_signed(struct b b) { return b.x; }

// CHECK-LABEL: define{{.*}} i32 @set(i32
// CHECK: ret i32
struct a set(struct a a, unsigned v) {
  a.z = v;
  return a;
}
