// The constraint f, other machines' for floats, is a register as any.
// RUN: %clang -O1 -S %s -o - | FileCheck %s
// CHECK: fadd r4, r4, r5
float sum(float a, float b) {
  __asm__("fadd %0, %0, %1" : "+f"(a) : "f"(b));
  return a;
}
