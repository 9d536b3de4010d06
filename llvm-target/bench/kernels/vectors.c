/* Long vectors: a sum of products, a multiple added, the greatest element, a scaling. */
#include "../bench.h"

enum { N = 4000 };
static float x[N], y[N];

void kernel_setup(void) {}

static float dot(const float *a, const float *b, int n) {
  float sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

static void add_multiple(float *restrict to, const float *restrict from, float factor, int n) {
  for (int i = 0; i < n; i++)
    to[i] += factor * from[i];
}

static int greatest(const float *a, int n) {
  int at = 0;
  for (int i = 1; i < n; i++)
    if (a[i] > a[at])
      at = i;
  return at;
}

static void scale(float *a, float factor, int n) {
  for (int i = 0; i < n; i++)
    a[i] *= factor;
}

struct result kernel_run(void) {
  uint32_t random = 2;
  for (int i = 0; i < N; i++)
    x[i] = next_float(&random), y[i] = next_float(&random);
  add_multiple(y, x, 0.5f, N);
  scale(x, 1.5f, N);
  float product = dot(x, y, N);
  return (struct result){mix_float((uint32_t)greatest(y, N), product), product / N};
}
