/* The product of two matrices of integers. */
#include "../bench.h"

enum { N = 48 };
static int a[N][N], b[N][N], c[N][N];

void kernel_setup(void) {
  uint32_t random = 1;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      a[i][j] = (int)(next_random(&random) >> 20);
      b[i][j] = (int)(next_random(&random) >> 20);
    }
}

static void multiply(int n, const int *x, const int *y, int *product) {
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      int sum = 0;
      for (int k = 0; k < n; k++)
        sum += x[i * n + k] * y[k * n + j];
      product[i * n + j] = sum;
    }
}

struct result kernel_run(void) {
  multiply(N, a[0], b[0], c[0]);
  uint32_t checksum = 0;
  for (int i = 0; i < N; i++)
    checksum = mix(checksum, (uint32_t)c[i][(7 * i) % N]);
  return (struct result){checksum, 0};
}
