#include "outside.h"
#include <gsm.h>

enum { FRAMES = 30, SAMPLES = 160 };
static gsm_signal sound[FRAMES][SAMPLES];

void kernel_setup(void) {
  outside_begin();
  uint32_t random = 5;
  int value = 0, step = 300;
  for (int i = 0; i < FRAMES * SAMPLES; i++) {
    if (value > 9000 || value < -9000)
      step = -step;
    value += step + (int)(next_random(&random) >> 24) - 128;
    sound[i / SAMPLES][i % SAMPLES] = (gsm_signal)value;
  }
}

struct result kernel_run(void) {
  gsm encoder = gsm_create(), decoder = gsm_create();
  gsm_frame frame;
  gsm_signal again[SAMPLES];
  uint32_t sum = 0;
  for (int i = 0; i < FRAMES; i++) {
    gsm_encode(encoder, sound[i], frame);
    gsm_decode(decoder, frame, again);
    sum = mix(mix(sum, outside_sum(frame, sizeof frame)), outside_sum(again, sizeof again));
  }
  gsm_destroy(encoder);
  gsm_destroy(decoder);
  return (struct result){sum, 0};
}
