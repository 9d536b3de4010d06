// -ffixed-rN: generated code leaves the register alone, those that clang's own table names for other targets (r9, r19) too.
// RUN: %clang -O2 -S -ffixed-r12 -ffixed-r13 -ffixed-r14 -ffixed-r15 -ffixed-r16 -ffixed-r17 -ffixed-r18 %s -o %t.s
// RUN: grep -E "\br19\b" %t.s && grep -E "\br20\b" %t.s && grep -E "\br31\b" %t.s && not grep -E "\br1[2-8]\b" %t.s
// RUN: %clang -O2 -S -ffixed-r9 -ffixed-r12 -ffixed-r13 -ffixed-r14 -ffixed-r15 -ffixed-r16 -ffixed-r17 -ffixed-r18 -ffixed-r19 -ffixed-r20 -ffixed-r31 %s -o %t.s
// RUN: %clang -O2 -S -mllvm -verify-machineinstrs -ffixed-r12 -ffixed-r20 %s -o /dev/null
// RUN: not grep -E "\br(9|12|19|20|31)\b" %t.s

// Registers that the ABI needs cannot be kept free.
// RUN: not %clang -O2 -S -ffixed-r5 %s -o /dev/null 2>&1 | FileCheck %s --check-prefix=NEEDED
// NEEDED: error: r5 is needed for an argument or a result, and -ffixed-rN keeps it free

// RUN: not %host_clang -S -ffixed-r12 %s -o /dev/null 2>&1 | FileCheck %s --check-prefix=HOST
// HOST: error: unsupported option '-ffixed-r' for target 'x86_64
int many(int, int);
int mix(int a, int b) {
  int x[12];
  for (int i = 0; i < 12; i++)
    x[i] = many(a * i, b);
  return x[0] ^ x[1] * x[2] ^ x[3] * x[4] ^ x[5] * x[6] ^ x[7] * x[8] ^ x[9] * x[10] ^ x[11];
}
int wide(const int *p, const int *q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3] + p[4] * q[4] + p[5] * q[5] + p[6] * q[6] + p[7] * q[7];
}
