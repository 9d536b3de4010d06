// At -O3 small innermost loops are unrolled four times, and loops around them where the copies share loads; at -O2 the
// instruction cache counts more.
// RUN: %clang -O3 -S %s -o - | FileCheck %s
// RUN: %clang -O2 -S %s -o - | FileCheck %s --check-prefix=O2

// CHECK-LABEL: dot:
// CHECK: lw [[A:r[0-9]+]], -8(
// CHECK-COUNT-4: fmul
// CHECK: bne
// CHECK-LABEL: find:
// CHECK: lbu
// CHECK: beqz
// CHECK: lbu {{r[0-9]+}}, -2([[P:r[0-9]+]])
// CHECK: lbu {{r[0-9]+}}, -1([[P]])
// CHECK: lbu {{r[0-9]+}}, 0([[P]])
// CHECK: addi [[P]], [[P]], 4
// O2-LABEL: dot:
// O2-COUNT-1: fmul
// O2-NOT: fmul
// O2: bne
// O2-LABEL: find:
float dot(const float *a, const float *b, int count) {
  float sum = 0;
  for (int i = 0; i < count; i++)
    sum += a[i] * b[i];
  return sum;
}

const char *find(const char *text) {
  while (*text && *text != ':')
    text++;
  return text;
}

enum { N = 48 };
extern float a[N][N], b[N][N], c[N][N];

// Eight columns at once, two rows of b in an iteration: an element of a is loaded once for the eight.
// CHECK-LABEL: matrix_product:
// CHECK: .LBB2_3:
// CHECK-COUNT-16: fadd
// CHECK-NOT: fadd
// CHECK: bne {{r[0-9]+}}, {{r[0-9]+}}, .LBB2_3
// CHECK: ret
// O2-LABEL: matrix_product:
// O2-COUNT-1: fmul
// O2-NOT: fmul
// O2: ret
void matrix_product(void) {
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      float sum = 0;
      for (int k = 0; k < N; k++)
        sum += a[i][k] * b[k][j];
      c[i][j] = sum;
    }
}
