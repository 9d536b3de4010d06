// Builtins keep their full names, also in freestanding code, and take nothing from the program's own names.
// RUN: %clang -O2 -S -emit-llvm %s -o - | FileCheck %s
// RUN: %clang -O2 -ffreestanding -S -emit-llvm %s -o - | FileCheck %s
// RUN: %clang -x c++ -O2 -S -emit-llvm %s -o - | FileCheck %s
// RUN: %clang -O0 -S -emit-llvm %s -o - | FileCheck %s --check-prefix=O0

#ifdef __cplusplus
extern "C" {
#endif

#if !__has_builtin(__builtin_trax_rsqrt) || !__has_builtin(__builtin_trax_ainc)
#error the builtins are not announced
#endif

// CHECK-LABEL: define{{.*}} float @trax_rsqrt(float
// CHECK: call float @__builtin_trax_rsqrt(float
// O0-LABEL: define{{.*}} float @trax_rsqrt(float
// O0: call float @__builtin_trax_rsqrt(float
float trax_rsqrt(float x) { return __builtin_trax_rsqrt(x); }

// The function is const: two calls become one, and an unused one goes.
// CHECK-LABEL: define{{.*}} float @pure(float
// CHECK: call float @__builtin_trax_rsqrt
// CHECK-NOT: call
// CHECK: ret
float pure(float x) {
  (void)__builtin_trax_rsqrt(2 * x);
  return __builtin_trax_rsqrt(x) + __builtin_trax_rsqrt(x);
}

// CHECK-LABEL: define{{.*}} i32 @registers(
// CHECK: call i32 @__builtin_trax_rdsr(i32 noundef 0)
// CHECK: call i32 @__builtin_trax_rdsr(i32 noundef 5)
unsigned registers(void) { return __builtin_trax_rdsr(0) + __builtin_trax_rdsr(5); }

// CHECK-LABEL: define{{.*}} i32 @count(ptr
// CHECK: call i32 @__builtin_trax_ainc(ptr
unsigned count(unsigned *p) { return __builtin_trax_ainc(p); }

// CHECK-LABEL: define{{.*}} i32 @hidden(
// CHECK: call i32 @__builtin_trax_opaque(i32 noundef 7)
unsigned hidden(void) { return __builtin_trax_opaque(7); }

// CHECK-LABEL: define{{.*}} void @stop(
// CHECK: call void @__builtin_trax_trap(i32 noundef 42, i32 noundef 1)
// CHECK: call void @__builtin_trax_halt()
// CHECK-NEXT: unreachable
void stop(void) {
  __builtin_trax_trap(42, 1);
  __builtin_trax_halt();
}

#ifdef __cplusplus
}
#endif
