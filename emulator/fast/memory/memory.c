#include "fast/memory/memory.h"

#include "fast/memory/l2.h"
#include "fast/tm/tm.h"
#include "trax/gcd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_LATENCY 1000000u /* cycles; longer transfers count as this in trax_memory_least_latency */

static uint64_t divide_up(uint64_t a, uint64_t b) {
  return (a + b - 1) / b;
}

static uint64_t ceiling(struct trax_instant instant) {
  return instant.cycle + (instant.units > 0);
}

bool trax_memory_keeps_order(const struct trax_config *config) {
  return config->memory.model == TRAX_MEMORY_LIMIT && config->memory.channels == 1 && !config->l2.bytes &&
         !config->memory.atomic_latency_cycles && !config->memory.atomic_interval_cycles;
}

static void create_bus(struct trax_memory *memory, const struct trax_config *config) {
  const uint64_t megabytes_per_second = (uint64_t)llround(config->memory.bandwidth_gbps * 1000);
  const uint64_t megahertz = (uint64_t)config->chip.clock_mhz * config->memory.channels;
  const uint64_t divisor = trax_gcd(megabytes_per_second, megahertz);
  memory->units_per_cycle = megabytes_per_second / divisor;
  memory->units_per_byte = megahertz / divisor;
}

uint32_t trax_memory_least_latency(const struct trax_config *config) {
  struct trax_memory bus;
  if (config->l2.bytes)
    return config->l2.latency_cycles;
  if (config->memory.model == TRAX_MEMORY_DRAM)
    return 1 + config->memory.latency_cycles;
  create_bus(&bus, config);
  const uint64_t transfer = divide_up(config->memory.min_transfer_bytes * bus.units_per_byte, bus.units_per_cycle);
  return (uint32_t)(transfer < MOST_LATENCY ? transfer : MOST_LATENCY) + config->memory.latency_cycles;
}

trax_status trax_memory_create(struct trax_memory *memory, const struct trax_config *config,
                               struct trax_memory_stats *stats, trax_error *error) {
  memset(memory, 0, sizeof *memory);
  memory->stats = stats;
  create_bus(memory, config);
  memory->latency = config->memory.latency_cycles;
  memory->atomic_latency = config->memory.atomic_latency_cycles;
  memory->unit_interval = config->memory.atomic_interval_cycles;
  memory->channels = config->memory.channels;
  memory->interleave_shift = (unsigned)__builtin_ctz(config->memory.interleave_bytes);
  memory->keeps_order = trax_memory_keeps_order(config);
  for (uint32_t i = 0; i < memory->channels; i++) {
    memory->channel[i].passed = trax_empty_list;
    if (memory->keeps_order || config->l2.bytes)
      continue;
    memory->channel[i].waiting = trax_waiting_create(1);
    if (!memory->channel[i].waiting)
      return trax_fail(error, "out of memory");
  }
  if (config->memory.model == TRAX_MEMORY_DRAM && !(memory->dram = trax_dram_create(config, &stats->dram, error)))
    return TRAX_ERROR;
  return config->l2.bytes ? trax_l2_create(&memory->l2, config, error) : TRAX_OK;
}

void trax_memory_destroy(struct trax_memory *memory) {
  for (uint32_t i = 0; i < memory->channels; i++)
    free(memory->channel[i].waiting);
  trax_dram_destroy(memory->dram);
  trax_l2_destroy(memory->l2);
}

/* --- lists --- */

struct trax_waiting *trax_waiting_create(uint32_t count) {
  struct trax_waiting *waiting = calloc(count, sizeof *waiting);
  for (uint32_t i = 0; waiting && i < count; i++)
    for (unsigned tm = 0; tm < TRAX_MAX_TMS; tm++)
      waiting[i].list[tm] = trax_empty_list;
  return waiting;
}

struct trax_request *trax_memory_request(const struct trax_memory *memory, struct trax_tm *tms, trax_request_id id) {
  const uint32_t place = id & ((1u << TRAX_REQUEST_BITS) - 1);
  return id < TRAX_LINE_REQUEST ? &tms[id >> TRAX_REQUEST_BITS].queue.requests[place]
                                : &memory->l2->mshr[place].request;
}

