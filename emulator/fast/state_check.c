/* Checks a state that was read from a file (fast/state.h), which may be forged: indices must be within their arrays, an
   element must be in one list at most, and every sleeping TP must have an event that wakes it. Registers, local memory,
   tags and counts may have any value, since a program could have produced it. */
#include "fast/state.h"

#include "fast/l2.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#define UNIT_LATENCIES 65536u     /* cycles; more than the latencies of units and caches together */
#define MEMORY_LATENCIES 1048576u /* cycles; more than all latencies together, without the transfers */
#define MOST_BYTES 4096u          /* limit of a transfer */
#define LAST_CYCLE ((uint64_t)1 << 62)

struct checker {
  struct trax_chip *chip;
  uint64_t t, farthest; /* farthest: a cycle in which all requests must have completed */
  char *text;           /* [128] */
  bool failed;
  /* [tm * depth + place] and [miss register of the second-level cache]: how often each request is in a list of requests
     that wait for a channel or a bank. */
  uint8_t *listed, *lines_listed;
};

__attribute__((format(printf, 3, 4))) static bool expect(struct checker *checker, bool good, const char *format, ...) {
  if (good || checker->failed)
    return good;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(checker->text, 128, format, arguments);
  va_end(arguments);
  checker->failed = true;
  return false;
}

/* Whether a cycle is in reach of the latencies of units and caches. */
static bool is_soon(const struct checker *checker, uint64_t cycle) {
  return cycle <= checker->t + UNIT_LATENCIES;
}

static void check_tags(struct checker *checker, const struct trax_cache_tags *tags, const char *which) {
  for (size_t set = 0; set <= tags->set_mask; set++)
    expect(checker, trax_cache_tags_next(tags, set) < tags->ways, "%s: set %zu goes on in way %u", which, set,
           trax_cache_tags_next(tags, set));
}

static void check_arbiters(struct checker *checker, const trax_arbiter *arbiter, size_t count, const char *which) {
  for (size_t i = 0; i < count; i++)
    expect(checker, arbiter[i] < 64, "%s %zu: the pointer is %u", which, i, arbiter[i]);
}

/* --- a TM --- */

/* What the requests in a TM's queue are for. */
struct wanted {
  uint32_t data_lines, instruction_lines;
  uint16_t writes[TRAX_MAX_TPS_PER_TM], increments[TRAX_MAX_TPS_PER_TM];
  uint64_t registers[TRAX_MAX_TPS_PER_TM]; /* masks of registers that arrivals will make usable, TRAX_NO_REGISTER too */
};

static uint32_t find_mshr(const struct trax_dcache *dcache, uint32_t line) {
  uint32_t i = 0;
  while (i < dcache->mshr_count && dcache->mshr[i].line != line)
    i++;
  return i;
}

static uint32_t find_pending(const struct trax_icache *icache, uint32_t line) {
  uint32_t i = 0;
  while (i < icache->pending_count && icache->pending[i].line != line)
    i++;
  return i;
}

static bool is_started(const struct trax_queue *queue, uint32_t place) {
  if (queue->heap) {
    for (uint32_t i = 0; i < queue->started; i++)
      if (queue->heap[i] == place)
        return true;
    return false;
  }
  return (place < queue->oldest ? place + queue->depth : place) - queue->oldest < queue->started;
}

