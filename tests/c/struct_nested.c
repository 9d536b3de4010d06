// RUN: %run_c %s %t
// Structures in structures and arrays: copies, by value, with bit-fields, unions, floats and function pointers inside.
#include <stdio.h>

struct vec {
  float x, y, z;
};
struct ray {
  struct vec origin, direction;
};
struct packed {
  unsigned kind : 4;
  int weight : 12;
  unsigned : 0;
  unsigned char tag;
};
struct shape {
  struct packed head;
  union {
    struct vec centre;
    int corner[3];
  } place;
  float (*area)(struct shape);
  struct {
    short lo, hi;
  } range[2];
};
struct single {
  struct {
    struct {
      float value[1];
    } inner;
  } outer;
};

__attribute__((noinline)) static struct vec at(struct ray r, float t) {
  return (struct vec){r.origin.x + t * r.direction.x, r.origin.y + t * r.direction.y, r.origin.z + t * r.direction.z};
}
__attribute__((noinline)) static struct ray flip(struct ray r) {
  struct vec t = r.origin;
  r.origin = r.direction;
  r.direction = t;
  return r;
}
__attribute__((noinline)) static struct packed bump(struct packed p) {
  p.kind += 9;
  p.weight -= 1000;
  p.tag ^= 0xFF;
  return p;
}
__attribute__((noinline)) static float sphere(struct shape s) {
  return s.place.centre.x * (float)s.head.weight;
}
__attribute__((noinline)) static float cube(struct shape s) {
  return (float)(s.place.corner[0] * s.range[1].hi - s.range[0].lo);
}
__attribute__((noinline)) static struct single half(struct single s) {
  s.outer.inner.value[0] *= 0.5f;
  return s;
}

static struct shape shapes[3] = {
    {{3, -7, 'a'}, {.centre = {1.5f, 2, 3}}, sphere, {{1, 2}, {3, 4}}},
    {{15, 2047, 'b'}, {.corner = {10, 20, 30}}, cube, {{-5, 6}, {7, -8}}},
};

/* In hundredths: %g needs more stack than the copies at -O0 leave. */
__attribute__((noinline)) static void show(struct vec v) {
  printf("%d %d %d\n", (int)(v.x * 100), (int)(v.y * 100), (int)(v.z * 100));
}

__attribute__((noinline)) static void rays(void) {
  struct ray r = {{1, 2, 3}, {-0.5f, 0.25f, 4}};
  struct vec p = at(r, 2), q = at(flip(r), -1);
  show(p);
  show(q);
}
__attribute__((noinline)) static void fields(void) {
  struct packed p = bump(shapes[1].head), q = bump(bump(shapes[0].head));
  printf("%u %d %d %u %d %d\n", p.kind, p.weight, p.tag, q.kind, q.weight, q.tag);
}
__attribute__((noinline)) static void arrays(void) {
  shapes[2] = shapes[0];
  shapes[0] = shapes[1];
  shapes[1].range[0] = shapes[2].range[1];
  shapes[2].range[1].lo++;
  for (int i = 0; i < 3; i++) {
    int area = (int)(shapes[i].area(shapes[i]) * 2);
    printf("%d %d %d\n", area, shapes[i].range[0].hi, shapes[i].range[1].lo);
  }
}

int main(void) {
  rays();
  fields();
  arrays();
  printf("%g\n", (double)half((struct single){{{{7}}}}).outer.inner.value[0]);
  return 0;
}
