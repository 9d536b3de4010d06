// At -O3 a long loop of unknown length that accesses memory is not copied; a short one is.
// RUN: %clang -O3 -S %s -o - | FileCheck %s

// CHECK-LABEL: long_loop:
// CHECK: mul
// CHECK-NOT: mul
// CHECK: .size
void long_loop(int *restrict a, const int *restrict b, const int *restrict c, const int *restrict d, unsigned n) {
  for (unsigned i = 0; i < n; i++)
    a[i] = (b[i] * c[i] ^ d[i] >> 3) + (a[i] & c[i]) - (d[i] | b[i] << 2) + (a[i] >> 5 ^ d[i]);
}

// CHECK-LABEL: short_loop:
// CHECK-COUNT-4: mul
int short_loop(const int *a, const int *b, unsigned n) {
  int sum = 0;
  for (unsigned i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}
