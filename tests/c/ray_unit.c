// RUN: %run_c %s %t --simflags "--set ray.units_per_group=1"
// The ray unit's tests of boxes and triangles are the same computation in C, in every bit: as builtins, and as the
// functions behind them. (Expected output by hand.)
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef float box_function(float, float, float, float, float, float, float, float, float, float, float, float, float);
typedef float triangle_function(float, float, float, float, float, float, float, float, float, float, float, float,
                                float, float, float, float);
extern box_function function_of_box __asm__("__builtin_trax_box");
extern triangle_function function_of_triangle __asm__("__builtin_trax_triangle");
static box_function *volatile box_pointer = function_of_box;
static triangle_function *volatile triangle_pointer = function_of_triangle;

static unsigned state = 1;

static unsigned any(unsigned limit) {
  state = state * 1664525 + 1013904223;
  return (state >> 8) % limit;
}

static unsigned bits(float x) {
  unsigned word;
  memcpy(&word, &x, sizeof word);
  return word;
}

/* Small integers, which meet, and fractions. */
static float number(void) {
  float small = (float)any(9) - 4;
  return any(3) ? small : small + (float)any(1000) * 0.001f;
}

static float c_box(const float *v) {
  const float *factor = v + 1, *offset = v + 4, *low = v + 7, *high = v + 10;
  float enter = 0, leave = v[0];
  for (int i = 0; i < 3; i++) {
    float a = low[i] * factor[i] - offset[i], b = high[i] * factor[i] - offset[i];
    enter = fmaxf(enter, fminf(a, b));
    leave = fminf(leave, fmaxf(a, b));
  }
  return enter <= leave ? enter : INFINITY;
}

struct vector {
  float x, y, z;
};
static struct vector load(const float *v) {
  return (struct vector){v[0], v[1], v[2]};
}
static struct vector minus(struct vector a, struct vector b) {
  return (struct vector){a.x - b.x, a.y - b.y, a.z - b.z};
}
static struct vector cross(struct vector a, struct vector b) {
  return (struct vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static float dot(struct vector a, struct vector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Moeller and Trumbore's test, for both sides, as raytracer/examples/1-plain.c has it. */
static float c_triangle(const float *v) {
  struct vector direction = load(v + 4), corner = load(v + 7);
  struct vector edge1 = minus(load(v + 10), corner), edge2 = minus(load(v + 13), corner);
  struct vector p = cross(direction, edge2), t = minus(load(v + 1), corner), q = cross(t, edge1);
  float determinant = dot(edge1, p), side1 = dot(t, p), side2 = dot(direction, q);
  if (determinant > 0) {
    if (side1 < 0 || side1 > determinant || side2 < 0 || side1 + side2 > determinant)
      return v[0];
  } else if (determinant < 0) {
    if (side1 > 0 || side1 < determinant || side2 > 0 || side1 + side2 < determinant)
      return v[0];
  } else {
    return v[0];
  }
  float distance = dot(edge2, q) / determinant;
  return distance > 0 && distance < v[0] ? distance : v[0];
}

#define BOX(F) F(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8], v[9], v[10], v[11], v[12])
#define TRIANGLE(F)                                                                                                    \
  F(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8], v[9], v[10], v[11], v[12], v[13], v[14], v[15])

int main(void) {
  unsigned boxes = 0, triangles = 0, differ = 0;
  for (int i = 0; i < 3000; i++) {
    float v[16];
    for (int k = 1; k < 16; k++)
      v[k] = number();
    v[0] = any(2) ? INFINITY : 4;
    const unsigned box = bits(c_box(v)), triangle = bits(c_triangle(v));
    boxes += box != bits(INFINITY);
    triangles += triangle != bits(v[0]);
    differ += bits(BOX(__builtin_trax_box)) != box;
    differ += bits(BOX(box_pointer)) != box;
    differ += bits(TRIANGLE(__builtin_trax_triangle)) != triangle;
    differ += bits(TRIANGLE(triangle_pointer)) != triangle;
  }
  printf("%u differ; %s\n", differ, boxes > 100 && triangles > 100 ? "many hit" : "few hit");
  return 0;
}
