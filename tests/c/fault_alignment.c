// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DLOAD_HALF --fault misaligned --fault "load of 2" \
// RUN:   --fault fault_alignment.c:22
// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DSTORE_HALF --fault misaligned --fault "store of 2" \
// RUN:   --fault fault_alignment.c:25
// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DLOAD_WORD --fault misaligned --fault "load of 4" \
// RUN:   --fault fault_alignment.c:28
// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DSTORE_WORD --fault misaligned --fault "store of 4" \
// RUN:   --fault fault_alignment.c:31
// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DLOCAL --fault misaligned --fault "load of 4" \
// RUN:   --fault fault_alignment.c:35
// Halves at odd addresses and words at addresses that are no multiple of 4, in global and local memory.
#include <stdint.h>

static _Alignas(8) char bytes[16];
static volatile uintptr_t one = 1, two = 2;

#define AT(type, base, offset) (*(volatile type *)((uintptr_t)(base) + (offset)))

int main(void) {
  AT(short, bytes, two) = 5; /* as it should be */
#if defined(LOAD_HALF)
  return AT(short, bytes, one);
#elif defined(STORE_HALF)
  one += 2;
  AT(short, bytes, one) = 7;
#elif defined(LOAD_WORD)
  one = 0;
  return AT(int, bytes, two);
#elif defined(STORE_WORD)
  one = 0;
  AT(int, bytes + 4, two) = 1;
#elif defined(LOCAL)
  volatile int local[2] = {1, 2};
  one += 2;
  return AT(int, local, one);
#endif
  return 0;
}