void trax_memory_append(const struct trax_memory *memory, struct trax_tm *tms, struct trax_request_list *list,
                        trax_request_id id) {
  trax_memory_request(memory, tms, id)->next = TRAX_NO_REQUEST;
  if (list->first == TRAX_NO_REQUEST)
    list->first = id;
  else
    trax_memory_request(memory, tms, list->last)->next = id;
  list->last = id;
}

trax_request_id trax_memory_take_first(const struct trax_memory *memory, struct trax_tm *tms,
                                       struct trax_request_list *list) {
  const trax_request_id id = list->first;
  list->first = trax_memory_request(memory, tms, id)->next;
  return id;
}

uint32_t trax_memory_import_list(const struct trax_memory *memory, struct trax_tm *tms,
                                 struct trax_request_list *list) {
  uint32_t count = 0;
  list->last = list->first;
  for (trax_request_id id = list->first; id != TRAX_NO_REQUEST; id = trax_memory_request(memory, tms, id)->next) {
    list->last = id;
    count++;
  }
  return count;
}

uint32_t trax_waiting_import(const struct trax_memory *memory, struct trax_tm *tms, struct trax_waiting *waiting) {
  uint32_t count = 0;
  waiting->tms = 0;
  for (unsigned tm = 0; tm < TRAX_MAX_TMS; tm++) {
    count += trax_memory_import_list(memory, tms, &waiting->list[tm]);
    waiting->tms |= (uint64_t)(waiting->list[tm].first != TRAX_NO_REQUEST) << tm;
  }
  return count;
}

void trax_memory_import(struct trax_memory *memory, struct trax_tm *tms, unsigned count) {
  memory->tms = memory->waiting = 0;
  for (unsigned i = 0; i < count; i++) {
    trax_queue_import(&tms[i].queue);
    memory->tms |= (uint64_t)(memory->keeps_order && tms[i].queue.started < tms[i].queue.count) << i;
  }
  for (unsigned i = 0; i < memory->channels; i++) {
    struct trax_channel *channel = &memory->channel[i];
    memory->waiting += trax_memory_import_list(memory, tms, &channel->passed);
    if (channel->waiting)
      memory->waiting += trax_waiting_import(memory, tms, channel->waiting);
    for (unsigned queue = 0; memory->dram && queue < TRAX_DRAM_QUEUES; queue++)
      memory->waiting += memory->dram->channel[i].count[queue];
  }
  if (memory->l2)
    trax_l2_import(memory, tms);
}

unsigned trax_waiting_arbitrate(struct trax_waiting *waiting) {
  const unsigned number = trax_arbiter_peek(waiting->arbiter, waiting->tms);
  trax_arbiter_to_back(&waiting->arbiter, number);
  return number;
}

trax_request_id trax_waiting_take(struct trax_memory *memory, struct trax_tm *tms, struct trax_waiting *waiting,
                                  unsigned number) {
  const trax_request_id id = trax_memory_take_first(memory, tms, &waiting->list[number]);
  if (waiting->list[number].first == TRAX_NO_REQUEST)
    waiting->tms &= ~((uint64_t)1 << number);
  return id;
}

static struct trax_channel *channel_of(struct trax_memory *memory, uint32_t address) {
  return &memory->channel[memory->dram ? trax_dram_channel_of(memory->dram, address)
                                       : (address >> memory->interleave_shift) % memory->channels];
}

void trax_memory_pass(struct trax_memory *memory, struct trax_tm *tms, trax_request_id id) {
  struct trax_channel *channel = channel_of(memory, trax_memory_request(memory, tms, id)->address);
  trax_memory_append(memory, tms, &channel->passed, id);
  memory->waiting++;
}

