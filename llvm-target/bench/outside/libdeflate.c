#include "outside.h"
#include <libdeflate.h>

enum { SIZE = 40000 };
static char text[SIZE], packed[SIZE + 1000], again[SIZE];

void kernel_setup(void) {
  outside_begin();
  outside_text(text, SIZE);
}

struct result kernel_run(void) {
  struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(6);
  struct libdeflate_decompressor *decompressor = libdeflate_alloc_decompressor();
  size_t size = libdeflate_deflate_compress(compressor, text, SIZE, packed, sizeof packed);
  libdeflate_deflate_decompress(decompressor, packed, size, again, SIZE, NULL);
  libdeflate_free_compressor(compressor);
  libdeflate_free_decompressor(decompressor);
  return outside_round_trip(text, again, SIZE, packed, (uint32_t)size);
}
