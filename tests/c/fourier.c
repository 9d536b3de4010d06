// RUN: %run_c %s %t
// A fast Fourier transform of 64 points in binary32, there and back, to the bit.
#include <stdio.h>
#include <string.h>

enum { N = 64 };
static float re[N], im[N], cosine[N / 2], sine[N / 2];

__attribute__((noinline)) static unsigned bits(float x) {
  unsigned u;
  memcpy(&u, &x, 4);
  return u;
}

/* By the angle's sum from one accurate step: every library has these, only not
 * to the same bit. */
__attribute__((noinline)) static void twiddles(void) {
  const float c = 0x1.fd88dap-1f, s = 0x1.917a6cp-4f; /* cos and sin of 2 pi / 64 */
  float x = 1, y = 0;
  for (int i = 0; i < N / 2; i++) {
    cosine[i] = x;
    sine[i] = -y;
    float t = x * c - y * s;
    y = x * s + y * c;
    x = t;
  }
}

__attribute__((noinline)) static void reorder(void) {
  for (unsigned i = 0, j = 0; i < N; i++) {
    if (i < j) {
      float t = re[i];
      re[i] = re[j], re[j] = t;
      t = im[i];
      im[i] = im[j], im[j] = t;
    }
    unsigned bit = N >> 1;
    for (; j & bit; bit >>= 1)
      j ^= bit;
    j |= bit;
  }
}

__attribute__((noinline)) static void transform(float direction) {
  reorder();
  for (int half = 1; half < N; half *= 2)
    for (int start = 0; start < N; start += 2 * half)
      for (int k = 0; k < half; k++) {
        int a = start + k, b = a + half, w = k * (N / 2 / half);
        float s = sine[w] * direction;
        float x = re[b] * cosine[w] - im[b] * s, y = re[b] * s + im[b] * cosine[w];
        re[b] = re[a] - x, im[b] = im[a] - y;
        re[a] += x, im[a] += y;
      }
}

__attribute__((noinline)) static unsigned hash(const float *v) {
  unsigned h = 0;
  for (int i = 0; i < N; i++)
    h = h * 31 + bits(v[i]);
  return h;
}

int main(void) {
  twiddles();
  for (int i = 0; i < N; i++)
    re[i] = (float)((i * i * 7 + i * 3) % 17) - 8;
  float first = re[5];
  transform(1);
  for (int i = 0; i < 6; i++)
    printf("%08x %08x\n", bits(re[i * 5]), bits(im[i * 5]));
  printf("%08x %08x\n", hash(re), hash(im));
  transform(-1);
  printf("%08x %08x %d\n", hash(re), hash(im), re[5] / N - first < 1e-4f && re[5] / N - first > -1e-4f);
  return 0;
}