static void check_request(struct checker *checker, const struct trax_tm *tm, uint32_t place, struct wanted *wanted) {
  const struct trax_request *request = &tm->queue.requests[place];
  const struct trax_space *space = &checker->chip->machine->space;
  const unsigned tp = request->tp;
  if (!expect(checker,
              request->kind <= TRAX_REQUEST_ATOMIC && tp < tm->tps && request->rd <= TRAX_NO_REGISTER &&
                  request->icache < tm->icaches && request->bytes && request->bytes <= MOST_BYTES,
              "TM %u, request %u: kind %u of TP %u, register %u, instruction cache %u, %" PRIu32 " bytes", tm->number,
              place, request->kind, tp, request->rd, request->icache, request->bytes))
    return;
  if (is_started(&tm->queue, place))
    expect(checker, request->completion <= checker->farthest, "TM %u, request %u: completes in cycle %" PRIu64,
           tm->number, place, request->completion);
  switch ((trax_request_kind)request->kind) {
  case TRAX_REQUEST_INSTRUCTION_LINE:
    wanted->instruction_lines++;
    expect(checker,
           find_pending(&tm->icache[request->icache], request->line) < tm->icache[request->icache].pending_count,
           "TM %u, request %u: no TP waits for instruction line %" PRIu32, tm->number, place, request->line);
    break;
  case TRAX_REQUEST_DATA_LINE:
    wanted->data_lines++;
    expect(checker, find_mshr(&tm->dcache, request->line) < tm->dcache.mshr_count,
           "TM %u, request %u: no miss register has line %" PRIu32, tm->number, place, request->line);
    break;
  case TRAX_REQUEST_ATOMIC:
    expect(checker, request->address % 4 == 0 && trax_space_check(space, request->address, 4, true) == TRAX_FAULT_NONE,
           "TM %u, request %u: increments 0x%08" PRIx32, tm->number, place, request->address);
    wanted->increments[tp]++;
    wanted->registers[tp] |= (uint64_t)1 << request->rd;
    break;
  case TRAX_REQUEST_LOAD:
    wanted->registers[tp] |= (uint64_t)1 << request->rd;
    break;
  case TRAX_REQUEST_WRITE:
    wanted->writes[tp]++;
    break;
  }
}

static void check_heap(struct checker *checker, const struct trax_tm *tm) {
  const struct trax_queue *queue = &tm->queue;
  uint8_t seen[1 << TRAX_REQUEST_BITS] = {0};
  uint32_t taken = 0;
  for (uint32_t i = 0; i < queue->started; i++) {
    const uint32_t place = queue->heap[i];
    if (!expect(checker, place < queue->depth && !seen[place]++ && queue->requests[place].bytes,
                "TM %u, heap of requests, %" PRIu32 ": place %" PRIu32, tm->number, i, place))
      return;
    const struct trax_request *above = &queue->requests[queue->heap[i ? (i - 1) / 2 : 0]];
    expect(checker, above->completion <= queue->requests[place].completion,
           "TM %u, heap of requests, %" PRIu32 ": before the one above it", tm->number, i);
  }
  expect(checker, !queue->started || queue->oldest == queue->heap[0], "TM %u: the oldest request is %" PRIu32,
         tm->number, queue->oldest);
  for (uint32_t i = queue->count; i < queue->depth; i++) {
    const uint32_t place = queue->places[i];
    if (!expect(checker, place < queue->depth && !seen[place]++ && !queue->requests[place].bytes,
                "TM %u, free places, %" PRIu32 ": %" PRIu32, tm->number, i, place))
      return;
  }
  for (uint32_t i = 0; i < queue->depth; i++)
    taken += queue->requests[i].bytes != 0;
  expect(checker, taken == queue->count, "TM %u: %" PRIu32 " requests of %" PRIu32, tm->number, taken, queue->count);
  expect(checker, queue->first_unsubmitted == TRAX_NO_REQUEST, "TM %u: request %" PRIu32 " is fresh", tm->number,
         queue->first_unsubmitted);
}

static void check_queue(struct checker *checker, const struct trax_tm *tm, struct wanted *wanted) {
  const struct trax_queue *queue = &tm->queue;
  if (!expect(checker,
              queue->oldest < queue->depth && queue->count <= queue->depth && queue->started <= queue->count &&
                  (queue->heap || queue->submitted == queue->count),
              "TM %u, memory queue: %" PRIu32 " of %" PRIu32 " requests begun, %" PRIu32 " known, from %" PRIu32,
              tm->number, queue->started, queue->count, queue->submitted, queue->oldest))
    return;
  if (queue->heap)
    check_heap(checker, tm);
  for (uint32_t i = 0; i < queue->depth && !checker->failed; i++)
    if (trax_queue_is_taken(queue, i))
      check_request(checker, tm, i, wanted);
}

