/* Checks a state that was read from a file (trax_state_check), which may be forged: indices are within their arrays, an
   element is in one list at most, a TP in one state. With anything else that is wrong, the run stays within arrays. */
#include "fast/chip.h"

#include "fast/memory/l2.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>

#define LAST_CYCLE ((uint64_t)1 << 62)
#define MOST_BYTES 4096u /* limit of a transfer */

struct checker {
  const struct trax_chip *chip;
  uint64_t t;
  char *text; /* [128] */
  bool failed;
  /* [tm * depth + place], then [miss register of the second-level cache]: whether the request is in a list. */
  uint8_t *listed;
};

/* If something is wrong for the first time, writes the reason. Returns `good`. */
static __attribute__((format(printf, 3, 4))) bool expect(struct checker *checker, bool good, const char *format, ...) {
  if (good || checker->failed)
    return good;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(checker->text, 128, format, arguments);
  va_end(arguments);
  checker->failed = true;
  return false;
}

/* Checks that sums of cycles do not overflow. */
static void check_cycle(struct checker *checker, uint64_t cycle, const char *which) {
  expect(checker, cycle < LAST_CYCLE, "%s: cycle %" PRIu64, which, cycle);
}

/* --- lists of requests --- */

enum { OF_TMS = 1, OF_L2 = 2 /* whose requests a list may have; OF_L2 alone: lines with an arrival */ };

static uint8_t *lines_listed(const struct checker *checker) {
  return checker->listed + (size_t)checker->chip->tms * checker->chip->tm->queue.depth;
}

/* Marks a request that waits. */
static bool mark(struct checker *checker, trax_request_id id, unsigned whose, const char *which) {
  const struct trax_chip *chip = checker->chip;
  const uint32_t depth = chip->tm->queue.depth;
  const uint32_t tm = id >> TRAX_REQUEST_BITS, place = id & ((1u << TRAX_REQUEST_BITS) - 1);
  uint8_t *listed = NULL;
  if (whose & OF_TMS && tm < chip->tms && place < depth && chip->tm[tm].queue.requests[place].bytes &&
      !chip->tm[tm].queue.requests[place].completion)
    listed = &checker->listed[tm * depth + place];
  else if (whose & OF_L2 && tm == TRAX_MAX_TMS && chip->memory.l2 && place < chip->memory.l2->mshr_limit &&
           (whose != OF_L2 || chip->memory.l2->mshr[place].arrival != TRAX_NEVER))
    listed = &lines_listed(checker)[place];
  if (!expect(checker, listed && !*listed, "%s: request 0x%" PRIx32, which, id))
    return false;
  *listed = 1;
  return true;
}

static void check_list(struct checker *checker, const struct trax_request_list *list, unsigned whose,
                       const char *which) {
  trax_request_id id = list->first;
  while (id != TRAX_NO_REQUEST && mark(checker, id, whose, which))
    id = trax_memory_request(&checker->chip->memory, checker->chip->tm, id)->next;
}

static void check_waiting(struct checker *checker, const struct trax_waiting *waiting, unsigned whose,
                          const char *which) {
  for (unsigned tm = 0; tm < TRAX_MAX_TMS; tm++)
    check_list(checker, &waiting->list[tm], whose, which);
}

/* --- memory --- */

static void check_l2(struct checker *checker, const struct trax_l2 *l2) {
  for (uint32_t i = 0; i < l2->banks; i++)
    check_waiting(checker, &l2->bank[i], OF_TMS, "bank of the second-level cache");
  for (unsigned i = 0; i < TRAX_MAX_CHANNELS; i++)
    check_list(checker, &l2->arriving[i], OF_L2, "coming line");
  for (uint32_t i = 0; i < l2->mshr_limit && !checker->failed; i++) {
    const struct trax_l2_mshr *mshr = &l2->mshr[i];
    const uint32_t bytes = mshr->request.bytes;
    expect(checker, bytes ? bytes == l2->line_cost && lines_listed(checker)[i] : !lines_listed(checker)[i],
           "second-level cache: miss register %" PRIu32 " is in no list, or without a line", i);
    if (!bytes)
      continue;
    expect(checker, mshr->request.kind == TRAX_REQUEST_DATA_LINE,
           "second-level cache: the request for line %" PRIu32 " is none", i);
    check_cycle(checker, mshr->arrival == TRAX_NEVER ? 0 : mshr->arrival, "line of the second-level cache");
    check_list(checker, &mshr->waiters, OF_TMS, "line of the second-level cache");
  }
}

