// Unnamed arguments: scalars as they are, aggregates by the address of a copy (docs/abi.md, "Calls").
// RUN: %clang -O1 -S -emit-llvm %s -o - | FileCheck %s

#include <stdarg.h>
typedef struct { float x, y, z; } vec3;
struct big { int v[6]; };

// CHECK-LABEL: define{{.*}} float @receive(i32 {{[^,]*}}%0, ...)
// CHECK: call void @llvm.va_start.p0(ptr
// CHECK: va_arg ptr %{{.*}}, ptr
// CHECK: va_arg ptr %{{.*}}, ptr
// CHECK: va_arg ptr %{{.*}}, double
float receive(int n, ...) {
  va_list list;
  va_start(list, n);
  vec3 v = va_arg(list, vec3);
  struct big b = va_arg(list, struct big);
  double d = va_arg(list, double);
  va_end(list);
  return v.x + b.v[5] + (float)d;
}

// The named vec3 is in registers, the unnamed ones are not; byval would put the bytes where va_arg wants an address.
// CHECK-LABEL: define{{.*}} float @send(
// CHECK: call float (i32, ...) @receive_any(i32 noundef 1, ptr {{[^,]*}}%{{[^,]*}}, ptr {{[^,]*}}%{{[^,]*}}, double noundef 2.000000e+00)
// CHECK-NOT: byval
float receive_any(int, ...);
float receive_named(vec3, ...);
float send(vec3 v, struct big *b) { return receive_any(1, v, *b, 2.0); }
// CHECK-LABEL: define{{.*}} float @send_named(
// CHECK: call float (float, float, float, ...) @receive_named(float %0, float %1, float %2, ptr {{[^,]*}}%{{[^,)]*}})
float send_named(vec3 v) { return receive_named(v, v); }