static void check_dcache(struct checker *checker, const struct trax_tm *tm, struct wanted *wanted) {
  const struct trax_dcache *dcache = &tm->dcache;
  check_tags(checker, &dcache->tags, "data cache");
  check_arbiters(checker, dcache->bank, TRAX_MAX_TPS_PER_TM, "bank of the data cache");
  for (unsigned i = 0; i < TRAX_MAX_TPS_PER_TM; i++)
    expect(checker, dcache->fills_end[i] <= dcache->all_fills_end && dcache->all_fills_end <= checker->farthest,
           "TM %u, bank %u of the data cache: filled up to cycle %" PRIu64, tm->number, i, dcache->fills_end[i]);
  if (!expect(checker, dcache->mshr_count <= dcache->mshr_limit && dcache->mshr_count == wanted->data_lines,
              "TM %u: %" PRIu32 " miss registers, %" PRIu32 " lines", tm->number, dcache->mshr_count,
              wanted->data_lines))
    return;
  for (uint32_t i = 0; i < dcache->mshr_count; i++) {
    const struct trax_mshr *mshr = &dcache->mshr[i];
    expect(checker, find_mshr(dcache, mshr->line) == i && mshr->passing <= 1,
           "TM %u, miss register %" PRIu32 ": line %" PRIu32 ", passing %u", tm->number, i, mshr->line, mshr->passing);
    for (uint32_t waiter = mshr->first_waiter; waiter != UINT16_MAX; waiter = dcache->next_waiter[waiter]) {
      const uint32_t tp = waiter / TRAX_NUM_REGISTERS;
      const uint64_t bit = (uint64_t)1 << waiter % TRAX_NUM_REGISTERS;
      if (!expect(checker, tp < tm->tps && !(wanted->registers[tp] & bit),
                  "TM %u, miss register %" PRIu32 ": %" PRIu32 " waits", tm->number, i, waiter))
        return;
      wanted->registers[tp] |= bit;
    }
  }
}

/* Returns the TPs that wait for lines of instructions. */
static uint64_t check_icaches(struct checker *checker, const struct trax_tm *tm, const struct wanted *wanted) {
  uint64_t waiting = 0;
  uint32_t lines = 0;
  for (uint32_t i = 0; i < tm->icaches; i++) {
    const struct trax_icache *icache = &tm->icache[i];
    const uint64_t group = trax_group_mask(i, tm->config->icache.tps_per_cache);
    check_tags(checker, &icache->tags, "instruction cache");
    check_arbiters(checker, icache->bank, 64, "bank of an instruction cache");
    if (!expect(checker, icache->pending_count <= tm->tps, "TM %u: %" PRIu32 " instruction lines are on their way",
                tm->number, icache->pending_count))
      return waiting;
    lines += icache->pending_count;
    for (uint32_t j = 0; j < icache->pending_count; j++) {
      const uint64_t who = icache->pending[j].waiting;
      expect(checker, find_pending(icache, icache->pending[j].line) == j && who && !(who & (waiting | ~group)),
             "TM %u, instruction line %" PRIu32 ": 0x%" PRIx64 " wait", tm->number, icache->pending[j].line, who);
      waiting |= who;
    }
  }
  expect(checker, lines == wanted->instruction_lines,
         "TM %u: %" PRIu32 " instruction lines are waited for, %" PRIu32 " requested", tm->number, lines,
         wanted->instruction_lines);
  return waiting;
}

/* Returns the TPs in the wheel. */
static uint64_t check_wheel(struct checker *checker, const struct trax_tm *tm) {
  uint64_t sleepers = 0;
  for (unsigned slot = 0; slot < TRAX_WHEEL; slot++) {
    const uint64_t who = tm->wheel[slot];
    expect(checker, (tm->wheel_occupied >> slot & 1) == (who != 0) && !(who & sleepers),
           "TM %u, alarms of slot %u: 0x%" PRIx64, tm->number, slot, who);
    sleepers |= who;
  }
  return sleepers;
}

