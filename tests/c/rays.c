// RUN: %run_c %s %t
// What ray tracers compute: slabs with infinite reciprocals, triangles, spheres, reflections, packed colours; to the
// bit.
#include <math.h>
#include <stdio.h>
#include <string.h>

struct vec {
  float x, y, z;
};

static struct vec add(struct vec a, struct vec b) {
  return (struct vec){a.x + b.x, a.y + b.y, a.z + b.z};
}
static struct vec subtract(struct vec a, struct vec b) {
  return (struct vec){a.x - b.x, a.y - b.y, a.z - b.z};
}
static struct vec scale(struct vec a, float s) {
  return (struct vec){a.x * s, a.y * s, a.z * s};
}
static float dot(struct vec a, struct vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
static struct vec cross(struct vec a, struct vec b) {
  return (struct vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static unsigned bits(float x) {
  unsigned u;
  memcpy(&u, &x, 4);
  return x != x ? 0x7FC00000 : u;
}

static const struct vec low = {-1, -1, -1}, high = {1, 1.5f, 2};

__attribute__((noinline)) static float box(struct vec origin, struct vec reciprocal) {
  float near = 0, far = INFINITY;
  for (int axis = 0; axis < 3; axis++) {
    float o = (&origin.x)[axis], r = (&reciprocal.x)[axis];
    float a = ((&low.x)[axis] - o) * r, b = ((&high.x)[axis] - o) * r;
    near = fmaxf(near, fminf(a, b));
    far = fminf(far, fmaxf(a, b));
  }
  return near <= far ? near : -1;
}

__attribute__((noinline)) static float triangle(struct vec origin, struct vec direction, const struct vec *corner) {
  struct vec e = subtract(corner[1], corner[0]), f = subtract(corner[2], corner[0]);
  struct vec p = cross(direction, f);
  float determinant = dot(e, p);
  if (determinant == 0)
    return -1;
  float inverse = 1 / determinant;
  struct vec s = subtract(origin, corner[0]);
  float u = dot(s, p) * inverse;
  struct vec q = cross(s, e);
  float v = dot(direction, q) * inverse;
  return u < 0 || v < 0 || u + v > 1 ? -1 : dot(f, q) * inverse;
}

__attribute__((noinline)) static float sphere(struct vec origin, struct vec direction, float radius) {
  float b = dot(origin, direction), d = b * b - dot(origin, origin) + radius * radius;
  return d < 0 ? -1 : -b - sqrtf(d);
}

__attribute__((noinline)) static unsigned colour(struct vec c) {
  unsigned packed = 0;
  for (int i = 0; i < 3; i++) {
    float v = (&c.x)[i] * 255 + 0.5f;
    packed = packed << 8 | (unsigned)(v < 0 ? 0 : v > 255 ? 255 : v);
  }
  return packed;
}

static const struct vec corners[3] = {{-1, -1, 0.5f}, {2, -1, 0}, {0, 2, -0.25f}};

__attribute__((noinline)) static void trace(struct vec origin, struct vec direction) {
  struct vec reciprocal = {1 / direction.x, 1 / direction.y, 1 / direction.z};
  direction = scale(direction, 1 / sqrtf(dot(direction, direction)));
  float b = box(origin, reciprocal), t = triangle(origin, direction, corners), s = sphere(origin, direction, 1.25f);
  struct vec hit = add(origin, scale(direction, s)), normal = scale(hit, 0.8f);
  struct vec mirrored = subtract(direction, scale(normal, 2 * dot(direction, normal)));
  printf("%08x %08x %08x %08x %06x\n", bits(b), bits(t), bits(s), bits(mirrored.y), colour(mirrored));
}

int main(void) {
  volatile float zero = 0;
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 4; j++)
      trace((struct vec){(float)i * 0.4f - 1, (float)j * 0.5f - 1, -4}, (struct vec){0.1f, (float)(j - i) * 0.05f, 1});
  trace((struct vec){1, 0, -4}, (struct vec){zero, -zero, 1}); /* along an edge of the box: 0 times infinity */
  trace((struct vec){0, 0, 9}, (struct vec){zero, zero, -1});
  trace((struct vec){0, 0, 0}, (struct vec){1, 1, 1});
  return 0;
}
