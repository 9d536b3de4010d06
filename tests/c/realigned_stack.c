// RUN: %run_c %s %t
// RUN: %run_c %s %t --cflags "-fno-omit-frame-pointer"
// RUN: %run_c %s %t --cflags "-mstack=global"
// RUN: %run_c %s %t --cflags "-mstack=global -mstack-size=256k -DLARGE -fno-omit-frame-pointer"
// Over-aligned locals in functions that call others, with arrays of variable length and arguments on the stack: at
// their addresses, apart from each other, and unchanged by calls, whatever sp is at the call.
#include <stdint.h>
#include <stdio.h>

static int wrong;

/* Out of the compiler's sight: it would take the address for aligned. */
__attribute__((noinline)) static void check(void *object, unsigned alignment, unsigned size, unsigned char value) {
  uintptr_t address = (uintptr_t)object;
  __asm__("" : "+r"(address));
  if (address % alignment != 0) {
    wrong++;
    printf("address %% %u is %u\n", alignment, (unsigned)address % alignment);
  }
  for (unsigned i = 0; i < size; i++)
    ((unsigned char *)address)[i] = (unsigned char)(value + i);
}

__attribute__((noinline)) static void compare(const void *object, unsigned size, unsigned char value) {
  for (unsigned i = 0; i < size; i++)
    if (((const unsigned char *)object)[i] != (unsigned char)(value + i)) {
      wrong++;
      printf("byte %u of %u\n", i, size);
      return;
    }
}

#define ARGUMENTS int a, int b, int c, int d, int e, int f, int g, int h, int i, int j
#define SUM (a + b + c + d + e + f + g + h + i + j)

/* The base pointer addresses fixed objects, sp the array, fp the arguments. */
#define FIXED_AND_VARIABLE(NAME, ALIGNMENT, SIZE)                                                                      \
  __attribute__((noinline)) static int NAME(int n, ARGUMENTS) {                                                        \
    _Alignas(ALIGNMENT) char fixed[SIZE];                                                                              \
    char variable[n];                                                                                                  \
    struct {                                                                                                           \
      short x, y;                                                                                                      \
    } plain;                                                                                                           \
    check(fixed, ALIGNMENT, SIZE, 1);                                                                                  \
    check(variable, 4, (unsigned)n, 77);                                                                               \
    check(&plain, 4, sizeof plain, 5);                                                                                 \
    compare(fixed, SIZE, 1);                                                                                           \
    compare(variable, (unsigned)n, 77);                                                                                \
    compare(&plain, sizeof plain, 5);                                                                                  \
    return n + SUM;                                                                                                    \
  }
/* Without an array of variable length, sp addresses fixed objects. */
#define FIXED(NAME, ALIGNMENT, SIZE)                                                                                   \
  __attribute__((noinline)) static int NAME(int n, ARGUMENTS) {                                                        \
    _Alignas(ALIGNMENT) char fixed[SIZE];                                                                              \
    check(fixed, ALIGNMENT, SIZE, (unsigned char)n);                                                                   \
    compare(fixed, SIZE, (unsigned char)n);                                                                            \
    return n + SUM;                                                                                                    \
  }
FIXED_AND_VARIABLE(both8, 8, 12)
FIXED_AND_VARIABLE(both64, 64, 64)
FIXED(fixed16, 16, 20)
FIXED(fixed32, 32, 4)
#ifdef LARGE
FIXED_AND_VARIABLE(both128, 64, 128)
FIXED_AND_VARIABLE(both4096, 4096, 300)
FIXED_AND_VARIABLE(both32768, 32768, 4)
FIXED(fixed65536, 65536, 4) /* beyond the immediate of andi */
#endif

/* Calls with sp at every multiple of 4. */
__attribute__((noinline)) static int calls(int moved) {
  int sum = 0;
  {
    char gap[moved];
    check(gap, 4, (unsigned)moved, 9);
    sum += both8(moved, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10);
    sum += both64(moved, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10);
    sum += fixed16(moved, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10);
    sum += fixed32(moved, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10);
#ifdef LARGE
    wrong += both128(moved, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10) != moved + 55;
    wrong += both4096(moved, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10) != moved + 55;
    wrong += both32768(moved, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10) != moved + 55;
    wrong += fixed65536(moved, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10) != moved + 55;
#endif
    compare(gap, (unsigned)moved, 9);
  }
  return sum;
}

int main(void) {
  int sum = 0;
  for (int moved = 1; moved <= 34; moved++)
    sum += calls(moved);
  printf("%d %d\n", wrong, sum);
  return 0;
}