static void check_tp(struct checker *checker, const struct trax_tm *tm, unsigned number, uint64_t fetching,
                     const struct wanted *wanted) {
  const struct trax_tp *tp = &tm->tp[number];
  const bool asleep = !(tm->awake >> number & 1);
  bool awaits = false;
  for (unsigned rd = 0; rd <= TRAX_NO_REGISTER; rd++) {
    const bool comes = wanted->registers[number] >> rd & 1, never = tp->usable[rd] == TRAX_NEVER;
    awaits |= never && rd < TRAX_NO_REGISTER;
    expect(checker,
           tp->usable_cause[rd] < TRAX_CAUSE_COUNT &&
               (rd == TRAX_NO_REGISTER || (never ? comes : is_soon(checker, tp->usable[rd]))),
           "TM %u, TP %u, r%u: usable from cycle %" PRIu64 ", cause %u", tm->number, number, rd, tp->usable[rd],
           tp->usable_cause[rd]);
  }
  expect(checker,
         !((tm->holding | fetching) >> number & 1) ||
             trax_text_at(checker->chip->text, tp->pc)->resource != TRAX_RESOURCE_NO_TEXT,
         "TM %u, TP %u: the instruction at 0x%08" PRIx32, tm->number, number, tp->pc);
  expect(checker, !(tm->awaiting >> number & 1) || awaits, "TM %u, TP %u: waits for nothing", tm->number, number);
  expect(checker, tp->run_end - tp->run_begin <= 64, "TM %u, TP %u: stores from 0x%" PRIx32 " to 0x%" PRIx32 " wait",
         tm->number, number, tp->run_begin, tp->run_end);
  expect(checker, tp->writes == wanted->writes[number] && tp->increments == wanted->increments[number],
         "TM %u, TP %u: %u writes and %u increments", tm->number, number, tp->writes, tp->increments);
  expect(checker,
         tp->asleep_cause < TRAX_CAUSE_COUNT && (!asleep || tp->asleep_since == checker->t) &&
             is_soon(checker, tp->asleep_until),
         "TM %u, TP %u: asleep from %" PRIu64 " to %" PRIu64 ", cause %u", tm->number, number, tp->asleep_since,
         tp->asleep_until, tp->asleep_cause);
  uint64_t charged = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    charged += tm->tp_stats[number].cycles[cause];
  expect(checker, charged == checker->t, "TM %u, TP %u: charged for %" PRIu64 " cycles", tm->number, number, charged);
}

static void check_units(struct checker *checker, const struct trax_tm *tm) {
  static const char *const names[] = {
#define NAME(X, ID, NAME, SIZE, COUNT, AREA, UNIT, ...) UNIT,
      TRAX_SHARED_UNITS(NAME, )
#undef NAME
  };
  for (unsigned i = 0; i < TRAX_SHARED_COUNT; i++) {
    const struct trax_shared_unit *unit = &tm->unit[i];
    check_arbiters(checker, unit->arbiter, 64, names[i]);
    for (size_t j = 0; j < trax_shared_unit_count(unit); j++)
      expect(checker, is_soon(checker, unit->free_from[j]), "TM %u, %s %zu: busy up to %" PRIu64, tm->number, names[i],
             j, unit->free_from[j]);
  }
}

