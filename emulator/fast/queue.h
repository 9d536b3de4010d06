/* A TM's memory queue: a place for each request it has made and not yet got back (docs/timing.md, "Memory queue").

   Where all requests of a TM complete in the order in which they were made (trax_memory_keeps_order), the places are a
   ring: the oldest `started` requests have been served, the others wait. Otherwise a request that is made is `fresh`
   until the memory learns of it and takes it into a list of its own, and those whose completion is known are in a heap,
   the next to arrive on top. Either way `started` requests have a completion, and the next to arrive is in `oldest`. */
#ifndef TRAX_FAST_QUEUE_H
#define TRAX_FAST_QUEUE_H

#include "machine/section.h"

#include <stdbool.h>

#define TRAX_NO_REQUEST UINT32_MAX

typedef enum trax_request_kind {
  TRAX_REQUEST_INSTRUCTION_LINE,
  TRAX_REQUEST_DATA_LINE,
  TRAX_REQUEST_LOAD, /* past the cache */
  TRAX_REQUEST_WRITE,
  TRAX_REQUEST_ATOMIC
} trax_request_kind;

#define TRAX_REQUEST_STATE(X, S)                                                                                       \
  X(S, uint8_t, kind, )        /* trax_request_kind */                                                                 \
  X(S, uint8_t, tp, )          /* LOAD and ATOMIC: whose */                                                            \
  X(S, uint8_t, rd, )          /* LOAD and ATOMIC: register that waits */                                              \
  X(S, uint8_t, icache, )      /* INSTRUCTION_LINE: which cache */                                                     \
  X(S, uint32_t, line, )       /* INSTRUCTION_LINE and DATA_LINE: number */                                            \
  X(S, uint32_t, address, )    /* of the first byte */                                                                 \
  X(S, uint32_t, bytes, )      /* of the transfer; 0 in a place that is free, unless in a ring */                      \
  X(S, uint32_t, value, )      /* ATOMIC: the word before the increment, once started */                               \
  X(S, uint32_t, next, )       /* in a list of the memory, or of the fresh; not in a ring */                           \
  X(S, uint64_t, number, )     /* how many its TM had made before; not in a ring */                                    \
  X(S, uint64_t, completion, ) /* cycle, once started */
struct trax_request {
  TRAX_REQUEST_STATE(TRAX_FIELD, )
};

/* `shown`: how many of a ring's requests the memory knows of; all, unless the TM runs ahead (fast/store_buffer.h). */
#define TRAX_QUEUE_STATE(X, S)                                                                                         \
  X(S, uint32_t, oldest, )                                                                                             \
  X(S, uint32_t, count, )                                                                                              \
  X(S, uint32_t, started, )                                                                                            \
  X(S, uint32_t, submitted, )                                                                                          \
  X(S, uint32_t, peak, ) /* largest count */                                                                           \
  X(S, uint32_t, first_unsubmitted, )                                                                                  \
  X(S, uint32_t, last_unsubmitted, )                                                                                   \
  X(S, uint64_t, made, ) /* requests */
struct trax_queue {
  TRAX_QUEUE_STATE(TRAX_FIELD, )
  uint32_t depth;
  struct trax_request *requests; /* [depth] */
  uint16_t *heap;                /* [depth]; NULL: the places are a ring */
  uint16_t *places;              /* [depth]: behind the first `count`, the places that are free */
};

/* False if there is no memory for it; to be destroyed either way. */
bool trax_queue_create(struct trax_queue *queue, uint32_t depth, bool keeps_order);
void trax_queue_destroy(struct trax_queue *queue);

/* For queues that are no ring. */
void trax_queue_push_unsubmitted(struct trax_queue *queue, struct trax_request request);
/* The request's completion has become known. */
void trax_queue_start(struct trax_queue *queue, uint32_t index);
void trax_queue_pop_heap(struct trax_queue *queue);

static inline bool trax_queue_has_place(const struct trax_queue *queue) {
  return queue->count < queue->depth;
}

static inline void trax_queue_push(struct trax_queue *queue, struct trax_request request) {
  if (queue->heap) {
    trax_queue_push_unsubmitted(queue, request);
  } else {
    const uint32_t index = queue->oldest + queue->count;
    queue->requests[index < queue->depth ? index : index - queue->depth] = request;
    queue->count++;
  }
  if (queue->count > queue->peak)
    queue->peak = queue->count;
}

/* The next to arrive, if one is started. */
static inline struct trax_request *trax_queue_oldest(const struct trax_queue *queue) {
  return &queue->requests[queue->oldest];
}

/* Of a ring. */
static inline struct trax_request *trax_queue_first_waiting(const struct trax_queue *queue) {
  const uint32_t index = queue->oldest + queue->started;
  return &queue->requests[index < queue->depth ? index : index - queue->depth];
}

/* Whether a request has place `index`. */
static inline bool trax_queue_is_taken(const struct trax_queue *queue, uint32_t index) {
  if (queue->heap)
    return queue->requests[index].bytes != 0;
  return (index < queue->oldest ? index + queue->depth : index) - queue->oldest < queue->count;
}

/* Frees the place of the one that arrives next. */
static inline void trax_queue_pop(struct trax_queue *queue) {
  if (queue->heap) {
    trax_queue_pop_heap(queue);
    return;
  }
  queue->oldest = queue->oldest + 1 < queue->depth ? queue->oldest + 1 : 0;
  queue->count--;
  queue->submitted--;
  queue->started--;
}

#endif
