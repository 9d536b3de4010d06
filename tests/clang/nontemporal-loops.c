// Nontemporal loads stay so in loops that LLVM would replace by memcpy, and the stores beside them do not become so.
// RUN: %clang -O1 -S %s -o - | FileCheck %s
// RUN: %clang -O2 -S %s -o - | FileCheck %s
// RUN: %clang -O3 -S %s -o - | FileCheck %s
// RUN: %clang -Os -S %s -o - | FileCheck %s
// RUN: %clang -O2 -S -emit-llvm %s -o - | FileCheck %s --check-prefix=IR
// IR-NOT: trax.temporal

// CHECK-LABEL: whole:
// CHECK-NOT: {{lw[^n][^(]*[(]r([013-9]|[12][0-9])[)]|memcpy|memmove|swnt}}
// CHECK: lwnt
// CHECK-NOT: {{lw[^n][^(]*[(]r([013-9]|[12][0-9])[)]|memcpy|memmove|swnt}}
// CHECK: .Lfunc_end0:
struct box {
  float min[3], max[3];
};
float whole(const unsigned *words) {
  unsigned copy[6];
  struct box box;
  for (int i = 0; i < 6; i++)
    copy[i] = __builtin_nontemporal_load(&words[i]);
  __builtin_memcpy(&box, copy, sizeof box);
  return box.min[0] * box.max[0] + box.min[1] * box.max[1] + box.min[2] * box.max[2];
}

// CHECK-LABEL: copy:
// CHECK-NOT: {{lw[^n][^(]*[(]r([013-9]|[12][0-9])[)]|memcpy|memmove|swnt}}
// CHECK: lwnt
// CHECK-NOT: {{lw[^n][^(]*[(]r([013-9]|[12][0-9])[)]|memcpy|memmove|swnt}}
// CHECK: .Lfunc_end1:
void copy(unsigned *restrict to, const unsigned *restrict from, int count) {
  for (int i = 0; i < count; i++)
    to[i] = __builtin_nontemporal_load(&from[i]);
}

// CHECK-LABEL: plain:
// CHECK: memcpy
// CHECK: .Lfunc_end2:
void plain(unsigned *restrict to, const unsigned *restrict from, int count) {
  for (int i = 0; i < count; i++)
    to[i] = from[i];
}
