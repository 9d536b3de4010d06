// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DSTRING --fault read-only --fault fault_read_only_places.c:16
// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DTABLE --fault read-only \
// RUN:   --fault fault_read_only_places.c:19 --fault table
// RUN: %run_c %s %t --turns -O0,-O2 --cflags -DTEXT --fault read-only --fault fault_read_only_places.c:22 --fault main
// Stores to a string literal, to a table of pointers that is constant, and to instructions.
#include <stdint.h>

static char *volatile text __attribute__((unused)) = "literal";
static const char *const table[2] = {"a", "b"};

int main(void) {
  const char *const *volatile entry = table;
  volatile uintptr_t code = (uintptr_t)main;
#if defined(STRING)
  text += 3;
  ((volatile char *)text)[1] = 'a';
#elif defined(TABLE)
  const char **p = (const char **)(uintptr_t)entry;
  *(const char *volatile *)(p + 1) = 0;
#elif defined(TEXT)
  code -= 0;
  *(volatile int *)(code + 4) = 0;
#endif
  return code == 0 && **entry;
}
