/* The choice of the next slot of a thread (trax/render_params.h defines slots). A specialised program may have
   TRAX_QUEUES queues; tile t waits in queue t % TRAX_QUEUES. A TM begins with its own queue, so that with a queue for
   each TM a tile is rendered through one cache. A thread whose queue is empty goes on with the next one. */
#ifndef TRAX_DEVICE_SLOTS_H
#define TRAX_DEVICE_SLOTS_H

#include "bits.h"
#include "trax/render_params.h"

#include <stdbool.h>
#include <trax.h>

#ifndef TRAX_QUEUES
#define TRAX_QUEUES 1
#endif

/* If the chip has more TMs than queues, several TMs share one. */
static inline uint32_t first_queue(void) {
  if (TRAX_QUEUES == 1)
    return 0;
  uint32_t queue = trax_tm();
  while (queue >= TRAX_QUEUES)
    queue -= TRAX_QUEUES;
  return queue;
}

/* Requests a number of a queue. It arrives as late as data from memory; the thread goes on until the number is used. */
static inline uint32_t ask_for_number(unsigned next[TRAX_QUEUES], uint32_t queue) {
  return trax_atomic_inc(&next[queue]);
}

/* The slot of a requested number, or of another queue's if this one is empty. False if no slot is left. next: the
   numbers taken from each queue, including those taken when it was empty. */
static inline bool take_slot(const struct trax_render_params *run, unsigned next[TRAX_QUEUES], uint32_t number,
                             uint32_t *queue, uint32_t *slot) {
  const uint32_t tile_bits = 2 * run->tile_log2_side;
  for (;; number = ask_for_number(next, *queue)) {
    *slot = TRAX_QUEUES == 1
                ? number
                : ((number >> tile_bits) * TRAX_QUEUES + *queue) << tile_bits | (number & ((1u << tile_bits) - 1));
    if (*slot < run->slot_count)
      break;
    *queue = *queue + 1 < TRAX_QUEUES ? *queue + 1 : 0;
    if (*queue == first_queue())
      return false;
  }
  HIDE_ORIGIN(*slot); /* else the compiler computes a picture of one pixel, without the machine's divider */
  return true;
}

#endif