static void check_tm(struct checker *checker, struct trax_tm *tm) {
  const uint64_t all = trax_group_mask(0, tm->tps), t = checker->t;
  struct wanted wanted = {0};
  check_queue(checker, tm, &wanted);
  if (checker->failed)
    return;
  check_dcache(checker, tm, &wanted);
  const uint64_t fetching = check_icaches(checker, tm, &wanted), alarmed = check_wheel(checker, tm);
  const uint64_t states[] = {tm->awake, tm->ended, tm->awaiting, fetching, alarmed};
  uint64_t any = 0;
  for (size_t i = 0; i < sizeof states / sizeof *states; i++) {
    expect(checker, !(states[i] & (any | ~all)), "TM %u: a TP is in two states, or there is none", tm->number);
    any |= states[i];
  }
  expect(checker,
         any == all && !(tm->holding & ~all) && tm->running == tm->tps - (uint32_t)__builtin_popcountll(tm->ended),
         "TM %u: %" PRIu32 " TPs run, 0x%" PRIx64 " have a state", tm->number, tm->running, any);
  expect(checker, !(tm->awaiting & ~tm->holding) && !(fetching & tm->holding), "TM %u: 0x%" PRIx64 " have instructions",
         tm->number, tm->holding);
  for (unsigned i = 0; i < tm->tps; i++)
    check_tp(checker, tm, i, fetching, &wanted);
  check_units(checker, tm);
  check_arbiters(checker, &tm->queue_arbiter, 1, "memory queue");
  expect(checker, tm->progressed <= t, "TM %u: the latest trap was before cycle %" PRIu64, tm->number, tm->progressed);
  expect(checker, tm->next_cycle <= (tm->awake ? t : trax_tm_next_cycle(tm, t - 1)),
         "TM %u: nothing happens before cycle %" PRIu64, tm->number, tm->next_cycle);
}

/* --- beyond the TMs --- */

/* Marks a request that waits. `lines`: a request of the second-level cache is allowed. */
static bool mark(struct checker *checker, trax_request_id id, bool lines, const char *which) {
  const struct trax_memory *memory = &checker->chip->memory;
  const uint32_t depth = checker->chip->tm->queue.depth;
  const uint32_t tm = id >> TRAX_REQUEST_BITS, place = id & ((1u << TRAX_REQUEST_BITS) - 1);
  uint8_t *listed = NULL;
  if (tm < checker->chip->tms && place < depth) {
    const struct trax_queue *queue = &checker->chip->tm[tm].queue;
    listed =
        trax_queue_is_taken(queue, place) && !is_started(queue, place) ? &checker->listed[tm * depth + place] : NULL;
  } else if (lines && tm == TRAX_MAX_TMS && memory->l2 && place < memory->l2->mshr_limit) {
    listed = &checker->lines_listed[place];
  }
  if (!expect(checker, listed && !*listed, "%s: request 0x%" PRIx32, which, id))
    return false;
  *listed = 1;
  return true;
}

/* Checks a list of waiting requests, marks each, and returns their number. `lines`: requests of the second-level cache
   are allowed. */
static uint32_t check_list(struct checker *checker, const struct trax_request_list *list, bool lines,
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
  expect(checker, last == list->last, "%s: the last request is 0x%" PRIx32, which, list->last);
  return count;
}

/* Returns the number of waiting requests. */
static uint32_t check_waiting(struct checker *checker, const struct trax_waiting *waiting, const char *which) {
  uint32_t count = 0;
  check_arbiters(checker, &waiting->arbiter, 1, which);
  for (unsigned tm = 0; tm < TRAX_MAX_TMS && !checker->failed; tm++) {
    const struct trax_request_list *list = &waiting->list[tm];
    expect(checker, (waiting->tms >> tm & 1) == (list->first != TRAX_NO_REQUEST), "%s: 0x%" PRIx64 " wait", which,
           waiting->tms);
    count += check_list(checker, list, false, which);
  }
  return count;
}

