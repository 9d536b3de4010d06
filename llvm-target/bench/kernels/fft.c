/* The fast Fourier transform of 1024 complex numbers, radix 2, in place, and back. */
#include "../bench.h"

#include <math.h>

enum { LOG2_N = 10, N = 1 << LOG2_N };
struct complex {
  float re, im;
};
static struct complex data[N], roots[N / 2];

void kernel_setup(void) {
  for (int i = 0; i < N / 2; i++) {
    /* sin and cos by their series, so that every machine has the same table. */
    float angle = -6.2831853f * (float)i / N, square = angle * angle, sine = 0, cosine = 0, term = 1;
    for (int k = 1; k < 20; k += 2) {
      cosine += term;
      sine += term * angle / (float)k;
      term *= -square / (float)(k * (k + 1));
    }
    roots[i] = (struct complex){cosine, sine};
  }
}

static void transform(struct complex *x, float sign) {
  for (unsigned i = 0, j = 0; i < N; i++) {
    if (i < j) {
      struct complex swapped = x[i];
      x[i] = x[j];
      x[j] = swapped;
    }
    unsigned bit = N >> 1;
    for (; j & bit; bit >>= 1)
      j ^= bit;
    j |= bit;
  }
  for (int half = 1; half < N; half *= 2)
    for (int start = 0; start < N; start += 2 * half)
      for (int k = 0; k < half; k++) {
        struct complex root = roots[k * (N / 2 / half)], *a = &x[start + k], *b = a + half;
        float im = sign * root.im;
        struct complex turned = {b->re * root.re - b->im * im, b->re * im + b->im * root.re};
        *b = (struct complex){a->re - turned.re, a->im - turned.im};
        *a = (struct complex){a->re + turned.re, a->im + turned.im};
      }
}

struct result kernel_run(void) {
  uint32_t random = 17, checksum = 0;
  for (int i = 0; i < N; i++) {
    data[i].re = next_float(&random);
    data[i].im = next_float(&random);
  }
  transform(data, 1);
  for (int i = 0; i < N; i += 8)
    checksum = mix_float(mix_float(checksum, data[i].re), data[i].im);
  transform(data, -1);
  float sum = 0;
  for (int i = 0; i < N; i++)
    sum += data[i].re;
  return (struct result){mix_float(checksum, sum), sum / N / N};
}
