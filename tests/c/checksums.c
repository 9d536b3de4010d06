// RUN: %run_c %s %t
// CRC-32, Adler-32 and FNV-1a of the same bytes: tables, shifts, 64-bit products.
#include <stdint.h>
#include <stdio.h>

static uint32_t table[256];
static uint8_t data[1000];

__attribute__((noinline)) static uint32_t crc32(const uint8_t *p, int n) {
  uint32_t crc = ~0u;
  while (n--)
    crc = table[(crc ^ *p++) & 0xFF] ^ crc >> 8;
  return ~crc;
}
__attribute__((noinline)) static uint32_t adler32(const uint8_t *p, int n) {
  uint32_t a = 1, b = 0;
  while (n--) {
    a = (a + *p++) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}
__attribute__((noinline)) static uint64_t fnv(const uint8_t *p, int n) {
  uint64_t h = 14695981039346656037u;
  while (n--)
    h = (h ^ *p++) * 1099511628211u;
  return h;
}

int main(void) {
  for (uint32_t i = 0; i < 256; i++) {
    uint32_t c = i;
    for (int k = 0; k < 8; k++)
      c = c & 1 ? 0xEDB88320u ^ c >> 1 : c >> 1;
    table[i] = c;
  }
  for (int i = 0; i < 1000; i++)
    data[i] = (uint8_t)(i * i + 3);
  printf("%08x %08x %016llx\n", crc32(data, 1000), adler32(data, 1000), (unsigned long long)fnv(data, 1000));
  printf("%08x\n", crc32((const uint8_t *)"123456789", 9));
  return 0;
}
