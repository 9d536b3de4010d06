// RUN: %run_c %s %t
// Objects that the image holds: numbers, strings, pointers with offsets, function addresses, zeros.
#include <stdio.h>

static int numbers[5] = {1, [3] = -4, 5};
static const char text[] = "array", *const pointer = "pointer";
static int *middle = &numbers[3];
static struct {
  char c;
  const char *name;
  double d;
  long long l;
  int (*f)(const char *, ...);
  struct {
    short s[3];
  } inner;
} object = {'c', "name", 0.5, -(1ll << 40), printf, {{1, 2, 3}}};
static int zeros[100];
static const unsigned char table[4][3] = {{1, 2, 3}, {4, 5, 6}, {7}};
static char *tail = (char *)numbers + sizeof numbers;
static const float floats[] = {1.5f, -0.0f, 1e30f, 1.0f / 3};

__attribute__((noinline)) static int counter(void) {
  static int calls = 100;
  return calls++;
}

int main(void) {
  printf("%d %d %d %d %d\n", numbers[0], numbers[3], numbers[4], *middle, middle[1]);
  printf("%s %s %d\n", text, pointer, (int)sizeof text);
  object.f("%c %s %g %lld %d\n", object.c, object.name, object.d, object.l, object.inner.s[2]);
  int sum = 0;
  for (int i = 0; i < 100; i++)
    sum |= zeros[i];
  printf("%d %d %d %d\n", sum, table[1][2], table[2][1], (int)(tail - (char *)&numbers[1]));
  printf("%g %g %g %g\n", (double)floats[0], 1 / (double)floats[1], (double)floats[2], (double)floats[3]);
  counter();
  printf("%d %d\n", counter(), ((struct { int x, y; }){3, 4}).y);
  return 0;
}
