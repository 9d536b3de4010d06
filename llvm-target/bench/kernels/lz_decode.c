/* A decoder of byte-oriented LZ77: a control byte is a run of literals, or a copy from what was written before. */
#include "../bench.h"

enum { SIZE = 12000 };
static unsigned char packed[2 * SIZE], plain[SIZE];
static int packed_size;

/* Not a compressor: any valid sequence will do, with lengths like a compressor's. */
void kernel_setup(void) {
  uint32_t random = 31;
  int written = 0, at = 0;
  while (written < SIZE) {
    int length = 1 + (int)(next_random(&random) >> 28), left = SIZE - written;
    if (written < 64 || next_random(&random) >> 31) {
      length = length < left ? length : left;
      packed[at++] = (unsigned char)length;
      for (int i = 0; i < length; i++)
        packed[at++] = (unsigned char)('a' + (next_random(&random) >> 27));
    } else {
      length = length + 3 < left ? length + 3 : left;
      int limit = written < 4096 ? written : 4096, distance = 1 + (int)(next_random(&random) >> 16) % limit;
      packed[at++] = (unsigned char)(0x80 | length);
      packed[at++] = (unsigned char)(distance & 255);
      packed[at++] = (unsigned char)(distance >> 8);
    }
    written += length;
  }
  packed_size = at;
}

static int decode(const unsigned char *in, const unsigned char *end, unsigned char *out) {
  unsigned char *first = out;
  while (in < end) {
    int length = *in++;
    if (length & 0x80) {
      length &= 0x7F;
      int distance = in[0] | in[1] << 8;
      in += 2;
      const unsigned char *from = out - distance;
      while (length-- > 0)
        *out++ = *from++;
    } else {
      while (length-- > 0)
        *out++ = *in++;
    }
  }
  return (int)(out - first);
}

struct result kernel_run(void) {
  uint32_t checksum = (uint32_t)decode(packed, packed + packed_size, plain);
  for (int i = 0; i < SIZE; i++)
    checksum = mix(checksum, plain[i]);
  return (struct result){checksum, 0};
}
