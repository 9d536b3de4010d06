#include "outside.h"
#include <bzlib.h>

enum { SIZE = 20000 };
static char text[SIZE], packed[SIZE + SIZE / 50 + 600], again[SIZE];

/* The library's own, in place of the program's. */
void bz_internal_error(int code);
void bz_internal_error(int code) {
  (void)code;
  abort();
}

void kernel_setup(void) {
  outside_begin();
  outside_text(text, SIZE);
}

struct result kernel_run(void) {
  unsigned packed_size = sizeof packed, again_size = SIZE;
  BZ2_bzBuffToBuffCompress(packed, &packed_size, text, SIZE, 1, 0, 0);
  BZ2_bzBuffToBuffDecompress(again, &again_size, packed, packed_size, 0, 0);
  return outside_round_trip(text, again, SIZE, packed, packed_size);
}
