#include "fast/tm/queue.h"

#include <stdlib.h>
#include <string.h>

bool trax_queue_create(struct trax_queue *queue, uint32_t depth) {
  memset(queue, 0, sizeof *queue);
  queue->depth = depth;
  queue->requests = calloc(depth, sizeof *queue->requests);
  queue->places = calloc(depth, sizeof *queue->places);
  for (uint32_t i = 0; queue->places && i < depth; i++)
    queue->places[i] = (uint16_t)i;
  return queue->requests && queue->places;
}

void trax_queue_destroy(struct trax_queue *queue) {
  free(queue->requests);
  free(queue->places);
}

/* Whether request a arrives before b; requests of one cycle arrive in the order in which they were made. */
static bool is_before(const struct trax_queue *queue, uint32_t a, uint32_t b) {
  const struct trax_request *x = &queue->requests[a], *y = &queue->requests[b];
  return x->completion != y->completion ? x->completion < y->completion : x->number < y->number;
}

/* Enters a request whose completion has become known, and moves those that arrive before it, which are few. */
static void start(struct trax_queue *queue, uint32_t place) {
  uint32_t at = queue->started++;
  for (; at && is_before(queue, queue->places[at - 1], place); at--)
    queue->places[at] = queue->places[at - 1];
  queue->places[at] = (uint16_t)place;
}

void trax_queue_receive(struct trax_queue *queue, unsigned side) {
  struct trax_served *const served = &queue->served[side];
  for (; served->count; served->count--) {
    const uint32_t place = served->first;
    served->first = queue->requests[place].next;
    start(queue, place);
  }
}

void trax_queue_import(struct trax_queue *queue) {
  queue->count = queue->depth;
  queue->started = 0;
  for (uint32_t i = 0; i < queue->depth; i++)
    if (!queue->requests[i].bytes)
      queue->places[--queue->count] = (uint16_t)i;
  for (uint32_t i = 0; i < queue->depth; i++)
    if (queue->requests[i].bytes && queue->requests[i].completion)
      start(queue, i);
}
