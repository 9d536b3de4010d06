/* Which slot a thread takes next (trax/render_params.h says what slots are). A specialised program may have TRAX_QUEUES
   queues, in which every so many-th tile waits. A TM begins with its own, so that with as many queues as TMs a tile is
   seen through one cache. A thread that finds its queue empty goes on with the next one. */
#ifndef TRAX_DEVICE_SLOTS_H
#define TRAX_DEVICE_SLOTS_H

#include "bits.h"
#include "trax/render_params.h"

#include <stdbool.h>
#include <trax.h>

#ifndef TRAX_QUEUES
#define TRAX_QUEUES 1
#endif

/* On a chip of more TMs than there are queues several have one. */
static inline uint32_t first_queue(void) {
  if (TRAX_QUEUES == 1)
    return 0;
  uint32_t queue = trax_tm();
  while (queue >= TRAX_QUEUES)
    queue -= TRAX_QUEUES;
  return queue;
}

/* Asks for a number of a queue. It takes as long as a transfer from memory, and the thread goes on until it is used. */
static inline uint32_t ask_for_number(unsigned next[TRAX_QUEUES], uint32_t queue) {
  return trax_atomic_inc(&next[queue]);
}

/* The slot of a number that was asked for, or of another queue's, if this one has no more. False: there is none left.
   next: of each queue, the numbers taken, including those taken when it was empty. */
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
  HIDE_ORIGIN(*slot); /* or the compiler would compute a picture of one pixel, and not with the machine's divider */
  return true;
}

#endif
