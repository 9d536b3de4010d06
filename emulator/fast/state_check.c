/* Checks a state that was read from a file (fast/state.h), which may be forged: indices must be within their arrays, an
   element must be in one list at most, and every sleeping TP must have an event that wakes it. Registers, local memory,
   tags and counts may have any value, since a program could have produced it. */
#include "fast/state_check.h"

#include "fast/memory/l2.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>

#define MEMORY_LATENCIES 1048576u /* cycles; more than all latencies together, without the transfers */
#define LAST_CYCLE ((uint64_t)1 << 62)

bool trax_state_expect(struct trax_state_checker *checker, bool good, const char *format, ...) {
  if (good || checker->failed)
    return good;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(checker->text, 128, format, arguments);
  va_end(arguments);
  checker->failed = true;
  return false;
}

void trax_state_check_tags(struct trax_state_checker *checker, const struct trax_cache_tags *tags, const char *which) {
  for (size_t set = 0; set <= tags->set_mask; set++)
    trax_state_expect(checker, trax_cache_tags_next(tags, set) < tags->ways, "%s: set %zu goes on in way %u", which,
                      set, trax_cache_tags_next(tags, set));
}

void trax_state_check_arbiters(struct trax_state_checker *checker, const trax_arbiter *arbiter, size_t count,
                               const char *which) {
  for (size_t i = 0; i < count; i++)
    trax_state_expect(checker, arbiter[i] < 64, "%s %zu: the pointer is %u", which, i, arbiter[i]);
}

/* Marks a request that waits. `lines`: a request of the second-level cache is allowed. */
static bool mark(struct trax_state_checker *checker, trax_request_id id, bool lines, const char *which) {
  const struct trax_memory *memory = &checker->chip->memory;
  const uint32_t depth = checker->chip->tm->queue.depth;
  const uint32_t tm = id >> TRAX_REQUEST_BITS, place = id & ((1u << TRAX_REQUEST_BITS) - 1);
  uint8_t *listed = NULL;
  if (tm < checker->chip->tms && place < depth) {
    const struct trax_queue *queue = &checker->chip->tm[tm].queue;
    listed = trax_queue_is_taken(queue, place) && !trax_queue_is_started(queue, place)
                 ? &checker->listed[tm * depth + place]
                 : NULL;
  } else if (lines && tm == TRAX_MAX_TMS && memory->l2 && place < memory->l2->mshr_limit) {
    listed = &checker->lines_listed[place];
  }
  if (!trax_state_expect(checker, listed && !*listed, "%s: request 0x%" PRIx32, which, id))
    return false;
  *listed = 1;
  return true;
}

/* Checks a list of waiting requests, marks each, and returns their number. `lines`: requests of the second-level cache
   are allowed. */
static uint32_t check_list(struct trax_state_checker *checker, const struct trax_request_list *list, bool lines,
                           const char *which) {
  uint32_t count = 0;
  trax_request_id last = list->last;
  for (trax_request_id id = list->first; id != TRAX_NO_REQUEST;) {
    if (!mark(checker, id, lines, which))
      return count;
    count++;
    last = id;
    id = trax_memory_request(&checker->chip->memory, checker->chip->tm, id)->next;
  }
  trax_state_expect(checker, last == list->last, "%s: the last request is 0x%" PRIx32, which, list->last);
  return count;
}

/* Returns the number of waiting requests. */
static uint32_t check_waiting(struct trax_state_checker *checker, const struct trax_waiting *waiting,
                              const char *which) {
  uint32_t count = 0;
  trax_state_check_arbiters(checker, &waiting->arbiter, 1, which);
  for (unsigned tm = 0; tm < TRAX_MAX_TMS && !checker->failed; tm++) {
    const struct trax_request_list *list = &waiting->list[tm];
    trax_state_expect(checker, (waiting->tms >> tm & 1) == (list->first != TRAX_NO_REQUEST), "%s: 0x%" PRIx64 " wait",
                      which, waiting->tms);
    count += check_list(checker, list, false, which);
  }
  return count;
}

