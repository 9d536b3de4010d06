// RUN: %run_c %s %t
// Calls through pointers: tables, arguments, results, and callbacks.
#include <stdio.h>

typedef int operation(int, int);

static int add(int a, int b) {
  return a + b;
}
static int subtract(int a, int b) {
  return a - b;
}
static int multiply(int a, int b) {
  return a * b;
}

static operation *const table[] = {add, subtract, multiply};

__attribute__((noinline)) static int fold(operation *f, const int *v, int n, int start) {
  for (int i = 0; i < n; i++)
    start = f(start, v[i]);
  return start;
}

__attribute__((noinline)) static operation *choose(int which) {
  return table[which % 3];
}

struct object {
  int state;
  void (*method)(struct object *, int);
};

static void increase(struct object *o, int by) {
  o->state += by;
}
static void square(struct object *o, int unused) {
  (void)unused;
  o->state *= o->state;
  o->method = increase;
}

int main(void) {
  static const int v[] = {1, 2, 3, 4};
  for (int i = 0; i < 3; i++)
    printf("%d\n", fold(choose(i), v, 4, 1));
  struct object o = {5, square};
  o.method(&o, 3);
  o.method(&o, 3);
  printf("%d %d\n", o.state, o.method == increase);
  return 0;
}
