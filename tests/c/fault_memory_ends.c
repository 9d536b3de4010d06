// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DBELOW --fault "load of 4" --fault 0x00000ffc \
// RUN:   --fault fault_memory_ends.c:21
// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DBEHIND --fault "store of 4" --fault fault_memory_ends.c:24
// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DUNDER --fault "stack overflow" --fault 0xfffffdff \
// RUN:   --fault fault_memory_ends.c:27
// The first and the last bytes of memory are accessible; those before, behind and under the stack are not.
#include <stdint.h>
#include <trax.h>

extern uintptr_t __trax_heap_end;

#define AT(type, address) (*(volatile type *)(address))

int main(void) {
  volatile uintptr_t first = 0x1000, end = __trax_heap_end, local = 0xFFFFFE00u;
  int sum = AT(int, first);
  AT(int, end - 4) = 1;
  AT(char, local) = 2;
#if defined(BELOW)
  first -= 4;
  sum += AT(int, first);
#elif defined(BEHIND)
  sum += AT(int, end - 4);
  AT(int, end) = 3;
#elif defined(UNDER)
  local--;
  sum += AT(char, local);
#endif
  return sum;
}
