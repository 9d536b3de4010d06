// At -O3 small innermost loops are unrolled eight times, and loops around them where the copies share loads; at -O2 loops of
// a few instructions four times, since the instruction cache counts more.
// RUN: %clang -O3 -S %s -o - | FileCheck %s
// RUN: %clang -O2 -S %s -o - | FileCheck %s --check-prefix=O2
// RUN: %clang -Os -S %s -o - | FileCheck %s --check-prefix=SMALL

// CHECK-LABEL: dot:
// CHECK-COUNT-8: fmul
// CHECK: bne
// CHECK-LABEL: find:
// CHECK: lbu
// CHECK: beqz
// CHECK: lbu {{r[0-9]+}}, 1([[P:r[0-9]+]])
// CHECK: lbu {{r[0-9]+}}, 7([[P]])
// CHECK: addi [[P]], [[P]], 8
// O2-LABEL: dot:
// O2-COUNT-4: fmul
// O2: bne
// O2-LABEL: find:
// SMALL-LABEL: dot:
// SMALL-COUNT-1: fmul
// SMALL-NOT: fmul
// SMALL-LABEL: find:
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

// Eight columns at once, four rows of b in an iteration: an element of a is loaded once for the eight.
// At -O2 each pointer is a register: none is a sum of a base and an offset.
// CHECK-LABEL: matrix_product:
// CHECK: .LBB2_3:
// CHECK-COUNT-32: fadd
// CHECK-NOT: fadd
// CHECK: bne {{r[0-9]+}}, {{r[0-9]+}}, .LBB2_3
// CHECK: ret
// O2-LABEL: matrix_product:
// O2: .LBB2_3:
// O2-NOT: {{[^f]}}add {{r[0-9]+}}, {{r[0-9]+}}, {{r[0-9]+}}
// O2-COUNT-4: fmul
// O2: bne {{r[0-9]+}}, {{r[0-9]+}}, .LBB2_3
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

// The inner loop begins with one iteration, and has half of the outer one's on average: no copies at -O2.
// CHECK-LABEL: triangle:
// CHECK-COUNT-8: mul
// O2-LABEL: triangle:
// O2-COUNT-1: mul r
// O2-NOT: mul r
// O2: ret
int triangle(const int *x, const int *y, int count) {
  int sum = 0;
  for (int i = 1; i < count; i++)
    for (int j = 0; j < i; j++)
      sum ^= x[j] * y[j];
  return sum;
}
