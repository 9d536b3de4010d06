/* CRC-32 by a table, which is computed at each call. */
#include "../bench.h"

enum { SIZE = 16384 };
static unsigned char bytes[SIZE];
static uint32_t table[256];

void kernel_setup(void) {
  uint32_t random = 3;
  for (int i = 0; i < SIZE; i++)
    bytes[i] = (unsigned char)(next_random(&random) >> 24);
}

static void make_table(void) {
  for (uint32_t i = 0; i < 256; i++) {
    uint32_t value = i;
    for (int bit = 0; bit < 8; bit++)
      value = value & 1 ? value >> 1 ^ 0xEDB88320u : value >> 1;
    table[i] = value;
  }
}

static uint32_t crc32(const unsigned char *data, unsigned size) {
  uint32_t crc = 0xFFFFFFFFu;
  for (unsigned i = 0; i < size; i++)
    crc = table[(crc ^ data[i]) & 255] ^ crc >> 8;
  return ~crc;
}

struct result kernel_run(void) {
  make_table();
  return (struct result){crc32(bytes, SIZE), 0};
}
