// Nothing of a vec3 touches memory.
// RUN: %clang -O2 -fno-stack-size-section -S %s -o - | FileCheck %s
// RUN: %clang -O2 -fno-stack-size-section -S %s -o - | grep -c fmul | FileCheck %s --check-prefix=MULTIPLIES
// MULTIPLIES: {{^}}3{{$}}

typedef struct { float x, y, z; } vec3;

// CHECK-LABEL: add:
// CHECK-NEXT: %bb.0:
// CHECK-NEXT: fadd r4, r4, r7
// CHECK-NEXT: fadd r5, r5, r8
// CHECK-NEXT: fadd r6, r6, r9
// CHECK-NEXT: ret
vec3 add(vec3 a, vec3 b) { return (vec3){a.x + b.x, a.y + b.y, a.z + b.z}; }

// CHECK-LABEL: dot:
// CHECK-NOT: {{[ls]w[[:space:]]|r2[,)]}}
// CHECK: ret
float dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// CHECK-LABEL: swap:
// CHECK-NOT: {{[ls]w[[:space:]]|r2[,)]}}
// CHECK: ret
vec3 swap(vec3 a) { return (vec3){a.z, a.y, a.x}; }
