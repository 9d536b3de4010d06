/* Round robin over at most 64 positions (docs/timing.md, "Words"): the winner goes to the back.

   Positions are bit numbers. The pointer is the winner's number + 1 modulo 64, also if there are fewer positions or a
   group begins above bit 0. If no requesting bit is at or above the pointer, the search wraps to the lowest one, as it
   would if the pointer had wrapped to the group's first position. */
#ifndef TRAX_FAST_ARBITER_H
#define TRAX_FAST_ARBITER_H

#include <stdint.h>

typedef uint8_t trax_arbiter; /* the pointer, modulo 64 */

/* The lowest bit of a mask that is not 0. */
static inline unsigned trax_first(uint64_t mask) {
  return (unsigned)__builtin_ctzll(mask);
}

/* Returns the first requester (not 0) from the pointer on, and leaves the pointer. */
static inline unsigned trax_arbiter_peek(trax_arbiter pointer, uint64_t requesters) {
  const uint64_t from_pointer = requesters & (~(uint64_t)0 << pointer % 64);
  return trax_first(from_pointer ? from_pointer : requesters);
}

static inline void trax_arbiter_to_back(trax_arbiter *pointer, unsigned winner) {
  *pointer = (uint8_t)((winner + 1) & 63);
}

/* Grants up to `count` requests and returns the winners. */
static inline uint64_t trax_arbiter_grant(trax_arbiter *pointer, uint64_t requesters, unsigned count) {
  uint64_t winners = 0;
  for (; requesters && count; count--) {
    const unsigned winner = trax_arbiter_peek(*pointer, requesters);
    trax_arbiter_to_back(pointer, winner);
    winners |= (uint64_t)1 << winner;
    requesters &= ~((uint64_t)1 << winner);
  }
  return winners;
}

/* The mask of group `number`, with groups of `size` neighbours. */
static inline uint64_t trax_group_mask(unsigned number, unsigned size) {
  const unsigned first = number * size;
  const uint64_t bits = size >= 64 ? ~(uint64_t)0 : ((uint64_t)1 << size) - 1;
  return first >= 64 ? 0 : bits << first;
}

#endif