void trax_memory_submit(struct trax_memory *memory, struct trax_tm *tm) {
  struct trax_queue *queue = &tm->queue;
  const uint64_t bit = (uint64_t)1 << tm->number;
  if (memory->keeps_order) {
    queue->submitted++;
    memory->tms |= bit;
    return;
  }
  const uint32_t place = queue->first_unsubmitted, address = queue->requests[place].address;
  struct trax_waiting *waiting = memory->l2 ? trax_l2_bank(memory->l2, address) : channel_of(memory, address)->waiting;
  queue->first_unsubmitted = queue->requests[place].next;
  trax_memory_append(memory, tm - tm->number, &waiting->list[tm->number], tm->number << TRAX_REQUEST_BITS | place);
  waiting->tms |= bit;
  *(memory->l2 ? &memory->l2->waiting : &memory->waiting) += 1;
}

/* --- transfers --- */

static void increment(const struct trax_memory *memory, struct trax_request *request, struct trax_space *space) {
  memory->before_increment(memory->context, request->address);
  memcpy(&request->value, space->bytes + request->address, sizeof request->value);
  const uint32_t incremented = request->value + 1;
  memcpy(space->bytes + request->address, &incremented, sizeof incremented);
}

/* Performs an atomic increment whose transfer is over in cycle `over`. Returns the cycle in which the channel's unit
   has done it. */
static uint64_t increment_at(struct trax_memory *memory, unsigned number, struct trax_request *request,
                             struct trax_space *space, uint64_t over) {
  struct trax_channel *channel = &memory->channel[number];
  increment(memory, request, space);
  if (channel->unit_free_from > over)
    over = channel->unit_free_from;
  channel->unit_free_from = over + memory->unit_interval;
  return over;
}

/* A channel takes a request of a TM in cycle t; TRAX_MAX_TMS stands for the second-level cache. */
static void notify_transfer(struct trax_memory *memory, unsigned number, uint32_t tm,
                            const struct trax_request *request, uint64_t t) {
  if (memory->transfers)
    trax_transfer_log_add(memory->transfers, t, number, tm, request);
}

static void count_transfer(const struct trax_memory *memory, unsigned number, uint32_t bytes) {
  memory->stats->transfers++;
  memory->stats->bytes += bytes;
  memory->stats->channel[number].transfers++;
  memory->stats->channel[number].bytes += bytes;
}

/* Begins the transfer of the request's bytes. Returns ceil(f) + memory.latency_cycles. */
static uint64_t transfer(struct trax_memory *memory, unsigned number, struct trax_request *request,
                         struct trax_space *space, uint64_t t) {
  struct trax_channel *channel = &memory->channel[number];
  const struct trax_instant begin = channel->free_from.cycle >= t ? channel->free_from : (struct trax_instant){t, 0};
  const uint64_t units = begin.units + request->bytes * memory->units_per_byte;
  channel->free_from =
      (struct trax_instant){begin.cycle + units / memory->units_per_cycle, units % memory->units_per_cycle};
  count_transfer(memory, number, request->bytes);
  uint64_t over = ceiling(channel->free_from);
  if (request->kind == TRAX_REQUEST_ATOMIC)
    over = increment_at(memory, number, request, space, over);
  return over + memory->latency;
}

void trax_memory_complete(struct trax_tm *tms, trax_request_id id, uint64_t completion) {
  struct trax_tm *tm = &tms[id >> TRAX_REQUEST_BITS];
  const uint32_t place = id & ((1u << TRAX_REQUEST_BITS) - 1);
  tm->queue.requests[place].completion = completion;
  trax_queue_start(&tm->queue, place);
  if (completion < tm->next_cycle)
    tm->next_cycle = completion;
}

/* Whether the bus is free before the end of cycle t. */
static bool is_free(const struct trax_channel *channel, uint64_t t) {
  return channel->free_from.cycle <= t;
}

/* The single channel serves the oldest waiting request in a TM's ring. */
static void serve_ring(struct trax_memory *memory, struct trax_tm *tm, struct trax_space *space, uint64_t t) {
  trax_arbiter_to_back(&memory->arbiter, tm->number);
  struct trax_request *request = trax_queue_first_waiting(&tm->queue);
  if (++tm->queue.started == tm->queue.submitted)
    memory->tms &= ~((uint64_t)1 << tm->number);
  notify_transfer(memory, 0, tm->number, request, t);
  request->completion = transfer(memory, 0, request, space, t);
  if (request->completion < tm->next_cycle)
    tm->next_cycle = request->completion;
}

