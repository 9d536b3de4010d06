#include "fast/tm/queue.h"

#include <stdlib.h>
#include <string.h>

bool trax_queue_create(struct trax_queue *queue, uint32_t depth, bool keeps_order) {
  memset(queue, 0, sizeof *queue);
  queue->depth = depth;
  queue->requests = calloc(depth, sizeof *queue->requests);
  if (keeps_order)
    return queue->requests;
  queue->heap = calloc(depth, sizeof *queue->heap);
  queue->places = calloc(depth, sizeof *queue->places);
  for (uint32_t i = 0; queue->places && i < depth; i++)
    queue->places[i] = (uint16_t)i;
  return queue->requests && queue->heap && queue->places;
}

void trax_queue_destroy(struct trax_queue *queue) {
  free(queue->requests);
  free(queue->heap);
  free(queue->places);
}

uint32_t trax_queue_add(struct trax_queue *queue, struct trax_request request) {
  const uint32_t place = queue->places[queue->count++];
  request.number = queue->made++;
  queue->requests[place] = request;
  return place;
}

/* Whether request a arrives before b; requests of one cycle arrive in the order in which they were made. */
static bool is_before(const struct trax_queue *queue, uint32_t a, uint32_t b) {
  const struct trax_request *x = &queue->requests[a], *y = &queue->requests[b];
  return x->completion != y->completion ? x->completion < y->completion : x->number < y->number;
}

/* Enters a request, whose completion has become known, into the heap. */
static void start(struct trax_queue *queue, uint32_t index) {
  uint32_t at = queue->started++;
  for (; at && is_before(queue, index, queue->heap[(at - 1) / 2]); at = (at - 1) / 2)
    queue->heap[at] = queue->heap[(at - 1) / 2];
  queue->heap[at] = (uint16_t)index;
  queue->oldest = queue->heap[0];
}

void trax_queue_receive(struct trax_queue *queue, unsigned side) {
  struct trax_served *const served = &queue->served[side];
  if (!queue->heap)
    queue->started += served->count;
  for (; queue->heap && served->count; served->count--) {
    const uint32_t place = served->first;
    served->first = queue->requests[place].next;
    start(queue, place);
  }
  served->count = 0;
}

void trax_queue_import(struct trax_queue *queue) {
  if (!queue->heap)
    return;
  queue->count = queue->depth;
  queue->started = 0;
  for (uint32_t i = 0; i < queue->depth; i++)
    if (!trax_queue_is_taken(queue, i))
      queue->places[--queue->count] = (uint16_t)i;
    else if (trax_queue_is_started(queue, i))
      start(queue, i);
}

void trax_queue_pop_heap(struct trax_queue *queue) {
  queue->requests[queue->oldest].bytes = 0;
  queue->places[--queue->count] = (uint16_t)queue->oldest;
  const uint16_t last = queue->heap[--queue->started];
  uint32_t at = 0;
  for (uint32_t child = 1; child < queue->started; child = 2 * at + 1) {
    if (child + 1 < queue->started && is_before(queue, queue->heap[child + 1], queue->heap[child]))
      child++;
    if (!is_before(queue, queue->heap[child], last))
      break;
    queue->heap[at] = queue->heap[child];
    at = child;
  }
  queue->heap[at] = last;
  queue->oldest = queue->heap[0];
}
