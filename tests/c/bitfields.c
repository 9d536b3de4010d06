// RUN: %run_c %s %t
// Bit-fields: signed and unsigned, packed across words, written one without touching the others.
#include <stdio.h>

struct fields {
  unsigned a : 3;
  int b : 5;
  unsigned c : 17;
  int : 0;
  unsigned d : 31;
  int e : 1;
  unsigned long long f : 40;
};

static struct fields global = {5, -7, 0x1ABCD, 0x12345678, -1, 0xABCDEF0123ull};

__attribute__((noinline)) static void show(const struct fields *s) {
  printf("%u %d %x %x %d %llx\n", s->a, s->b, s->c, s->d, s->e, (unsigned long long)s->f);
}

int main(void) {
  volatile int n = 9;
  show(&global);
  global.a = (unsigned)n;
  show(&global);
  global.b = n;
  global.b -= 20;
  show(&global);
  global.c++;
  global.d ^= 0x7FFFFFFF;
  global.e = 0;
  global.f += 0xFFFFFFFFFFull;
  show(&global);
  for (int i = 0; i < 10; i++)
    global.a++;
  show(&global);
  return 0;
}
