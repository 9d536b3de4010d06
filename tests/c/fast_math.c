// RUN: %run_c %s %t --turns -O1,-O2,-O3,-Os --cflags -ffast-math
// RUN: %run_c %s %t --levels -O2
// Results under -ffast-math stay near the exact ones. (Expected output by hand.)
#include <math.h>
#include <stdio.h>

struct vec {
  float x, y, z;
};

static volatile float scales[] = {1e-15f, 1e-3f, 0.7f, 1, 3, 12345.6f, 1e18f};

__attribute__((noinline)) static float length(struct vec v) {
  return sqrtf(v.x * v.x + v.y * v.y + v.z * v.z);
}
__attribute__((noinline)) static struct vec normalise(struct vec v) {
  float l = 1 / sqrtf(v.x * v.x + v.y * v.y + v.z * v.z);
  return (struct vec){v.x * l, v.y * l, v.z * l};
}
__attribute__((noinline)) static float quotient(float a, float b) {
  return a / b;
}
__attribute__((noinline)) static float sum(const float *v, int n) {
  float s = 0;
  for (int i = 0; i < n; i++)
    s += v[i] * 0.25f;
  return s * 4;
}
__attribute__((noinline)) static int near(float a, float b) {
  return fabsf(a - b) <= 2e-6f * fabsf(b);
}

int main(void) {
  int good = 0, total = 0;
  for (int i = 0; i < 7; i++) {
    float s = scales[i];
    struct vec v = {2 * s, -3 * s, 6 * s}, n = normalise(v);
    good += near(length(v), 7 * s) + near(n.x, 2 / 7.0f) + near(n.y, -3 / 7.0f) + near(n.z, 6 / 7.0f);
    good += near(quotient(s, 3), s * 0.33333334f) + near(quotient(s * 8, s), 8);
    total += 6;
  }
  static const float parts[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  good += near(sum(parts, 9), 45) + (length((struct vec){0, 0, 0}) == 0);
  printf("%d of %d\n", good, total + 2);
  return 0;
}