static void check_l2(struct checker *checker, const struct trax_l2 *l2) {
  uint8_t seen[1 << TRAX_REQUEST_BITS] = {0};
  uint32_t waiting = 0;
  uint64_t next_arrival = TRAX_NEVER;
  check_tags(checker, &l2->tags, "second-level cache");
  expect(checker, l2->used_count <= l2->mshr_limit, "second-level cache: %" PRIu32 " lines are on their way",
         l2->used_count);
  for (uint32_t i = 0; i < l2->mshr_limit && !checker->failed; i++)
    expect(checker, l2->used[i] < l2->mshr_limit && !seen[l2->used[i]]++,
           "second-level cache: miss register %u is %" PRIu32, l2->used[i], i);
  for (uint32_t i = 0; i < l2->banks && !checker->failed; i++)
    waiting += check_waiting(checker, &l2->bank[i], "bank of the second-level cache");
  expect(checker, waiting == l2->waiting, "second-level cache: %" PRIu32 " of %" PRIu32 " wait", waiting, l2->waiting);
  for (unsigned i = 0; i < TRAX_MAX_CHANNELS && !checker->failed; i++) {
    const trax_request_id first = l2->arriving[i].first;
    check_list(checker, &l2->arriving[i], true, "coming line");
    if (!checker->failed && first != TRAX_NO_REQUEST &&
        expect(checker, first >= TRAX_LINE_REQUEST, "coming line: request 0x%" PRIx32, first)) {
      const uint64_t arrival = l2->mshr[first - TRAX_LINE_REQUEST].arrival;
      next_arrival = arrival < next_arrival ? arrival : next_arrival;
    }
  }
  expect(checker, l2->next_arrival == next_arrival, "second-level cache: the next line comes in %" PRIu64,
         l2->next_arrival);
  for (uint32_t i = 0; i < l2->used_count && !checker->failed; i++) {
    const struct trax_l2_mshr *mshr = &l2->mshr[l2->used[i]];
    for (uint32_t j = 0; j < i; j++)
      expect(checker, l2->line[j] != l2->line[i], "second-level cache: line %" PRIu32 " comes twice", l2->line[i]);
    expect(checker,
           l2->line[i] == trax_line_of(&l2->tags, mshr->request.address) && mshr->request.bytes == l2->line_cost &&
               mshr->request.kind == TRAX_REQUEST_DATA_LINE &&
               (mshr->arrival == TRAX_NEVER ||
                (mshr->arrival <= checker->farthest && mshr->waiters.first == TRAX_NO_REQUEST)),
           "second-level cache, line %" PRIu32 ": arrives in %" PRIu64, l2->line[i], mshr->arrival);
    check_list(checker, &mshr->waiters, false, "line of the second-level cache");
  }
}

/* Checks that arriving lines have an arrival, that each used miss register is in one list, and that free ones are in
 * none.
 */
static void check_lines_listed(struct checker *checker, const struct trax_l2 *l2) {
  for (uint32_t i = 0; i < l2->mshr_limit; i++)
    expect(checker, checker->lines_listed[l2->used[i]] == (i < l2->used_count),
           "second-level cache: miss register %u is in no list, or without a line", l2->used[i]);
  for (unsigned i = 0; i < TRAX_MAX_CHANNELS; i++)
    for (trax_request_id id = l2->arriving[i].first; id != TRAX_NO_REQUEST;) { /* check_list has checked the ids */
      if (!expect(checker, id >= TRAX_LINE_REQUEST && l2->mshr[id - TRAX_LINE_REQUEST].arrival != TRAX_NEVER,
                  "coming line: request 0x%" PRIx32, id))
        return;
      id = l2->mshr[id - TRAX_LINE_REQUEST].request.next;
    }
}

/* The requests that the machine can have. */
static uint64_t most_requests(const struct trax_chip *chip) {
  uint64_t requests = chip->memory.l2 ? chip->memory.l2->mshr_limit : 0;
  for (uint32_t i = 0; i < chip->tms; i++)
    requests += chip->tm[i].queue.depth;
  return requests;
}

/* Returns the number of requests in the queues of a channel's DRAM, and marks each. */
static uint32_t check_dram(struct checker *checker, uint32_t number) {
  const struct trax_dram *dram = checker->chip->memory.dram;
  const struct trax_dram_channel *channel = &dram->channel[number];
  uint32_t count = 0;
  if (!expect(checker, trax_dram_check(dram, number, checker->t, most_requests(checker->chip)),
              "channel %" PRIu32 ": the state of its DRAM", number))
    return count;
  for (unsigned queue = 0; queue < TRAX_DRAM_QUEUES; queue++)
    for (uint32_t i = 0; i < channel->count[queue]; i++, count++)
      if (!mark(checker, channel->request[queue][i].id, true, "queue of the DRAM"))
        return count;
  return count;
}

