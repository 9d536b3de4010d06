// A vector library by value is straight arithmetic: nothing goes through memory, neither in the functions themselves nor where they
// are inlined, and a square root with a division is one instruction if an approximation is allowed.
// RUN: %clang -O3 -ffast-math -S %s -o - | FileCheck %s --implicit-check-not='{{^[[:space:]]+([ls][bhw]u?|call|fdiv|cmovn?z)[[:space:]]}}'
// RUN: %clang -Os -ffast-math -S %s -o - | FileCheck %s --implicit-check-not='{{^[[:space:]]+([ls][bhw]u?|call|fdiv|cmovn?z)[[:space:]]}}'
// Without it the square root is the library's, correctly rounded, and what is needed behind its call is saved.
// RUN: %clang -O3 -S %s -o - | FileCheck %s --check-prefix=STRICT
typedef struct {
  float x, y, z;
} vec3;

float sqrtf(float);

#define LIBRARY(KIND, NAME)                                                                                            \
  KIND vec3 NAME(add)(vec3 a, vec3 b) { return (vec3){a.x + b.x, a.y + b.y, a.z + b.z}; }                              \
  KIND vec3 NAME(sub)(vec3 a, vec3 b) { return (vec3){a.x - b.x, a.y - b.y, a.z - b.z}; }                              \
  KIND vec3 NAME(mul)(vec3 a, vec3 b) { return (vec3){a.x * b.x, a.y * b.y, a.z * b.z}; }                              \
  KIND vec3 NAME(scale)(vec3 a, float s) { return (vec3){a.x * s, a.y * s, a.z * s}; }                                 \
  KIND float NAME(dot)(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }                                   \
  KIND vec3 NAME(cross)(vec3 a, vec3 b) {                                                                              \
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};                                \
  }                                                                                                                    \
  KIND vec3 NAME(normalize)(vec3 a) { return NAME(scale)(a, 1.0f / sqrtf(NAME(dot)(a, a))); }                          \
  KIND vec3 NAME(reflect)(vec3 d, vec3 n) { return NAME(sub)(d, NAME(scale)(n, 2.0f * NAME(dot)(d, n))); }
#define CALLED(NAME) NAME
#define INLINED(NAME) inlined_##NAME
LIBRARY(, CALLED)
LIBRARY(static inline, INLINED)

// Each of them in as many instructions as it has operations.
// CHECK-LABEL: add:
// CHECK: fadd r4, r{{[47]}}, r{{[47]}}
// CHECK-NEXT: fadd r5, r{{[58]}}, r{{[58]}}
// CHECK-NEXT: fadd r6, r{{[69]}}, r{{[69]}}
// CHECK-NEXT: ret
// CHECK-LABEL: sub:
// CHECK: fsub r4, r4, r7
// CHECK-NEXT: fsub r5, r5, r8
// CHECK-NEXT: fsub r6, r6, r9
// CHECK-NEXT: ret
// CHECK-LABEL: mul:
// CHECK: fmul r4,
// CHECK-NEXT: fmul r5,
// CHECK-NEXT: fmul r6,
// CHECK-NEXT: ret
// CHECK-LABEL: scale:
// CHECK: fmul r4,
// CHECK-NEXT: fmul r5,
// CHECK-NEXT: fmul r6,
// CHECK-NEXT: ret
// CHECK-LABEL: dot:
// CHECK-COUNT-5: {{fmul|fadd}} {{r[0-9]+}},
// CHECK-NEXT: ret
// CHECK-LABEL: cross:
// CHECK: fmul
// CHECK: ret
// CHECK-LABEL: normalize:
// CHECK-COUNT-5: {{fmul|fadd}} {{r[0-9]+}},
// CHECK-NEXT: frsqrt
// CHECK-NEXT: fmul r4,
// CHECK-NEXT: fmul r5,
// CHECK-NEXT: fmul r6,
// CHECK-NEXT: ret
// CHECK-LABEL: reflect:
// CHECK-COUNT-12: {{fmul|fadd|fsub}} {{r[0-9]+}},
// CHECK-NEXT: ret

// STRICT-LABEL: add:
// STRICT-NOT: {{^[[:space:]]+[ls]w[[:space:]]}}
// STRICT-LABEL: normalize:
// STRICT: call sqrtf
// STRICT: fdiv
// STRICT: ret
// STRICT-LABEL: reflect:
// STRICT-NOT: {{^[[:space:]]+[ls]w[[:space:]]}}
// STRICT: ret

// Many of them together: still nothing in memory.
// CHECK-LABEL: bounce:
// CHECK-COUNT-2: frsqrt
// CHECK: ret
vec3 bounce(vec3 d, vec3 e, float t) {
  vec3 n = inlined_cross(inlined_add(d, inlined_scale(e, t)), inlined_mul(inlined_sub(d, e), e));
  return inlined_reflect(inlined_normalize(d), inlined_normalize(n));
}
