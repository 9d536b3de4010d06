// RUN: %run_c %s %t
// Float matrices: nested loops, elimination with pivots.
#include <math.h>
#include <stdio.h>

enum { N = 6 };
static float a[N][N + 1], b[N][N], c[N][N];

__attribute__((noinline)) static void multiply(void) {
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      float sum = 0;
      for (int k = 0; k < N; k++)
        sum += b[i][k] * b[k][j];
      c[i][j] = sum;
    }
}

__attribute__((noinline)) static void solve(void) {
  for (int i = 0; i < N; i++) {
    int pivot = i;
    for (int j = i + 1; j < N; j++)
      if (fabsf(a[j][i]) > fabsf(a[pivot][i]))
        pivot = j;
    for (int k = 0; k <= N; k++) {
      float t = a[i][k];
      a[i][k] = a[pivot][k];
      a[pivot][k] = t;
    }
    for (int j = 0; j < N; j++) {
      if (j == i)
        continue;
      float factor = a[j][i] / a[i][i];
      for (int k = i; k <= N; k++)
        a[j][k] -= factor * a[i][k];
    }
  }
}

int main(void) {
  for (int i = 0; i < N; i++)
    for (int j = 0; j <= N; j++) {
      a[i][j] = (float)((i * 7 + j * 13) % 11) - 4;
      if (j < N)
        b[i][j] = (float)(i - j) * 0.25f;
    }
  multiply();
  solve();
  for (int i = 0; i < N; i++)
    printf("%.4f %.4f %a\n", (double)c[i][i], (double)(a[i][N] / a[i][i]), (double)c[0][i]);
  return 0;
}
