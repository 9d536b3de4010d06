// RUN: %run_c %s %t
// C11: _Generic, _Static_assert, _Alignas and _Alignof, anonymous members; typeof and statement expressions.
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define NAME(x)                                                                                                        \
  _Generic((x),                                                                                                        \
      char: "char",                                                                                                    \
      signed char: "signed char",                                                                                      \
      unsigned char: "unsigned char",                                                                                  \
      short: "short",                                                                                                  \
      int: "int",                                                                                                      \
      unsigned: "unsigned",                                                                                            \
      long long: "long long",                                                                                          \
      unsigned long long: "unsigned long long",                                                                        \
      float: "float",                                                                                                  \
      double: "double",                                                                                                \
      char *: "char *",                                                                                                \
      const char *: "const char *",                                                                                    \
      int (*)(int): "function",                                                                                        \
      default: "other")

_Static_assert(sizeof(char) == 1 && sizeof(short) == 2 && sizeof(int) == 4 && sizeof(long long) == 8, "sizes");
_Static_assert(sizeof(float) == 4 && sizeof(double) == 8, "floats");
_Static_assert((char)-1 < 0, "char is signed");
_Static_assert(-7 / 2 == -3 && -7 % 2 == -1 && -8 >> 1 == -4, "truncation");

static _Alignas(64) char line[3];
static _Alignas(16) int quad = 5;
static char odd = 1;
static struct {
  char c;
  _Alignas(32) short s;
} padded[2] = {{1, 2}, {3, 4}};

static int identity(int x) {
  return x;
}

__attribute__((noinline)) static int aligned(const volatile void *p, unsigned to) {
  return (uintptr_t)p % to == 0;
}

#define MAXIMUM(a, b)                                                                                                  \
  ({                                                                                                                   \
    __typeof__(a) x_ = (a), y_ = (b);                                                                                  \
    x_ > y_ ? x_ : y_;                                                                                                 \
  })

__attribute__((noinline)) static void names(void) {
  char c = 'c';
  short s = 1;
  unsigned char u = 1;
  printf("%s, %s, %s, %s\n", NAME(c), NAME(s), NAME(u), NAME('c'));
  printf("%s, %s, %s, %s\n", NAME(c + c), NAME(s * 1u), NAME(s * 1ll), NAME(u ? 1.0f : s));
  printf("%s, %s, %s, %s\n", NAME(1.0f * 2), NAME(1.0f * 2.0), NAME(&c), NAME((const char *)"x"));
  printf("%s, %s, %s\n", NAME(identity), NAME(&quad), NAME(1ull << 3));
}

int main(void) {
  names();
  printf("%d%d%d%d\n", aligned(line, 64), aligned(&quad, 16), aligned(&padded[1].s, 32), aligned(padded, 32));
  printf("%d %d %d\n", (int)sizeof padded, (int)_Alignof(int),
         (int)(offsetof(
             struct {
               char c;
               short s;
             },
             s)));
  printf("%d %d %d %d\n", quad + odd, padded[1].s, MAXIMUM(3, -4), MAXIMUM(identity(2), 7));
  return 0;
}
