/* A TM's memory queue: the requests it has made to off-chip memory and not yet got back, in the order in which they
   were made. The oldest `started` of them are at the controller or on their way back, the others wait. Since the
   controller serves one TM's requests in order and adds the same latency to each, they also complete in order. */
#ifndef TRAX_CORE_QUEUE_H
#define TRAX_CORE_QUEUE_H

#include <stdbool.h>
#include <stdint.h>

typedef enum trax_request_kind {
  TRAX_REQUEST_INSTRUCTION_LINE,
  TRAX_REQUEST_DATA_LINE,
  TRAX_REQUEST_LOAD, /* past the cache */
  TRAX_REQUEST_WRITE,
  TRAX_REQUEST_ATOMIC
} trax_request_kind;

struct trax_request {
  uint8_t kind;        /* trax_request_kind */
  uint8_t tp;          /* LOAD and ATOMIC: whose */
  uint8_t rd;          /* LOAD and ATOMIC: register that waits */
  uint8_t icache;      /* INSTRUCTION_LINE: which cache */
  uint32_t line;       /* INSTRUCTION_LINE and DATA_LINE: number */
  uint32_t address;    /* ATOMIC */
  uint32_t bytes;      /* of the transfer */
  uint32_t value;      /* ATOMIC: the word before the increment, once started */
  uint64_t completion; /* cycle, once started */
};

struct trax_queue {
  struct trax_request *requests; /* ring of `depth` */
  uint32_t depth, oldest, count, started;
  uint32_t shown; /* of `count`, how many the controller knows of: all, unless the TM runs ahead (core/ahead.h) */
  uint32_t peak;  /* largest count */
};

static inline bool trax_queue_has_place(const struct trax_queue *queue) {
  return queue->count < queue->depth;
}

static inline void trax_queue_push(struct trax_queue *queue, struct trax_request request) {
  const uint32_t index = queue->oldest + queue->count;
  queue->requests[index < queue->depth ? index : index - queue->depth] = request;
  if (++queue->count > queue->peak)
    queue->peak = queue->count;
}

static inline struct trax_request *trax_queue_oldest(const struct trax_queue *queue) {
  return &queue->requests[queue->oldest];
}

static inline struct trax_request *trax_queue_first_waiting(const struct trax_queue *queue) {
  const uint32_t index = queue->oldest + queue->started;
  return &queue->requests[index < queue->depth ? index : index - queue->depth];
}

static inline void trax_queue_pop(struct trax_queue *queue) {
  queue->oldest = queue->oldest + 1 < queue->depth ? queue->oldest + 1 : 0;
  queue->count--;
  queue->shown--;
  queue->started--;
}

#endif
