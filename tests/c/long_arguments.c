// RUN: %run_c %s %t --cflags "-mstack=global -mstack-size=4194304"
// Aggregates by value of every length around those at which copying turns into a loop, of words and of bytes.
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define SUM(name, type, count)                                                                                         \
  struct name {                                                                                                        \
    type value[count];                                                                                                 \
  };                                                                                                                   \
  __attribute__((noinline)) static unsigned sum_##name(int before, struct name s, int behind) {                        \
    unsigned sum = (unsigned)(before * 1000 + behind);                                                                 \
    for (int i = 0; i < count; i++)                                                                                    \
      sum = sum * 31 + (unsigned)s.value[i];                                                                           \
    memset(&s, 0, sizeof s); /* the caller's stays as it is */                                                         \
    return sum;                                                                                                        \
  }                                                                                                                    \
  __attribute__((noinline)) static unsigned sum_unnamed_##name(int n, ...) {                                           \
    va_list list;                                                                                                      \
    va_start(list, n);                                                                                                 \
    unsigned sum = 0;                                                                                                  \
    for (int i = 0; i < n; i++)                                                                                        \
      sum += sum_##name(i, va_arg(list, struct name), va_arg(list, int));                                              \
    va_end(list);                                                                                                      \
    return sum;                                                                                                        \
  }                                                                                                                    \
  __attribute__((noinline)) static void test_##name(int size) {                                                        \
    static struct name s;                                                                                              \
    char moving[size]; /* sp moves */                                                                                  \
    memset(moving, 1, (size_t)size);                                                                                   \
    for (int i = 0; i < count; i++)                                                                                    \
      s.value[i] = (type)(i * 7 + moving[i % size]);                                                                   \
    unsigned first = sum_##name(1, s, 2);                                                                              \
    printf("%s %u %u %u\n", #name, first, sum_##name(1, s, 2) - first, sum_unnamed_##name(2, s, 5, s, 6));             \
  }

SUM(words15, int, 15)
SUM(words16, int, 16)
SUM(words17, int, 17)
SUM(words20, int, 20)
SUM(words40000, int, 40000)
SUM(bytes63, unsigned char, 63)
SUM(bytes64, unsigned char, 64)
SUM(bytes65, unsigned char, 65)
SUM(bytes71, unsigned char, 71)
SUM(halves33, short, 33)
SUM(halves40, short, 40)

int main(void) {
  test_words15(3);
  test_words16(4);
  test_words17(5);
  test_words20(6);
  test_words40000(7);
  test_bytes63(8);
  test_bytes64(9);
  test_bytes65(10);
  test_bytes71(11);
  test_halves33(12);
  test_halves40(13);
  return 0;
}
