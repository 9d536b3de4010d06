/* The product of two matrices of floats. */
#include "../bench.h"

enum { N = 48 };
static float a[N][N], b[N][N], c[N][N];

void kernel_setup(void) {
  uint32_t random = 1;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      a[i][j] = next_float(&random);
      b[i][j] = next_float(&random);
    }
}

struct result kernel_run(void) {
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      float sum = 0;
      for (int k = 0; k < N; k++)
        sum += a[i][k] * b[k][j];
      c[i][j] = sum;
    }
  uint32_t checksum = 0;
  float total = 0;
  for (int i = 0; i < N; i++) {
    checksum = mix_float(checksum, c[i][i]);
    total += c[i][N - 1 - i];
  }
  return (struct result){checksum, total / N};
}
