/* Checks a TM of a state that was read from a file. */
#include "fast/state_check.h"

#include <inttypes.h>

#define UNIT_LATENCIES 65536u /* cycles; more than the latencies of units and caches together */

/* Whether a cycle is in reach of the latencies of units and caches. */
static bool is_soon(const struct trax_state_checker *checker, uint64_t cycle) {
  return cycle <= checker->t + UNIT_LATENCIES;
}

/* What the requests in a TM's queue are for. */
struct wanted {
  uint32_t data_lines, instruction_lines;
  uint8_t data_line[1 << TRAX_REQUEST_BITS];      /* by miss register: whether its line is requested */
  uint64_t instruction_line[TRAX_MAX_TPS_PER_TM]; /* by cache: mask of its pending lines that are requested */
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

/* Each pending line has one request, and each request a pending line: an arrival finds the line that it is for. */
static void want_instruction_line(struct trax_state_checker *checker, const struct trax_tm *tm,
                                  const struct trax_request *request, uint32_t place, struct wanted *wanted) {
  const struct trax_icache *icache = &tm->icache[request->icache];
  uint64_t *lines = &wanted->instruction_line[request->icache];
  const uint32_t i = find_pending(icache, request->line);
  wanted->instruction_lines++;
  if (trax_state_expect(checker, i < icache->pending_count && !(*lines >> i & 1),
                        "TM %u, request %u: no TP waits for instruction line %" PRIu32, tm->number, place,
                        request->line))
    *lines |= (uint64_t)1 << i;
}

/* The same for miss registers. */
static void want_data_line(struct trax_state_checker *checker, const struct trax_tm *tm,
                           const struct trax_request *request, uint32_t place, struct wanted *wanted) {
  const uint32_t i = find_mshr(&tm->dcache, request->line);
  wanted->data_lines++;
  if (trax_state_expect(checker, i < tm->dcache.mshr_count && !wanted->data_line[i],
                        "TM %u, request %u: no miss register has line %" PRIu32, tm->number, place, request->line))
    wanted->data_line[i] = 1;
}

static void check_request(struct trax_state_checker *checker, const struct trax_tm *tm, uint32_t place,
                          struct wanted *wanted) {
  const struct trax_request *request = &tm->queue.requests[place];
  const struct trax_space *space = &checker->chip->machine->space;
  const unsigned tp = request->tp;
  if (!trax_state_expect(checker,
                         request->kind <= TRAX_REQUEST_ATOMIC && tp < tm->tps && request->rd <= TRAX_NO_REGISTER &&
                             request->icache < tm->icaches && request->bytes && request->bytes <= TRAX_STATE_MOST_BYTES,
                         "TM %u, request %u: kind %u of TP %u, register %u, instruction cache %u, %" PRIu32 " bytes",
                         tm->number, place, request->kind, tp, request->rd, request->icache, request->bytes))
    return;
  if (trax_queue_is_started(&tm->queue, place))
    trax_state_expect(checker, request->completion <= checker->farthest,
                      "TM %u, request %u: completes in cycle %" PRIu64, tm->number, place, request->completion);
  switch ((trax_request_kind)request->kind) {
  case TRAX_REQUEST_INSTRUCTION_LINE:
    want_instruction_line(checker, tm, request, place, wanted);
    break;
  case TRAX_REQUEST_DATA_LINE:
    want_data_line(checker, tm, request, place, wanted);
    break;
  case TRAX_REQUEST_ATOMIC:
    trax_state_expect(
        checker, request->address % 4 == 0 && trax_space_check(space, request->address, 4, true) == TRAX_FAULT_NONE,
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

static void check_heap(struct trax_state_checker *checker, const struct trax_tm *tm) {
  const struct trax_queue *queue = &tm->queue;
  uint8_t seen[1 << TRAX_REQUEST_BITS] = {0};
  uint32_t taken = 0;
  for (uint32_t i = 0; i < queue->started; i++) {
    const uint32_t place = queue->heap[i];
    if (!trax_state_expect(checker, place < queue->depth && !seen[place]++ && queue->requests[place].bytes,
                           "TM %u, heap of requests, %" PRIu32 ": place %" PRIu32, tm->number, i, place))
      return;
    const struct trax_request *above = &queue->requests[queue->heap[i ? (i - 1) / 2 : 0]];
    trax_state_expect(checker, above->completion <= queue->requests[place].completion,
                      "TM %u, heap of requests, %" PRIu32 ": before the one above it", tm->number, i);
  }
  trax_state_expect(checker, !queue->started || queue->oldest == queue->heap[0],
                    "TM %u: the oldest request is %" PRIu32, tm->number, queue->oldest);
  for (uint32_t i = queue->count; i < queue->depth; i++) {
    const uint32_t place = queue->places[i];
    if (!trax_state_expect(checker, place < queue->depth && !seen[place]++ && !queue->requests[place].bytes,
                           "TM %u, free places, %" PRIu32 ": %" PRIu32, tm->number, i, place))
      return;
  }
  for (uint32_t i = 0; i < queue->depth; i++)
    taken += queue->requests[i].bytes != 0;
  trax_state_expect(checker, taken == queue->count, "TM %u: %" PRIu32 " requests of %" PRIu32, tm->number, taken,
                    queue->count);
  trax_state_expect(checker, queue->first_unsubmitted == TRAX_NO_REQUEST, "TM %u: request %" PRIu32 " is fresh",
                    tm->number, queue->first_unsubmitted);
}

static void check_queue(struct trax_state_checker *checker, const struct trax_tm *tm, struct wanted *wanted) {
  const struct trax_queue *queue = &tm->queue;
  if (!trax_state_expect(checker,
                         queue->oldest < queue->depth && queue->count <= queue->depth &&
                             queue->started <= queue->count && (queue->heap || queue->submitted == queue->count),
                         "TM %u, memory queue: %" PRIu32 " of %" PRIu32 " requests begun, %" PRIu32
                         " known, from %" PRIu32,
                         tm->number, queue->started, queue->count, queue->submitted, queue->oldest))
    return;
  if (queue->heap)
    check_heap(checker, tm);
  for (uint32_t i = 0; i < queue->depth && !checker->failed; i++)
    if (trax_queue_is_taken(queue, i))
      check_request(checker, tm, i, wanted);
}

static void check_dcache(struct trax_state_checker *checker, const struct trax_tm *tm, struct wanted *wanted) {
  const struct trax_dcache *dcache = &tm->dcache;
  trax_state_check_tags(checker, &dcache->tags, "data cache");
  trax_state_check_arbiters(checker, dcache->bank, TRAX_MAX_TPS_PER_TM, "bank of the data cache");
  for (unsigned i = 0; i < TRAX_MAX_TPS_PER_TM; i++)
    trax_state_expect(
        checker, dcache->fills_end[i] <= dcache->all_fills_end && dcache->all_fills_end <= checker->farthest,
        "TM %u, bank %u of the data cache: filled up to cycle %" PRIu64, tm->number, i, dcache->fills_end[i]);
  if (!trax_state_expect(checker, dcache->mshr_count == wanted->data_lines,
                         "TM %u: %" PRIu32 " miss registers, %" PRIu32 " lines", tm->number, dcache->mshr_count,
                         wanted->data_lines))
    return;
  for (uint32_t i = 0; i < dcache->mshr_count; i++) {
    const struct trax_mshr *mshr = &dcache->mshr[i];
    trax_state_expect(checker, find_mshr(dcache, mshr->line) == i && mshr->passing <= 1,
                      "TM %u, miss register %" PRIu32 ": line %" PRIu32 ", passing %u", tm->number, i, mshr->line,
                      mshr->passing);
    for (uint32_t waiter = mshr->first_waiter; waiter != UINT16_MAX; waiter = dcache->next_waiter[waiter]) {
      const uint32_t tp = waiter / TRAX_NUM_REGISTERS;
      const uint64_t bit = (uint64_t)1 << waiter % TRAX_NUM_REGISTERS;
      if (!trax_state_expect(checker, tp < tm->tps && !(wanted->registers[tp] & bit),
                             "TM %u, miss register %" PRIu32 ": %" PRIu32 " waits", tm->number, i, waiter))
        return;
      wanted->registers[tp] |= bit;
    }
  }
}

/* Returns the TPs that wait for lines of instructions. */
static uint64_t check_icaches(struct trax_state_checker *checker, const struct trax_tm *tm,
                              const struct wanted *wanted) {
  uint64_t waiting = 0;
  uint32_t lines = 0;
  for (uint32_t i = 0; i < tm->icaches; i++) {
    const struct trax_icache *icache = &tm->icache[i];
    const uint64_t group = trax_group_mask(i, tm->config->icache.tps_per_cache);
    trax_state_check_tags(checker, &icache->tags, "instruction cache");
    trax_state_check_arbiters(checker, icache->bank, 64, "bank of an instruction cache");
    lines += icache->pending_count;
    for (uint32_t j = 0; j < icache->pending_count; j++) {
      const uint64_t who = icache->pending[j].waiting;
      trax_state_expect(
          checker, find_pending(icache, icache->pending[j].line) == j && who && !(who & (waiting | ~group)),
          "TM %u, instruction line %" PRIu32 ": 0x%" PRIx64 " wait", tm->number, icache->pending[j].line, who);
      waiting |= who;
    }
  }
  trax_state_expect(checker, lines == wanted->instruction_lines,
                    "TM %u: %" PRIu32 " instruction lines are waited for, %" PRIu32 " requested", tm->number, lines,
                    wanted->instruction_lines);
  return waiting;
}

/* Returns the TPs in the wheel. */
static uint64_t check_wheel(struct trax_state_checker *checker, const struct trax_tm *tm) {
  uint64_t sleepers = 0;
  for (unsigned slot = 0; slot < TRAX_WHEEL; slot++) {
    const uint64_t who = tm->wheel[slot];
    trax_state_expect(checker, (tm->wheel_occupied >> slot & 1) == (who != 0) && !(who & sleepers),
                      "TM %u, alarms of slot %u: 0x%" PRIx64, tm->number, slot, who);
    sleepers |= who;
  }
  return sleepers;
}

static void check_tp(struct trax_state_checker *checker, const struct trax_tm *tm, unsigned number, uint64_t fetching,
                     const struct wanted *wanted) {
  const struct trax_tp *tp = &tm->tp[number];
  const bool asleep = !(tm->awake >> number & 1);
  bool awaits = false;
  for (unsigned rd = 0; rd <= TRAX_NO_REGISTER; rd++) {
    const bool comes = wanted->registers[number] >> rd & 1, never = tp->usable[rd] == TRAX_NEVER;
    awaits |= never && rd < TRAX_NO_REGISTER;
    trax_state_expect(checker,
                      tp->usable_cause[rd] < TRAX_CAUSE_COUNT &&
                          (rd == TRAX_NO_REGISTER || (never ? comes : is_soon(checker, tp->usable[rd]))),
                      "TM %u, TP %u, r%u: usable from cycle %" PRIu64 ", cause %u", tm->number, number, rd,
                      tp->usable[rd], tp->usable_cause[rd]);
  }
  trax_state_expect(checker,
                    !((tm->holding | fetching) >> number & 1) ||
                        trax_text_at(checker->chip->text, tp->pc)->resource != TRAX_RESOURCE_NO_TEXT,
                    "TM %u, TP %u: the instruction at 0x%08" PRIx32, tm->number, number, tp->pc);
  trax_state_expect(checker, !(tm->awaiting >> number & 1) || awaits, "TM %u, TP %u: waits for nothing", tm->number,
                    number);
  trax_state_expect(checker, tp->run_end - tp->run_begin <= 64,
                    "TM %u, TP %u: stores from 0x%" PRIx32 " to 0x%" PRIx32 " wait", tm->number, number, tp->run_begin,
                    tp->run_end);
  trax_state_expect(checker, tp->writes == wanted->writes[number] && tp->increments == wanted->increments[number],
                    "TM %u, TP %u: %u writes and %u increments", tm->number, number, tp->writes, tp->increments);
  trax_state_expect(checker,
                    tp->asleep_cause < TRAX_CAUSE_COUNT && (!asleep || tp->asleep_since == checker->t) &&
                        is_soon(checker, tp->asleep_until),
                    "TM %u, TP %u: asleep from %" PRIu64 " to %" PRIu64 ", cause %u", tm->number, number,
                    tp->asleep_since, tp->asleep_until, tp->asleep_cause);
  uint64_t charged = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    charged += tm->tp_stats[number].cycles[cause];
  trax_state_expect(checker, charged == checker->t, "TM %u, TP %u: charged for %" PRIu64 " cycles", tm->number, number,
                    charged);
}

static void check_units(struct trax_state_checker *checker, const struct trax_tm *tm) {
  static const char *const names[] = {
#define NAME(X, ID, NAME, SIZE, COUNT, AREA, UNIT, ...) UNIT,
      TRAX_SHARED_UNITS(NAME, )
#undef NAME
  };
  for (unsigned i = 0; i < TRAX_SHARED_COUNT; i++) {
    const struct trax_shared_unit *unit = &tm->unit[i];
    trax_state_check_arbiters(checker, unit->arbiter, 64, names[i]);
    for (size_t j = 0; j < trax_shared_unit_count(unit); j++)
      trax_state_expect(checker, is_soon(checker, unit->free_from[j]), "TM %u, %s %zu: busy up to %" PRIu64, tm->number,
                        names[i], j, unit->free_from[j]);
  }
}

/* The lines on their way fit their arrays, which the checks of the requests search. */
static void check_line_counts(struct trax_state_checker *checker, const struct trax_tm *tm) {
  trax_state_expect(checker, tm->dcache.mshr_count <= tm->dcache.mshr_limit, "TM %u: %" PRIu32 " miss registers",
                    tm->number, tm->dcache.mshr_count);
  for (uint32_t i = 0; i < tm->icaches; i++)
    trax_state_expect(checker, tm->icache[i].pending_count <= tm->tps,
                      "TM %u: %" PRIu32 " instruction lines are on their way", tm->number, tm->icache[i].pending_count);
}

void trax_state_check_tm(struct trax_state_checker *checker, struct trax_tm *tm) {
  const uint64_t all = trax_group_mask(0, tm->tps), t = checker->t;
  struct wanted wanted = {0};
  check_line_counts(checker, tm);
  if (!checker->failed)
    check_queue(checker, tm, &wanted);
  if (checker->failed)
    return;
  check_dcache(checker, tm, &wanted);
  const uint64_t fetching = check_icaches(checker, tm, &wanted), alarmed = check_wheel(checker, tm);
  const uint64_t states[] = {tm->awake, tm->ended, tm->awaiting, fetching, alarmed};
  uint64_t any = 0;
  for (size_t i = 0; i < sizeof states / sizeof *states; i++) {
    trax_state_expect(checker, !(states[i] & (any | ~all)), "TM %u: a TP is in two states, or there is none",
                      tm->number);
    any |= states[i];
  }
  trax_state_expect(checker,
                    any == all && !(tm->holding & ~all) &&
                        tm->running == tm->tps - (uint32_t)__builtin_popcountll(tm->ended),
                    "TM %u: %" PRIu32 " TPs run, 0x%" PRIx64 " have a state", tm->number, tm->running, any);
  trax_state_expect(checker, !(tm->awaiting & ~tm->holding) && !(fetching & tm->holding),
                    "TM %u: 0x%" PRIx64 " have instructions", tm->number, tm->holding);
  for (unsigned i = 0; i < tm->tps; i++)
    check_tp(checker, tm, i, fetching, &wanted);
  check_units(checker, tm);
  trax_state_check_arbiters(checker, &tm->queue_arbiter, 1, "memory queue");
  trax_state_expect(checker, tm->progressed <= t, "TM %u: the latest trap was before cycle %" PRIu64, tm->number,
                    tm->progressed);
  trax_state_expect(checker, tm->next_cycle <= (tm->awake ? t : trax_tm_next_cycle(tm, t - 1)),
                    "TM %u: nothing happens before cycle %" PRIu64, tm->number, tm->next_cycle);
}
