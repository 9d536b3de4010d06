// Statements of docs/compiler.md and docs/refusals.md that no other test shows.
// RUN: %clang -O2 -S %s -o - | FileCheck %s
// RUN: %clang -mstack=global -dM -E %s | FileCheck %s --check-prefix=STACK
// RUN: %clang -dM -E %s | FileCheck %s --check-prefix=ABSENT
// STACK: #define __trax_global_stack__ 1
// ABSENT-NOT: __trax_global_stack__
// ABSENT-NOT: __unix__
#include <stdatomic.h>

// CHECK-LABEL: {{^}}store:
// CHECK: swnt
void store(unsigned *p) { __builtin_nontemporal_store(3u, p); }
// CHECK-LABEL: {{^}}merged:
// CHECK: lwnt
// CHECK-NOT: lwnt
// CHECK: ret
unsigned merged(const volatile unsigned *p) { return __builtin_nontemporal_load(p) + __builtin_nontemporal_load(p); }
// CHECK-LABEL: {{^}}each_time:
// CHECK: lwnt
// CHECK: lwnt
// CHECK: ret
unsigned each_time(const unsigned *p) { return __atomic_load_n(p, __ATOMIC_RELAXED) + __atomic_load_n(p, __ATOMIC_RELAXED); }
// The load stays in a loop that waits for it, as runtime.md and trax.h say.
// CHECK-LABEL: {{^}}wait_for:
// CHECK: [[LOOP:\.LBB[0-9_]+]]:
// CHECK: lwnt
// CHECK: b{{.*}}[[LOOP]]
// CHECK: ret
void wait_for(const unsigned *p) {
  while (__atomic_load_n(p, __ATOMIC_RELAXED) == 0)
    ;
}
// CHECK-LABEL: {{^}}quotient:
// CHECK: fdiv
float quotient(float a, float b) { return a / b; }
// CHECK-LABEL: {{^}}cycles:
// CHECK: rdsr {{.*}}cycleh
// CHECK: rdsr {{.*}}cycle
unsigned long long cycles(void) { return __builtin_readcyclecounter(); }
// CHECK-LABEL: {{^}}stop:
// CHECK: trap r0, abort
void stop(void) { __builtin_trap(); }
// CHECK-LABEL: {{^}}memory:
// CHECK: lw r{{[0-9]+}}, 8(r4)
int memory(int *p) {
  int v;
  __asm__("lw %0, %1" : "=r"(v) : "m"(p[2]));
  return v;
}
typedef int vector __attribute__((vector_size(8)));
// CHECK-LABEL: {{^}}elements:
// CHECK: add
// CHECK: add
vector elements(vector a, vector b) { return a + b; }
// CHECK-LABEL: {{^}}address:
// CHECK: mv r4, r1
void *address(void) { return __builtin_return_address(0); }
