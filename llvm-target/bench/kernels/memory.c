/* The library's memory and string functions, at all alignments, and structs that are copied. */
#include "../bench.h"

#include <string.h>

enum { SIZE = 2048 };
struct record {
  int values[10];
};
static char from[SIZE + 8], to[SIZE + 8];
static struct record records[64];

void kernel_setup(void) {
  for (int i = 0; i < SIZE; i++)
    from[i] = (char)('!' + i % 90);
  for (int i = 0; i < 64; i++)
    for (int k = 0; k < 10; k++)
      records[i].values[k] = i * k;
}

struct result kernel_run(void) {
  uint32_t checksum = 0;
  memset(to, 0, sizeof to);
  for (int shift = 0; shift < 4; shift++) {
    for (int size = 1; size < SIZE; size = 3 * size + shift) {
      memcpy(to + shift, from, (size_t)size);
      memmove(to + 2, to, (size_t)size);
      checksum = mix(checksum, (uint32_t)memcmp(to + shift, from, (size_t)size) >> 31);
      checksum = mix(checksum, (uint32_t)strlen(to + 2 + shift));
    }
    memcpy(to, from, 100);
  }
  for (int i = 1; i < 64; i++)
    records[i] = records[i * 5 % 64];
  for (int i = 0; i < 64; i++)
    checksum = mix(checksum, (uint32_t)records[i].values[9]);
  records[3].values[9] = 27;
  return (struct result){checksum, 0};
}
