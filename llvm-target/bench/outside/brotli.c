#include "outside.h"
#include <brotli/decode.h>
#include <brotli/encode.h>

enum { SIZE = 30000 };
static char text[SIZE], again[SIZE];
static uint8_t packed[SIZE + 1000];

void kernel_setup(void) {
  outside_begin();
  outside_text(text, SIZE);
}

struct result kernel_run(void) {
  size_t packed_size = sizeof packed, again_size = SIZE;
  BrotliEncoderCompress(4, 16, BROTLI_MODE_GENERIC, SIZE, (const uint8_t *)text, &packed_size, packed);
  BrotliDecoderDecompress(packed_size, packed, &again_size, (uint8_t *)again);
  return outside_round_trip(text, again, SIZE, packed, (uint32_t)packed_size);
}