static void check_l2(struct trax_state_checker *checker, const struct trax_l2 *l2) {
  uint8_t seen[1 << TRAX_REQUEST_BITS] = {0};
  uint32_t waiting = 0;
  uint64_t next_arrival = TRAX_NEVER;
  trax_state_check_tags(checker, &l2->tags, "second-level cache");
  trax_state_expect(checker, l2->used_count <= l2->mshr_limit, "second-level cache: %" PRIu32 " lines are on their way",
                    l2->used_count);
  for (uint32_t i = 0; i < l2->mshr_limit && !checker->failed; i++)
    trax_state_expect(checker, l2->used[i] < l2->mshr_limit && !seen[l2->used[i]]++,
                      "second-level cache: miss register %u is %" PRIu32, l2->used[i], i);
  for (uint32_t i = 0; i < l2->banks && !checker->failed; i++)
    waiting += check_waiting(checker, &l2->bank[i], "bank of the second-level cache");
  trax_state_expect(checker, waiting == l2->waiting, "second-level cache: %" PRIu32 " of %" PRIu32 " wait", waiting,
                    l2->waiting);
  for (unsigned i = 0; i < TRAX_MAX_CHANNELS && !checker->failed; i++) {
    const trax_request_id first = l2->arriving[i].first;
    check_list(checker, &l2->arriving[i], true, "coming line");
    if (!checker->failed && first != TRAX_NO_REQUEST &&
        trax_state_expect(checker, first >= TRAX_LINE_REQUEST, "coming line: request 0x%" PRIx32, first)) {
      const uint64_t arrival = l2->mshr[first - TRAX_LINE_REQUEST].arrival;
      next_arrival = arrival < next_arrival ? arrival : next_arrival;
    }
  }
  trax_state_expect(checker, l2->next_arrival == next_arrival, "second-level cache: the next line comes in %" PRIu64,
                    l2->next_arrival);
  for (uint32_t i = 0; i < l2->used_count && !checker->failed; i++) {
    const struct trax_l2_mshr *mshr = &l2->mshr[l2->used[i]];
    for (uint32_t j = 0; j < i; j++)
      trax_state_expect(checker, l2->line[j] != l2->line[i], "second-level cache: line %" PRIu32 " comes twice",
                        l2->line[i]);
    trax_state_expect(checker,
                      l2->line[i] == trax_line_of(&l2->tags, mshr->request.address) &&
                          mshr->request.bytes == l2->line_cost && mshr->request.kind == TRAX_REQUEST_DATA_LINE &&
                          (mshr->arrival == TRAX_NEVER ||
                           (mshr->arrival <= checker->farthest && mshr->waiters.first == TRAX_NO_REQUEST)),
                      "second-level cache, line %" PRIu32 ": arrives in %" PRIu64, l2->line[i], mshr->arrival);
    check_list(checker, &mshr->waiters, false, "line of the second-level cache");
  }
}

/* Checks that the lines with an arrival, and no others, are in the lists of arriving lines, in its order, that each
   used miss register is in one list, and that free ones are in none. */
static void check_lines_listed(struct trax_state_checker *checker, const struct trax_l2 *l2) {
  uint32_t arriving = 0;
  for (uint32_t i = 0; i < l2->mshr_limit; i++)
    trax_state_expect(checker, checker->lines_listed[l2->used[i]] == (i < l2->used_count),
                      "second-level cache: miss register %u is in no list, or without a line", l2->used[i]);
  for (uint32_t i = 0; i < l2->used_count; i++)
    arriving += l2->mshr[l2->used[i]].arrival != TRAX_NEVER;
  for (unsigned i = 0; i < TRAX_MAX_CHANNELS; i++) {
    uint64_t before = 0;
    for (trax_request_id id = l2->arriving[i].first; id != TRAX_NO_REQUEST;) { /* check_list has checked the ids */
      const struct trax_l2_mshr *mshr = id >= TRAX_LINE_REQUEST ? &l2->mshr[id - TRAX_LINE_REQUEST] : NULL;
      if (!trax_state_expect(checker, mshr && mshr->arrival != TRAX_NEVER && mshr->arrival >= before,
                             "coming line: request 0x%" PRIx32, id))
        return;
      arriving--;
      before = mshr->arrival;
      id = mshr->request.next;
    }
  }
  trax_state_expect(checker, arriving == 0, "second-level cache: a line with an arrival does not come");
}

/* The requests that the machine can have. */
static uint64_t most_requests(const struct trax_chip *chip) {
  uint64_t requests = chip->memory.l2 ? chip->memory.l2->mshr_limit : 0;
  for (uint32_t i = 0; i < chip->tms; i++)
    requests += chip->tm[i].queue.depth;
  return requests;
}

