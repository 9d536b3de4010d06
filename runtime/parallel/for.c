/* Loops. Data for all threads are not on the stack, which may be in the caller's local memory. */
#include "team.h"

#ifdef __trax__

static struct {
  unsigned begin, length, grain, next;
  trax_range *function;
  trax_reduce_range *reduce;
  void *context;
  char *parts;
  size_t size, stride;
} loop;

static unsigned part_end(unsigned first) {
  return loop.length - first < loop.grain ? loop.length : first + loop.grain;
}

static void call(unsigned first) {
  loop.function(loop.begin + first, loop.begin + part_end(first), loop.context);
}

static void dynamic(void *nothing) {
  (void)nothing;
  const unsigned parts = (loop.length - 1) / loop.grain + 1;
  for (unsigned part; (part = trax_atomic_inc(&loop.next)) < parts;)
    call(part * loop.grain);
}

static void in_turn(void *nothing) {
  (void)nothing;
  const unsigned step = loop.grain * trax_team_size();
  for (unsigned first = trax_team_rank() * loop.grain; first < loop.length;) {
    call(first);
    if (loop.length - first <= step)
      break;
    first += step;
  }
}

static void run(void (*way)(void *), unsigned begin, unsigned end, unsigned grain, trax_range *function, void *context,
                unsigned parts) {
  if (begin >= end)
    return;
  if (__trax_team_available() == 1) {
    function(begin, end, context);
    return;
  }
  loop.begin = begin;
  loop.length = end - begin;
  loop.grain = grain ? grain : (loop.length - 1) / (parts * trax_threads()) + 1;
  loop.next = 0;
  loop.function = function;
  loop.context = context;
  trax_parallel(way, NULL);
}

void trax_parallel_for(unsigned begin, unsigned end, unsigned grain, trax_range *function, void *context) {
  run(dynamic, begin, end, grain, function, context, 8);
}

void trax_parallel_for_static(unsigned begin, unsigned end, unsigned grain, trax_range *function, void *context) {
  run(in_turn, begin, end, grain, function, context, 1);
}

static void reduce(void *nothing) {
  (void)nothing;
  const unsigned rank = trax_team_rank(), first = rank * loop.grain;
  char *part = loop.parts + (rank + 1) * loop.stride;
  memcpy(part, loop.parts, loop.size);
  if (first < loop.length)
    loop.reduce(loop.begin + first, loop.begin + part_end(first), loop.context, part);
}

int trax_parallel_reduce(unsigned begin, unsigned end, trax_reduce_range *function, void *context, void *result,
                         size_t size, void (*combine)(void *, const void *)) {
  if (begin >= end)
    return 0;
  if (__trax_team_available() == 1) {
    function(begin, end, context, result);
    return 0;
  }
  loop.begin = begin;
  loop.length = end - begin;
  loop.grain = (loop.length - 1) / trax_threads() + 1;
  loop.reduce = function;
  loop.context = context;
  loop.size = size;
  loop.stride = (size + 7) & ~(size_t)7;
  loop.parts = malloc((trax_threads() + 1) * loop.stride);
  if (!loop.parts)
    return -1;
  memcpy(loop.parts, result, size);
  const unsigned team = trax_parallel(reduce, NULL);
  for (unsigned rank = 0; rank < team; rank++)
    combine(result, loop.parts + (rank + 1) * loop.stride);
  free(loop.parts);
  return 0;
}

#endif