/* The requests that the machine can have. */
static uint64_t most_requests(const struct trax_chip *chip) {
  return (uint64_t)chip->tms * chip->tm->queue.depth + (chip->memory.l2 ? chip->memory.l2->mshr_limit : 0);
}

static void check_dram(struct checker *checker, uint32_t number) {
  const struct trax_dram *dram = checker->chip->memory.dram;
  const struct trax_dram_channel *channel = &dram->channel[number];
  if (expect(checker, trax_dram_check(dram, number, checker->t, most_requests(checker->chip)),
             "channel %" PRIu32 ": the state of its DRAM", number))
    for (unsigned queue = 0; queue < TRAX_DRAM_QUEUES; queue++)
      for (uint32_t i = 0; i < channel->count[queue]; i++)
        mark(checker, channel->request[queue][i].id, OF_TMS | OF_L2, "queue of the DRAM");
}

static void check_memory(struct checker *checker) {
  const struct trax_memory *memory = &checker->chip->memory;
  for (uint32_t i = 0; i < memory->channels; i++) {
    check_cycle(checker, memory->channel[i].free_from.cycle, "channel");
    check_cycle(checker, memory->channel[i].unit_free_from, "increment unit");
    check_waiting(checker, &memory->channel[i].waiting, OF_TMS | OF_L2, "channel");
    if (memory->dram)
      check_dram(checker, i);
  }
  if (memory->l2)
    check_l2(checker, memory->l2);
}

/* --- a TM --- */

static void check_queue(struct checker *checker, const struct trax_tm *tm) {
  const struct trax_queue *queue = &tm->queue;
  for (uint32_t i = 0; i < queue->depth && !checker->failed; i++) {
    const struct trax_request *request = &queue->requests[i];
    if (!queue->requests[i].bytes)
      continue;
    expect(checker,
           request->kind <= TRAX_REQUEST_ATOMIC && request->tp < tm->tps && request->rd <= TRAX_NO_REGISTER &&
               request->icache < tm->icaches && request->bytes && request->bytes <= MOST_BYTES,
           "TM %u, request %u: kind %u of TP %u, register %u, instruction cache %u, %" PRIu32 " bytes", tm->number, i,
           request->kind, request->tp, request->rd, request->icache, request->bytes);
    check_cycle(checker, queue->requests[i].completion ? request->completion : 0, "request");
    expect(checker,
           request->kind != TRAX_REQUEST_ATOMIC ||
               (request->address % 4 == 0 &&
                trax_space_check(&checker->chip->machine->space, request->address, 4, true) == TRAX_FAULT_NONE),
           "TM %u, request %u: increments 0x%08" PRIx32, tm->number, i, request->address);
  }
}

static void check_dcache(struct checker *checker, const struct trax_tm *tm) {
  const struct trax_dcache *dcache = &tm->dcache;
  const uint32_t waiters = tm->tps * TRAX_NUM_REGISTERS;
  expect(checker, dcache->mshr_count <= dcache->mshr_limit, "TM %u: %" PRIu32 " miss registers", tm->number,
         dcache->mshr_count);
  for (uint32_t i = 0; i < dcache->mshr_count && !checker->failed; i++)
    expect(checker, dcache->mshr[i].first_waiter < waiters || dcache->mshr[i].first_waiter == UINT16_MAX,
           "TM %u, miss register %" PRIu32 ": %u waits", tm->number, i, dcache->mshr[i].first_waiter);
  for (unsigned i = 0; i < TRAX_MAX_TPS_PER_TM; i++)
    check_cycle(checker, dcache->fills_end[i], "bank of the data cache");
  for (uint32_t i = 0; i < waiters; i++)
    expect(checker, dcache->next_waiter[i] < waiters || dcache->next_waiter[i] == UINT16_MAX,
           "TM %u: %u waits after %" PRIu32, tm->number, dcache->next_waiter[i], i);
}

