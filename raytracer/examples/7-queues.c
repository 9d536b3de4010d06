/* Step 7: queues of tiles. Pixels are handed out in tiles, within them along a curve, so that the threads that share a
   data cache look at neighbouring parts of the scene; and each TM takes tiles from a queue of its own, so that no two
   caches have the lines of one tile. A pixel is found without a division, which the machine does not have for
   integers. */
#include "queues.h"
#include "traversal.h"

#include "registers.h"

struct trax_buffer scene, params, image;

int main(void) {
  const struct trax_render_params *frame = params.data;
  check_input(frame, scene.data);
  for (unsigned turn = 0; turn < QUEUES; turn++) { /* a thread whose queue is empty goes on with the next */
    unsigned queue = (trax_tm() + turn) % QUEUES, slot, x, y;
    while ((slot = take_slot(frame, queue)) < frame->slot_count) {
      if (!slot_pixel(frame, slot, &x, &y))
        continue;
      trax_store_nt((unsigned *)image.data + y * frame->width + x, render(frame, x, y));
      trax_count_items(1);
    }
  }
  return 0;
}
