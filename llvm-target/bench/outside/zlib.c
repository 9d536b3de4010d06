#include "outside.h"
#include <zlib.h>

enum { SIZE = 60000 };
static char text[SIZE], again[SIZE];
static unsigned char packed[SIZE + 1000];

void kernel_setup(void) {
  outside_begin();
  outside_text(text, SIZE);
}

struct result kernel_run(void) {
  uLongf packed_size = sizeof packed, again_size = SIZE;
  compress2(packed, &packed_size, (const Bytef *)text, SIZE, 6);
  uncompress((Bytef *)again, &again_size, packed, packed_size);
  return outside_round_trip(text, again, SIZE, packed, (uint32_t)packed_size);
}
