// RUN: %run_c %s %t
// Structures of more than four words: copies on the stack, results through a pointer.
#include <stdio.h>
#include <string.h>

struct large {
  int v[6];
  char name[5];
};

__attribute__((noinline)) static struct large make(int first, const char *name) {
  struct large l;
  for (int i = 0; i < 6; i++)
    l.v[i] = first + i * i;
  strncpy(l.name, name, sizeof l.name);
  return l;
}

__attribute__((noinline)) static int consume(int weight, struct large l, int last) {
  int sum = last;
  for (int i = 0; i < 6; i++)
    sum += weight * l.v[i];
  l.v[0] = -1; /* the caller's own must not change */
  return sum + l.name[0];
}

__attribute__((noinline)) static struct large twice(struct large l) {
  for (int i = 0; i < 6; i++)
    l.v[i] *= 2;
  return l;
}

int main(void) {
  struct large l = make(10, "abcd");
  printf("%d\n", consume(3, l, 100));
  l = twice(l);
  printf("%d %d %s\n", l.v[0], l.v[5], l.name);
  printf("%d\n", consume(1, twice(l), 0));
  return 0;
}
