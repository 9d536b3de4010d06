// RUN: %run_c %s %t --cflags "-mstack=global"
// Expected output by hand.
// Accesses to fields of objects of every alignment, at offsets before, in and behind the object's alignment and around
// multiples of 32 KiB: where %hi of the object is not %hi of the field.
#include <stdint.h>
#include <stdio.h>

#define SIZE 131072
#define OBJECT(log) static _Alignas(1 << log) unsigned char object##log[SIZE];
OBJECT(0)
OBJECT(2)
OBJECT(6)
OBJECT(12)
OBJECT(13)
OBJECT(14)
OBJECT(15)
OBJECT(16)
_Alignas(65536) struct {
  int first;
  char gap[0x7FF8];
  int before, at;
  char more[0x8000 - 8];
  long long end_and_behind;
} record;
_Alignas(32768) unsigned words[0x8000];

__attribute__((noinline)) static unsigned char *opaque(unsigned char *p) {
  __asm__("" : "+r"(p));
  return p;
}

static int wrong;
/* Written through the object, twice so that the base is shared, read through a pointer the compiler knows nothing of.
 */
#define AT(log, offset)                                                                                                \
  do {                                                                                                                 \
    object##log[0] = 1;                                                                                                \
    object##log[offset] = (unsigned char)(log + (offset) % 251);                                                       \
    object##log[(offset) ^ 1] = 9;                                                                                     \
    if (opaque(object##log)[offset] != (unsigned char)(log + (offset) % 251) ||                                        \
        opaque(object##log)[(offset) ^ 1] != 9) {                                                                      \
      wrong++;                                                                                                         \
      printf("object%d[%d]\n", log, offset);                                                                           \
    }                                                                                                                  \
    opaque(object##log)[offset] = 77;                                                                                  \
    if (object##log[offset] != 77)                                                                                     \
      wrong++;                                                                                                         \
  } while (0)
#define ALL(log)                                                                                                       \
  __attribute__((noinline)) static void check##log(void) {                                                             \
    AT(log, 1);                                                                                                        \
    AT(log, 63);                                                                                                       \
    AT(log, 4096);                                                                                                     \
    AT(log, 0x3FFF);                                                                                                   \
    AT(log, 0x7FFE);                                                                                                   \
    AT(log, 0x7FFF);                                                                                                   \
    AT(log, 0x8000);                                                                                                   \
    AT(log, 0x8001);                                                                                                   \
    AT(log, 0x9000);                                                                                                   \
    AT(log, 0xFFFF);                                                                                                   \
    AT(log, 0x10000);                                                                                                  \
    AT(log, 0x17FFF);                                                                                                  \
    AT(log, 0x18000);                                                                                                  \
    AT(log, 0x1FFFF);                                                                                                  \
  }
ALL(0)
ALL(2)
ALL(6)
ALL(12)
ALL(13)
ALL(14)
ALL(15)
ALL(16)

/* Offsets below the object are those of the one before it. */
__attribute__((noinline)) static int below(unsigned i) {
  const unsigned char *p = object16 + 0x9000;
  return object16[i + 0x9000] + p[-0x1000] + p[-1] + p[-0x9000];
}

int main(void) {
  check0();
  check2();
  check6();
  check12();
  check13();
  check14();
  check15();
  check16();
  object16[0x9000] = 3;
  object16[0x8000] = 4;
  object16[0x8FFF] = 5;
  object16[0] = 6;
  record.first = 1;
  record.before = 2;
  record.at = 3;
  record.end_and_behind = 0x500000004;
  const int *raw = (const int *)opaque((unsigned char *)&record);
  words[0] = 10;
  words[0x1FFF] = 11;
  words[0x2000] = 12;
  words[0x7FFF] = 13;
  const unsigned *w = (const unsigned *)opaque((unsigned char *)words);
  printf("%d %d %d %d %d %d %d\n", wrong, below(0), raw[0], raw[0x7FFC / 4], raw[0x8000 / 4], raw[0xFFFC / 4],
         raw[0x10000 / 4]);
  printf("%u %u %u %u\n", w[0], w[0x1FFF], w[0x2000], w[0x7FFF]);
  return 0;
}
