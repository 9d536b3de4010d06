#include "outside.h"
#include <jbig.h>

enum { WIDTH = 256, HEIGHT = 128, BYTES = WIDTH * HEIGHT / 8 };
static unsigned char picture[BYTES], packed[4 * BYTES];
static uint32_t packed_size;

void kernel_setup(void) {
  outside_begin();
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++)
      if ((x - 90) * (x - 90) + 3 * (y - 50) * (y - 50) < 4000 || (x / 8 + y / 8) % 5 == 0)
        picture[(y * WIDTH + x) / 8] |= (unsigned char)(0x80 >> x % 8);
}

static void take(unsigned char *start, size_t length, void *unused) {
  (void)unused;
  if (packed_size + length <= sizeof packed)
    memcpy(packed + packed_size, start, length);
  packed_size += (uint32_t)length;
}

struct result kernel_run(void) {
  struct jbg_enc_state encoder;
  struct jbg_dec_state decoder;
  unsigned char *planes[1] = {picture};
  packed_size = 0;
  jbg_enc_init(&encoder, WIDTH, HEIGHT, 1, planes, take, NULL);
  jbg_enc_out(&encoder);
  jbg_enc_free(&encoder);
  jbg_dec_init(&decoder);
  jbg_dec_in(&decoder, packed, packed_size, NULL);
  struct result result = outside_round_trip(picture, jbg_dec_getimage(&decoder, 0), BYTES, packed, packed_size);
  jbg_dec_free(&decoder);
  return result;
}
