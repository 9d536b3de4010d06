/* A TM's memory queue: a place for each request that has not completed (docs/timing-memory.md, "Memory queue"). A
   request that waits is in a list of the memory; one whose completion is known has started.

   In an epoch the memory serves requests while the TM goes on. It writes to the places of waiting requests and to
   `served`; the TM uses the others, and receives what has been served between two quanta. */
#ifndef TRAX_FAST_QUEUE_H
#define TRAX_FAST_QUEUE_H

#include "machine/section.h"

#include <stdbool.h>

#define TRAX_NO_REQUEST UINT32_MAX

/* One side is used by the TM while the memory uses the other (epochs.c). */
enum { TRAX_SIDES = 2 };

typedef enum trax_request_kind {
  TRAX_REQUEST_INSTRUCTION_LINE,
  TRAX_REQUEST_DATA_LINE,
  TRAX_REQUEST_LOAD, /* past the cache */
  TRAX_REQUEST_WRITE,
  TRAX_REQUEST_ATOMIC
} trax_request_kind;

#define TRAX_REQUEST_STATE(X, S)                                                                                       \
  X(S, uint8_t, kind, )        /* trax_request_kind */                                                                 \
  X(S, uint8_t, tp, )          /* LOAD, WRITE, ATOMIC: the TP that made it */                                          \
  X(S, uint8_t, rd, )          /* LOAD, ATOMIC: the register that waits */                                             \
  X(S, uint8_t, icache, )      /* INSTRUCTION_LINE: the cache's number */                                              \
  X(S, uint32_t, line, )       /* INSTRUCTION_LINE, DATA_LINE: the line's number */                                    \
  X(S, uint32_t, address, )    /* of the first byte */                                                                 \
  X(S, uint32_t, bytes, )      /* of the transfer; 0 in a free place */                                                \
  X(S, uint32_t, value, )      /* ATOMIC: the word before the increment, once started */                               \
  X(S, uint32_t, next, )       /* the next request of its list */                                                      \
  X(S, uint64_t, number, )     /* number of requests that its TM made before */                                        \
  X(S, uint64_t, completion, ) /* a cycle, once started; 0 before */
struct trax_request {
  TRAX_REQUEST_STATE(TRAX_FIELD, )
};

#define TRAX_QUEUE_STATE(X, S)                                                                                         \
  X(S, uint32_t, peak, ) /* the largest count so far */                                                                \
  X(S, uint64_t, made, ) /* number of requests so far */
struct trax_queue {
  TRAX_QUEUE_STATE(TRAX_FIELD, )
  uint32_t depth, count, started;
  struct trax_request *requests; /* [depth] */
  uint16_t *places; /* [depth]: the `started` ones, the next to arrive last; from `count` on, the free ones */
  /* Requests whose completion is known, and which the TM has not received: a list, linked by trax_request.next. Outside
     epochs [0] alone is used. */
  struct trax_served {
    uint32_t first, count;
  } served[TRAX_SIDES];
};

/* False: out of memory. The queue must be destroyed in either case. */
bool trax_queue_create(struct trax_queue *queue, uint32_t depth);
void trax_queue_destroy(struct trax_queue *queue);

/* Makes what follows from the requests. */
void trax_queue_import(struct trax_queue *queue);
/* Starts the requests that the memory has served. */
void trax_queue_receive(struct trax_queue *queue, unsigned side);

static inline bool trax_queue_has_place(const struct trax_queue *queue) {
  return queue->count < queue->depth;
}

/* Adds a request and returns its place. */
static inline uint32_t trax_queue_push(struct trax_queue *queue, struct trax_request request) {
  const uint32_t place = queue->places[queue->count++];
  request.number = queue->made++;
  queue->requests[place] = request;
  if (queue->count > queue->peak)
    queue->peak = queue->count;
  return place;
}

/* Frees the place of the request that arrives next. */
static inline void trax_queue_pop(struct trax_queue *queue) {
  const uint16_t place = queue->places[--queue->started];
  queue->requests[place].bytes = 0;
  queue->places[--queue->count] = place;
}

/* Returns the next request to arrive, if any is started. */
static inline struct trax_request *trax_queue_oldest(const struct trax_queue *queue) {
  return &queue->requests[queue->places[queue->started - 1]];
}

#endif
