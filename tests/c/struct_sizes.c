// RUN: %run_c %s %t
// Structures of every size from 1 to 40 bytes, by value and as results: in registers, split between registers and
// stack, copied.
#include <stdio.h>
#include <string.h>

#define SIZES(X)                                                                                                       \
  X(1)                                                                                                                 \
  X(2)                                                                                                                 \
  X(3)                                                                                                                 \
  X(4)                                                                                                                 \
  X(5)                                                                                                                 \
  X(6)                                                                                                                 \
  X(7)                                                                                                                 \
  X(8)                                                                                                                 \
  X(9)                                                                                                                 \
  X(10)                                                                                                                \
  X(11)                                                                                                                \
  X(12)                                                                                                                \
  X(13) X(14) X(15) X(16) X(17) X(18) X(19) X(20) X(21) X(22) X(23) X(24) X(28) X(31) X(32) X(33) X(36) X(39) X(40)

__attribute__((noinline)) static unsigned hash(const void *memory, int size) {
  const unsigned char *p = memory;
  unsigned h = 2166136261u;
  while (size--)
    h = (h ^ *p++) * 16777619;
  return h;
}

__attribute__((noinline)) static void fill(void *memory, int size, int seed) {
  unsigned char *p = memory;
  for (int i = 0; i < size; i++)
    p[i] = (unsigned char)(seed + i * 37);
}

/* Between an int and a long long, so that the words of larger ones straddle the
 * last register. */
#define FUNCTIONS(N)                                                                                                   \
  struct bytes##N {                                                                                                    \
    unsigned char b[N];                                                                                                \
  };                                                                                                                   \
  __attribute__((noinline)) static struct bytes##N change##N(int by, struct bytes##N s, long long last) {              \
    s.b[N - 1] = (unsigned char)(s.b[N - 1] + by);                                                                     \
    s.b[0] ^= (unsigned char)last;                                                                                     \
    return s;                                                                                                          \
  } __attribute__((noinline)) static unsigned late##N(double d, long long l, int a, int b, struct bytes##N s, int z) { \
    return hash(&s, N) + (unsigned)((int)d + (int)l + a * b * z);                                                      \
  }                                                                                                                    \
  __attribute__((noinline)) static void test##N(void) {                                                                \
    struct bytes##N s;                                                                                                 \
    fill(&s, N, N);                                                                                                    \
    struct bytes##N t = change##N(5, s, 0x1234567890ll);                                                               \
    printf("%d %x %x %x\n", N, hash(&s, N), hash(&t, N), late##N(3.5, 1ll << 32, 2, 3, t, N));                         \
  }
SIZES(FUNCTIONS)

int main(void) {
#define CALL(N) test##N();
  SIZES(CALL)
  return 0;
}
