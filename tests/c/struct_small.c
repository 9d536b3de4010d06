// RUN: %run_c %s %t
// Structures of up to four words, by value, as arguments and results.
#include <stdio.h>

struct vec3 {
  float x, y, z;
};
struct pair {
  int a;
  char b;
};
struct quad {
  int v[4];
};
struct mixed {
  char c;
  short s;
  long long l;
};

__attribute__((noinline)) static struct vec3 add(struct vec3 a, struct vec3 b) {
  return (struct vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}
__attribute__((noinline)) static struct vec3 cross(struct vec3 a, struct vec3 b) {
  return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
__attribute__((noinline)) static struct pair swap(struct pair p) {
  return (struct pair){p.b, (char)p.a};
}
__attribute__((noinline)) static struct quad rotate(struct quad q, int by) {
  struct quad r;
  for (int i = 0; i < 4; i++)
    r.v[i] = q.v[(i + by) & 3];
  return r;
}
__attribute__((noinline)) static struct mixed change(int before, struct mixed m, int after) {
  m.c += (char)before;
  m.s = (short)(m.s * after);
  m.l += before * after;
  return m;
}

int main(void) {
  volatile float one = 1;
  struct vec3 a = {one, 2, 3}, b = {-4, 5 * one, 0.5f};
  struct vec3 s = add(a, b), c = cross(a, s);
  printf("%g %g %g\n", (double)s.x, (double)s.y, (double)s.z);
  printf("%g %g %g\n", (double)c.x, (double)c.y, (double)c.z);
  struct pair p = swap((struct pair){65, 7});
  printf("%d %c\n", p.a, p.b);
  struct quad q = rotate((struct quad){{1, 2, 3, 4}}, 3);
  printf("%d %d %d %d\n", q.v[0], q.v[1], q.v[2], q.v[3]);
  struct mixed m = change(3, (struct mixed){1, 20, 1ll << 40}, -5);
  printf("%d %d %lld\n", m.c, m.s, m.l);
  return 0;
}