static void serve_rings(struct trax_memory *memory, struct trax_tm *tms, struct trax_space *space, uint64_t t) {
  while (memory->tms && is_free(&memory->channel[0], t))
    serve_ring(memory, &tms[trax_arbiter_peek(memory->arbiter, memory->tms)], space, t);
}

/* Whether a TM without a waiting request, which the arbiter would prefer to the next TM with one, may make a request by
   cycle t. */
static bool may_be_overtaken(const struct trax_memory *memory, const struct trax_tm *tms, unsigned count, uint64_t t) {
  const unsigned next = trax_arbiter_peek(memory->arbiter, memory->tms);
  for (unsigned number = memory->arbiter < count ? memory->arbiter : 0; number != next;
       number = number + 1 < count ? number + 1 : 0)
    if (tms[number].next_cycle <= t)
      return true;
  return false;
}

uint64_t trax_memory_serve_early(struct trax_memory *memory, struct trax_tm *tms, unsigned count,
                                 struct trax_space *space, uint64_t t, uint64_t end) {
  while (memory->keeps_order) {
    const uint64_t free_cycle = memory->channel[0].free_from.cycle; /* the bus frees during it */
    if (free_cycle > t)
      t = free_cycle;
    if (t >= end || !memory->tms || may_be_overtaken(memory, tms, count, t))
      break;
    serve_ring(memory, &tms[trax_arbiter_peek(memory->arbiter, memory->tms)], space, t);
  }
  return t;
}

static bool has_waiting(const struct trax_channel *channel) {
  return channel->waiting ? channel->waiting->tms != 0 : channel->passed.first != TRAX_NO_REQUEST;
}

/* A request has been served; `back`: the cycle in which its transfer is over, and memory.latency_cycles. */
static void finish(struct trax_memory *memory, struct trax_tm *tms, unsigned number, trax_request_id id,
                   uint64_t back) {
  memory->waiting--;
  if (id >= TRAX_LINE_REQUEST) {
    trax_l2_set_arrival(memory, tms, number, id, back);
    return;
  }
  const bool atomic = trax_memory_request(memory, tms, id)->kind == TRAX_REQUEST_ATOMIC;
  trax_memory_complete(tms, id, back + (memory->l2 ? memory->l2->latency : 0) + (atomic ? memory->atomic_latency : 0));
}

static void serve_channel(struct trax_memory *memory, struct trax_tm *tms, struct trax_space *space, unsigned number,
                          uint64_t t) {
  struct trax_channel *channel = &memory->channel[number];
  while (has_waiting(channel) && is_free(channel, t)) {
    struct trax_waiting *waiting = channel->waiting;
    const trax_request_id id = waiting ? trax_waiting_take(memory, tms, waiting, trax_waiting_arbitrate(waiting))
                                       : trax_memory_take_first(memory, tms, &channel->passed);
    struct trax_request *request = trax_memory_request(memory, tms, id);
    notify_transfer(memory, number, id >> TRAX_REQUEST_BITS, request, t);
    finish(memory, tms, number, id, transfer(memory, number, request, space, t));
  }
}

/* --- DRAM --- */

static enum trax_dram_queue queue_of(const struct trax_request *request) {
  return request->kind == TRAX_REQUEST_WRITE ? TRAX_DRAM_WRITE : TRAX_DRAM_READ;
}

/* Whether the channel can take the request from those that wait for it. */
static bool is_admitted(const struct trax_memory *memory, unsigned number, const struct trax_request *request) {
  return request->kind == TRAX_REQUEST_ATOMIC || trax_dram_has_place(memory->dram, number, queue_of(request));
}

