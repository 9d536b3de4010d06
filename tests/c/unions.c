// RUN: %run_c %s %t
// Unions, by value and as views of the same bytes; nested and anonymous members.
#include <stdio.h>

union word {
  unsigned u;
  float f;
  unsigned char b[4];
  unsigned short h[2];
};

struct tagged {
  int kind;
  union {
    int i;
    float f;
    struct {
      short x, y;
    };
  };
};

__attribute__((noinline)) static union word negate(union word w) {
  w.u ^= 0x80000000;
  return w;
}

__attribute__((noinline)) static int value(struct tagged t) {
  switch (t.kind) {
  case 0:
    return t.i;
  case 1:
    return (int)(t.f * 10);
  default:
    return t.x * 1000 + t.y;
  }
}

int main(void) {
  volatile float start = 3.25f;
  union word w = {.f = start};
  printf("%08x %02x %04x %g\n", w.u, w.b[3], w.h[0], (double)negate(w).f);
  printf("%d %d %d\n", value((struct tagged){0, {7}}), value((struct tagged){.kind = 1, .f = 2.5f}),
         value((struct tagged){.kind = 2, .x = 3, .y = -4}));
  return 0;
}
