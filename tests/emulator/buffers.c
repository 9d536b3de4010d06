// One access to an address beside a buffer, for buffers_test.py: `WHAT BUFFER OFFSET`.
#include <stdio.h>
#include <stdlib.h>
#include <trax.h>
#include <unistd.h>

struct trax_buffer input, output;
double other; // of the size of a buffer
static volatile int sum;

__attribute__((noinline)) static int load(const volatile char *at) {
  return *at;
}

__attribute__((noinline)) static int load_word(const volatile int *at) {
  return *at;
}

__attribute__((noinline)) static void store(volatile char *at) {
  *at = 1;
}

__attribute__((noinline)) static void store_word(volatile int *at) {
  *at = 1;
}

int main(int argc, char **argv) {
  if (argc < 4)
    return (int)other + 1;
  char *const place = (char *)(argv[2][0] == 'i' ? input.data : output.data) + atol(argv[3]);
  switch (argv[1][0]) {
  case 's':
    store(place);
    return 3;
  case 'S':
    store_word((int *)place);
    return 3;
  case 'l':
    return load(place) + 3;
  case 'L':
    return load_word((int *)place) * 0 + 3;
  case 'a':
    trax_atomic_inc((unsigned *)place);
    return 3;
  case 'w': // the host's read of the program's memory
    return write(1, place, 8) == 8 ? 3 : 4;
  case 'r': // its write
    return read(0, place, 8) == 8 ? 3 : 4;
  case 'p': // a string without an end
    __builtin_trax_trap((unsigned)place, TRAX_TRAP_PUTS);
    return 3;
  default: // many loads, which the fast engine executes before their issue
    for (int i = 0; i < 64; i++)
      sum += load(place + 4 * i);
    return 3;
  }
}
