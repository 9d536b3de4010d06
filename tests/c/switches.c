// RUN: %run_c %s %t
// switch: dense (a jump table), sparse, with ranges, falling through, on 64 bits.
#include <stdio.h>

__attribute__((noinline)) static int dense(int x) {
  switch (x) {
  case 0:
    return 3;
  case 1:
    return 1;
  case 2:
    return 4;
  case 3:
    return 1;
  case 4:
    return 5;
  case 5:
    return 9;
  case 6:
    return 2;
  case 7:
    return 6;
  default:
    return -1;
  }
}

__attribute__((noinline)) static int calls(int x, int *p) {
  switch (x) {
  case -3:
    *p += 1;
    break;
  case -2:
    *p *= 2;
    break;
  case -1:
    *p -= 7;
    /* fall through */
  case 0:
    *p ^= 3;
    break;
  case 1:
    return *p;
  case 2:
    *p = x;
    return 2;
  case 3 ... 9:
    *p += x;
    break;
  }
  return *p * 2;
}

__attribute__((noinline)) static const char *sparse(int x) {
  switch (x) {
  case 1:
    return "one";
  case 100:
    return "hundred";
  case 10000:
    return "ten thousand";
  case -2147483647 - 1:
    return "least";
  case 2147483647:
    return "greatest";
  }
  return "other";
}

__attribute__((noinline)) static int wide(unsigned long long x) {
  switch (x) {
  case 1:
    return 1;
  case 0x100000000ull:
    return 2;
  case 0x100000001ull:
    return 3;
  }
  return 0;
}

int main(void) {
  static const int keys[] = {1, 100, 101, 10000, 0, -2147483647 - 1, 2147483647};
  for (int i = -2; i < 10; i++)
    printf("%d ", dense(i));
  puts("");
  int state = 5;
  for (int i = -5; i < 12; i++)
    printf("%d ", calls(i, &state));
  puts("");
  for (int i = 0; i < 7; i++)
    printf("%s ", sparse(keys[i]));
  printf("\n%d%d%d%d\n", wide(1), wide(1ull << 32), wide((1ull << 32) + 1), wide(2ull << 32));
  return 0;
}