/* Takes the next request that the channel can take. TRAX_NO_REQUEST: there is none. */
static trax_request_id take_admitted(struct trax_memory *memory, struct trax_tm *tms, unsigned number) {
  struct trax_channel *channel = &memory->channel[number];
  struct trax_waiting *waiting = channel->waiting;
  if (!waiting) {
    const trax_request_id first = channel->passed.first;
    if (first == TRAX_NO_REQUEST || !is_admitted(memory, number, trax_memory_request(memory, tms, first)))
      return TRAX_NO_REQUEST;
    return trax_memory_take_first(memory, tms, &channel->passed);
  }
  uint64_t admitted = waiting->tms;
  if (!trax_dram_has_place(memory->dram, number, TRAX_DRAM_READ) ||
      !trax_dram_has_place(memory->dram, number, TRAX_DRAM_WRITE))
    for (uint64_t rest = waiting->tms; rest; rest &= rest - 1) {
      const unsigned tm = (unsigned)__builtin_ctzll(rest);
      if (!is_admitted(memory, number, trax_memory_request(memory, tms, waiting->list[tm].first)))
        admitted &= ~((uint64_t)1 << tm);
    }
  if (!admitted)
    return TRAX_NO_REQUEST;
  const unsigned tm = trax_arbiter_peek(waiting->arbiter, admitted);
  trax_arbiter_to_back(&waiting->arbiter, tm);
  return trax_waiting_take(memory, tms, waiting, tm);
}

/* Brings requests to the DRAM as long as it has places, and performs atomic increments. */
static void admit(struct trax_memory *memory, struct trax_tm *tms, struct trax_space *space, unsigned number,
                  uint64_t t) {
  trax_request_id id;
  while ((id = take_admitted(memory, tms, number)) != TRAX_NO_REQUEST) {
    struct trax_request *request = trax_memory_request(memory, tms, id);
    if (request->kind == TRAX_REQUEST_ATOMIC) {
      finish(memory, tms, number, id, increment_at(memory, number, request, space, t + 1) + memory->latency);
      continue;
    }
    notify_transfer(memory, number, id >> TRAX_REQUEST_BITS, request, t);
    trax_dram_bring(memory->dram, queue_of(request), id, request->address, request->bytes, t);
  }
}

static void serve_dram(struct trax_memory *memory, struct trax_tm *tms, struct trax_space *space, unsigned number,
                       uint64_t t) {
  struct trax_dram_served served;
  admit(memory, tms, space, number, t);
  while (trax_dram_serve(memory->dram, number, t, &served)) {
    count_transfer(memory, number, trax_memory_request(memory, tms, served.id)->bytes);
    finish(memory, tms, number, served.id, served.over + memory->latency);
    admit(memory, tms, space, number, t);
  }
}

void trax_memory_cycle(struct trax_memory *memory, struct trax_tm *tms, struct trax_space *space, uint64_t t) {
  if (memory->keeps_order) {
    serve_rings(memory, tms, space, t);
    return;
  }
  if (memory->l2 && memory->l2->waiting)
    trax_l2_cycle(memory, tms, t);
  for (unsigned i = 0; i < memory->channels && memory->waiting; i++)
    (memory->dram ? serve_dram : serve_channel)(memory, tms, space, i, t);
}

bool trax_memory_has_waiting(const struct trax_memory *memory) {
  return memory->tms || memory->waiting || (memory->l2 && memory->l2->waiting);
}

uint64_t trax_memory_next_cycle(const struct trax_memory *memory, uint64_t t) {
  if (!trax_memory_has_waiting(memory))
    return UINT64_MAX;
  if (memory->l2 && memory->l2->waiting)
    return t + 1;
  uint64_t next = UINT64_MAX;
  for (unsigned i = 0; i < memory->channels; i++) {
    const struct trax_channel *channel = &memory->channel[i];
    const uint64_t free_cycle =
        memory->dram ? trax_dram_next_cycle(memory->dram, i) : channel->free_from.cycle; /* the bus frees during it */
    if ((memory->keeps_order || memory->dram || has_waiting(channel)) && free_cycle < next)
      next = free_cycle;
  }
  return next > t + 1 ? next : t + 1;
}

uint64_t trax_memory_idle_from(const struct trax_memory *memory) {
  uint64_t idle_from = 0;
  for (unsigned i = 0; i < memory->channels; i++) {
    const uint64_t idle = memory->dram ? trax_dram_idle_from(memory->dram, i) : ceiling(memory->channel[i].free_from);
    idle_from = idle > idle_from ? idle : idle_from;
  }
  return idle_from;
}
