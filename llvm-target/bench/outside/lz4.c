#include "outside.h"
#include <lz4.h>
#include <lz4hc.h>

enum { SIZE = 60000 };
static char text[SIZE], packed[LZ4_COMPRESSBOUND(SIZE)], again[SIZE];

void kernel_setup(void) {
  outside_begin();
  outside_text(text, SIZE);
}

struct result kernel_run(void) {
  int fast = LZ4_compress_default(text, packed, SIZE, sizeof packed);
  uint32_t sum = outside_sum(packed, (uint32_t)fast);
  int best = LZ4_compress_HC(text, packed, SIZE, sizeof packed, 6);
  LZ4_decompress_safe(packed, again, best, SIZE);
  struct result result = outside_round_trip(text, again, SIZE, packed, (uint32_t)best);
  result.checksum = mix(result.checksum, sum);
  return result;
}
