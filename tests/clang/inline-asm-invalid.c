// The assembler's complaints about inline assembly point at the C source.
// RUN: not %clang -c %s -o %t.o 2>&1 | FileCheck %s
// CHECK: inline-asm-invalid.c:[[@LINE+2]]:{{[0-9]+}}: error:
// CHECK: <inline asm>:1:{{[0-9]+}}: note: instantiated into assembly here
void f(void) { __asm__("frobnicate r1"); }