/* Each TP is awake, ended, in the wheel, or waits for data or for one line of instructions. */
static void check_states(struct checker *checker, const struct trax_tm *tm) {
  const uint64_t all = trax_group_mask(0, tm->tps);
  uint64_t any = tm->awake, fetching = 0;
  bool good = !(tm->holding & ~all);
#define ADD(MASK) (good &= !((MASK) & any), any |= (MASK))
  ADD(tm->ended);
  ADD(tm->awaiting);
  for (unsigned slot = 0; slot < TRAX_WHEEL; slot++)
    ADD(tm->wheel[slot]);
  for (uint32_t i = 0; i < tm->icaches; i++) {
    const struct trax_icache *icache = &tm->icache[i];
    good &= icache->pending_count <= tm->tps;
    for (uint32_t j = 0; good && j < icache->pending_count; j++) {
      good &= icache->pending[j].waiting != 0;
      ADD(icache->pending[j].waiting);
      fetching |= icache->pending[j].waiting;
    }
  }
#undef ADD
  expect(checker, good && any == all, "TM %u: a TP is in two states or in none", tm->number);
  for (unsigned i = 0; i < tm->tps; i++)
    expect(checker,
           !((tm->holding | fetching) >> i & 1) ||
               trax_text_at(checker->chip->text, tm->tp[i].pc)->resource != TRAX_RESOURCE_NO_TEXT,
           "TM %u, TP %u: the instruction at 0x%08" PRIx32, tm->number, i, tm->tp[i].pc);
}

static void check_tp(struct checker *checker, const struct trax_tm *tm, unsigned number) {
  const struct trax_tp *tp = &tm->tp[number];
  uint64_t charged = tm->awake >> number & 1 ? 0 : checker->t - tp->asleep_since;
  for (unsigned rd = 0; rd <= TRAX_NO_REGISTER; rd++) {
    check_cycle(checker, tp->usable[rd] == TRAX_NEVER ? 0 : tp->usable[rd], "register");
    expect(checker, tp->usable_cause[rd] < TRAX_CAUSE_COUNT, "TM %u, TP %u, r%u: cause %u", tm->number, number, rd,
           tp->usable_cause[rd]);
  }
  check_cycle(checker, tp->asleep_until, "alarm");
  expect(checker, tp->asleep_cause < TRAX_CAUSE_COUNT, "TM %u, TP %u: asleep, cause %u", tm->number, number,
         tp->asleep_cause);
  expect(checker, tp->run_end - tp->run_begin <= 64, "TM %u, TP %u: stores from 0x%" PRIx32 " to 0x%" PRIx32 " wait",
         tm->number, number, tp->run_begin, tp->run_end);
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    charged += tm->tp_stats[number].cycles[cause];
  expect(checker, charged == checker->t, "TM %u, TP %u: charged for %" PRIu64 " cycles", tm->number, number, charged);
}

static void check_tm(struct checker *checker, const struct trax_tm *tm) {
  check_queue(checker, tm);
  check_dcache(checker, tm);
  check_states(checker, tm);
  for (unsigned i = 0; i < tm->tps; i++)
    check_tp(checker, tm, i);
  for (unsigned i = 0; i < TRAX_SHARED_COUNT; i++)
    for (size_t j = 0; j < trax_shared_unit_count(&tm->unit[i]); j++)
      check_cycle(checker, tm->unit[i].free_from[j], "unit");
}

const char *trax_state_check(void *state, uint64_t t, char text[128]) {
  struct checker checker = {.chip = state, .t = t, .text = text, .listed = calloc(most_requests(state), 1)};
  if (expect(&checker, checker.listed, "out of memory") &&
      expect(&checker, t > 0 && t < LAST_CYCLE, "it is before cycle %" PRIu64, t)) {
    for (uint32_t i = 0; i < checker.chip->tms; i++)
      check_tm(&checker, &checker.chip->tm[i]);
    if (!checker.failed)
      check_memory(&checker);
  }
  free(checker.listed);
  return checker.failed ? text : NULL;
}
