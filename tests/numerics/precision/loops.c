/* Loops over the special unit on one TP, for each of whose precisions precision.py runs this program: the library's
   sqrtf, normalising vectors with frsqrt, quotients, and functions that promise not to depend on the unit's precision.
   Results go to the buffer "results": four sections of COUNT words; cycles of each loop, and a hash of the last
   section's functions, are printed. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <trax.h>

enum { COUNT = 4096 };

struct trax_buffer results;

static unsigned state = 1;

static float draw(float low, float high) {
  state = state * 1664525u + 1013904223u;
  return low + (high - low) * ((float)(state >> 8) * 0x1p-24f);
}

static float in[3][COUNT];

static uint32_t hash(uint32_t h, float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  return (h ^ bits) * 16777619u;
}

int main(void) {
  float *out = results.data;
  if (results.size < 3 * COUNT * sizeof(float))
    return 1;
  for (int i = 0; i < COUNT; i++) {
    in[0][i] = draw(1, 4);
    in[1][i] = draw(-1, 1);
    in[2][i] = draw(-1, 1);
  }
  unsigned start = trax_cycles();
  for (int i = 0; i < COUNT; i++)
    out[i] = sqrtf(in[0][i]);
  unsigned sqrt_cycles = trax_cycles() - start;
  start = trax_cycles();
  for (int i = 0; i < COUNT; i++) { /* the squared length of a normalised vector */
    float x = in[0][i], y = in[1][i], z = in[2][i], inverse = trax_rsqrt(x * x + y * y + z * z);
    x *= inverse;
    y *= inverse;
    z *= inverse;
    out[COUNT + i] = x * x + y * y + z * z;
  }
  unsigned normalise_cycles = trax_cycles() - start;
  start = trax_cycles();
  for (int i = 0; i < COUNT; i++)
    out[2 * COUNT + i] = in[1][i] / in[0][i];
  unsigned divide_cycles = trax_cycles() - start;
  uint32_t h = 2166136261u;
  for (int i = 0; i < COUNT; i += 8) {
    h = hash(h, hypotf(in[1][i], in[2][i]));
    h = hash(h, asinf(in[1][i]));
    h = hash(h, acosf(in[2][i]));
    h = hash(h, asinhf(in[0][i]));
    h = hash(h, acoshf(in[0][i]));
    h = hash(h, expm1f(in[1][i]));
    h = hash(h, log1pf(in[2][i]));
    double root = sqrt((double)in[0][i]);
    h = hash(h, (float)root);
    h = hash(h, (float)(root - (double)(float)root)); /* so that it stays a function of binary64 */
  }
  printf("%u %u %u %08x\n", sqrt_cycles, normalise_cycles, divide_cycles, (unsigned)h);
  return 0;
}
