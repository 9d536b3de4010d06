// RUN: %run_c %s %t
// char, short and bool: conversions, wrapping, arguments and results.
#include <stdbool.h>
#include <stdio.h>

static volatile int values[] = {0, 1, -1, 127, 128, 255, 256, 32767, 32768, 65535, 65536, 0x12345678};
static signed char bytes[4];
static unsigned short halves[4];

__attribute__((noinline)) static signed char to_schar(int x) {
  return (signed char)x;
}
__attribute__((noinline)) static unsigned char to_uchar(int x) {
  return (unsigned char)x;
}
__attribute__((noinline)) static short to_short(int x) {
  return (short)x;
}
__attribute__((noinline)) static unsigned short to_ushort(int x) {
  return (unsigned short)x;
}
__attribute__((noinline)) static bool to_bool(int x) {
  return x;
}
__attribute__((noinline)) static int sum(signed char a, unsigned char b, short c, unsigned short d) {
  return a + b * 3 + c * 5 + d * 7;
}

int main(void) {
  for (int i = 0; i < 12; i++) {
    int x = values[i];
    printf("%d %d %d %d %d ", to_schar(x), to_uchar(x), to_short(x), to_ushort(x), to_bool(x));
    printf("%d ", sum((signed char)x, (unsigned char)x, (short)x, (unsigned short)x));
    bytes[i & 3] += (signed char)x;
    halves[i & 3] = (unsigned short)(halves[i & 3] * 3 + x);
    printf("%d %u\n", bytes[i & 3], halves[i & 3]);
  }
  unsigned char c = 250;
  for (int i = 0; i < 10; i++)
    c++;
  printf("%d\n", c);
  return 0;
}