/* Returns the number of requests in the queues of a channel's DRAM, and marks each. */
static uint32_t check_dram(struct trax_state_checker *checker, uint32_t number) {
  const struct trax_dram *dram = checker->chip->memory.dram;
  const struct trax_dram_channel *channel = &dram->channel[number];
  uint32_t count = 0;
  if (!trax_state_expect(checker, trax_dram_check(dram, number, checker->t, most_requests(checker->chip)),
                         "channel %" PRIu32 ": the state of its DRAM", number))
    return count;
  for (unsigned queue = 0; queue < TRAX_DRAM_QUEUES; queue++)
    for (uint32_t i = 0; i < channel->count[queue]; i++, count++)
      if (!mark(checker, channel->request[queue][i].id, true, "queue of the DRAM"))
        return count;
  return count;
}

static void check_memory(struct trax_state_checker *checker) {
  const struct trax_memory *memory = &checker->chip->memory;
  const uint32_t depth = checker->chip->tm->queue.depth;
  uint32_t waiting = 0;
  trax_state_check_arbiters(checker, &memory->arbiter, 1, "memory controller");
  for (uint32_t i = 0; i < memory->channels && !checker->failed; i++) {
    const struct trax_channel *channel = &memory->channel[i];
    trax_state_expect(
        checker, channel->free_from.units < memory->units_per_cycle && channel->free_from.cycle <= checker->farthest,
        "channel %" PRIu32 ": free from cycle %" PRIu64 " and %" PRIu64, i, channel->free_from.cycle,
        channel->free_from.units);
    waiting += check_list(checker, &channel->passed, true, "channel");
    if (channel->waiting && !checker->failed)
      waiting += check_waiting(checker, channel->waiting, "channel");
    if (memory->dram && !checker->failed)
      waiting += check_dram(checker, i);
    trax_state_expect(checker, channel->unit_free_from <= checker->farthest,
                      "channel %" PRIu32 ": increments from cycle %" PRIu64, i, channel->unit_free_from);
  }
  trax_state_expect(checker, waiting == memory->waiting, "memory controller: %" PRIu32 " of %" PRIu32 " wait", waiting,
                    memory->waiting);
  if (memory->l2 && !checker->failed)
    check_l2(checker, memory->l2);
  if (memory->l2 && !checker->failed)
    check_lines_listed(checker, memory->l2);
  for (uint32_t tm = 0; tm < TRAX_MAX_TMS && !checker->failed; tm++) {
    const struct trax_queue *queue = tm < checker->chip->tms ? &checker->chip->tm[tm].queue : NULL;
    const bool waits = memory->keeps_order && queue && queue->started < queue->submitted;
    trax_state_expect(checker, (memory->tms >> tm & 1) == waits, "memory controller: 0x%" PRIx64 " wait", memory->tms);
    for (uint32_t place = 0; queue && queue->heap && place < depth; place++)
      trax_state_expect(checker,
                        checker->listed[tm * depth + place] ==
                            (trax_queue_is_taken(queue, place) && !trax_queue_is_started(queue, place)),
                        "TM %u, request %" PRIu32 ": waits in no list", tm, place);
  }
}

/* Returns a cycle in which all transfers must be over, if they were made one after the other. */
static uint64_t farthest_cycle(const struct trax_chip *chip, uint64_t t) {
  const struct trax_memory *memory = &chip->memory;
  const uint64_t requests = most_requests(chip);
  const uint64_t transfer = memory->dram ? trax_dram_cycles(memory->dram, trax_dram_most_ticks(memory->dram))
                                         : TRAX_STATE_MOST_BYTES * memory->units_per_byte / memory->units_per_cycle;
  return t + MEMORY_LATENCIES + requests * (transfer + memory->unit_interval + 1);
}

const char *trax_state_check(void *state, uint64_t t, char text[128]) {
  struct trax_chip *chip = state;
  const size_t requests = (size_t)chip->tms * chip->tm->queue.depth;
  struct trax_state_checker checker = {
      .chip = chip, .t = t, .farthest = farthest_cycle(chip, t), .text = text, .listed = calloc(requests, 1)};
  checker.lines_listed = calloc(1 << TRAX_REQUEST_BITS, 1);
  if (trax_state_expect(&checker, checker.listed && checker.lines_listed, "out of memory") &&
      trax_state_expect(&checker, t > 0 && t < LAST_CYCLE, "it is before cycle %" PRIu64, t)) {
    for (uint32_t i = 0; i < chip->tms; i++)
      trax_state_check_tm(&checker, &chip->tm[i]);
    if (!checker.failed)
      check_memory(&checker);
  }
  free(checker.listed);
  free(checker.lines_listed);
  return checker.failed ? text : NULL;
}