static void check_memory(struct checker *checker) {
  const struct trax_memory *memory = &checker->chip->memory;
  const uint32_t depth = checker->chip->tm->queue.depth;
  uint32_t waiting = 0;
  check_arbiters(checker, &memory->arbiter, 1, "memory controller");
  for (uint32_t i = 0; i < memory->channels && !checker->failed; i++) {
    const struct trax_channel *channel = &memory->channel[i];
    expect(checker, channel->free_from.units < memory->units_per_cycle && channel->free_from.cycle <= checker->farthest,
           "channel %" PRIu32 ": free from cycle %" PRIu64 " and %" PRIu64, i, channel->free_from.cycle,
           channel->free_from.units);
    waiting += check_list(checker, &channel->passed, true, "channel");
    if (channel->waiting && !checker->failed)
      waiting += check_waiting(checker, channel->waiting, "channel");
    if (memory->dram && !checker->failed)
      waiting += check_dram(checker, i);
    expect(checker, channel->unit_free_from <= checker->farthest, "channel %" PRIu32 ": increments from cycle %" PRIu64,
           i, channel->unit_free_from);
  }
  expect(checker, waiting == memory->waiting, "memory controller: %" PRIu32 " of %" PRIu32 " wait", waiting,
         memory->waiting);
  if (memory->l2 && !checker->failed)
    check_l2(checker, memory->l2);
  if (memory->l2 && !checker->failed)
    check_lines_listed(checker, memory->l2);
  for (uint32_t tm = 0; tm < TRAX_MAX_TMS && !checker->failed; tm++) {
    const struct trax_queue *queue = tm < checker->chip->tms ? &checker->chip->tm[tm].queue : NULL;
    const bool waits = memory->keeps_order && queue && queue->started < queue->submitted;
    expect(checker, (memory->tms >> tm & 1) == waits, "memory controller: 0x%" PRIx64 " wait", memory->tms);
    for (uint32_t place = 0; queue && queue->heap && place < depth; place++)
      expect(checker,
             checker->listed[tm * depth + place] == (trax_queue_is_taken(queue, place) && !is_started(queue, place)),
             "TM %u, request %" PRIu32 ": waits in no list", tm, place);
  }
}

/* Returns a cycle in which all transfers must be over, if they were made one after the other. */
static uint64_t farthest_cycle(const struct trax_chip *chip, uint64_t t) {
  const struct trax_memory *memory = &chip->memory;
  const uint64_t requests = most_requests(chip);
  const uint64_t transfer = memory->dram ? trax_dram_cycles(memory->dram, trax_dram_most_ticks(memory->dram))
                                         : MOST_BYTES * memory->units_per_byte / memory->units_per_cycle;
  return t + MEMORY_LATENCIES + requests * (transfer + memory->unit_interval + 1);
}

const char *trax_state_check(void *state, uint64_t t, char text[128]) {
  struct trax_chip *chip = state;
  const size_t requests = (size_t)chip->tms * chip->tm->queue.depth;
  struct checker checker = {
      .chip = chip, .t = t, .farthest = farthest_cycle(chip, t), .text = text, .listed = calloc(requests, 1)};
  checker.lines_listed = calloc(1 << TRAX_REQUEST_BITS, 1);
  if (expect(&checker, checker.listed && checker.lines_listed, "out of memory") &&
      expect(&checker, t > 0 && t < LAST_CYCLE, "it is before cycle %" PRIu64, t)) {
    for (uint32_t i = 0; i < chip->tms; i++)
      check_tm(&checker, &chip->tm[i]);
    if (!checker.failed)
      check_memory(&checker);
  }
  free(checker.listed);
  free(checker.lines_listed);
  return checker.failed ? text : NULL;
}
