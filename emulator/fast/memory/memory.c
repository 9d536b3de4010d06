#include "fast/memory/memory.h"

#include "fast/memory/l2.h"
#include "fast/tm/tm.h"

#include <string.h>

static uint64_t ceiling(struct trax_instant instant) {
  return instant.cycle + (instant.units > 0);
}

/* --- lists --- */

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

void trax_waiting_add(const struct trax_memory *memory, struct trax_tm *tms, struct trax_waiting *waiting,
                      unsigned number, trax_request_id id) {
  trax_memory_append(memory, tms, &waiting->list[number], id);
  waiting->tms |= (uint64_t)1 << number;
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
  trax_waiting_add(memory, tms, &channel->waiting, 0, id);
  memory->waiting++;
}

void trax_memory_submit(struct trax_memory *memory, struct trax_tm *tm, uint32_t place) {
  const uint32_t address = tm->queue.requests[place].address;
  struct trax_waiting *waiting = memory->l2 ? trax_l2_bank(memory->l2, address) : &channel_of(memory, address)->waiting;
  trax_waiting_add(memory, tm - tm->number, waiting, tm->number, tm->number << TRAX_REQUEST_BITS | place);
  *(memory->l2 ? &memory->l2->waiting : &memory->waiting) += 1;
}

/* --- transfers --- */

uint64_t trax_memory_increment(struct trax_memory *memory, unsigned number, struct trax_request *request,
                               uint64_t over) {
  struct trax_channel *channel = &memory->channel[number];
  request->value = memory->increment(memory->context, request->address);
  if (channel->unit_free_from > over)
    over = channel->unit_free_from;
  channel->unit_free_from = over + memory->unit_interval;
  return over;
}

void trax_memory_notify(struct trax_memory *memory, unsigned number, trax_request_id id,
                        const struct trax_request *request, uint64_t t) {
  const bool is_l2 = id >= TRAX_LINE_REQUEST;
  if (memory->transfers)
    trax_transfer_log_add(memory->transfers, &(struct trax_transfer){
                                                 .cycle = t,
                                                 .address = request->address,
                                                 .bytes = request->bytes,
                                                 .tm = is_l2 ? TRAX_TRANSFER_NO_TM : (int16_t)(id >> TRAX_REQUEST_BITS),
                                                 .kind = is_l2 ? TRAX_TRANSFER_L2_LINE : request->kind,
                                                 .channel = (uint8_t)number});
}
_Static_assert((int)TRAX_REQUEST_DATA_LINE == (int)TRAX_TRANSFER_DATA_LINE &&
                   (int)TRAX_REQUEST_ATOMIC == (int)TRAX_TRANSFER_ATOMIC,
               "requests have the numbers of their transfers");

void trax_memory_count(const struct trax_memory *memory, unsigned number, uint32_t bytes) {
  memory->stats->transfers++;
  memory->stats->bytes += bytes;
  memory->stats->channel[number].transfers++;
  memory->stats->channel[number].bytes += bytes;
}

/* Begins the transfer of the request's bytes. Returns ceil(f) + memory.latency_cycles. */
static inline uint64_t transfer(struct trax_memory *memory, unsigned number, struct trax_request *request, uint64_t t) {
  struct trax_channel *channel = &memory->channel[number];
  const bool busy = channel->free_from.cycle >= t;
  const uint64_t units = (busy ? channel->free_from.units : 0) + request->bytes * memory->units_per_byte;
  channel->free_from.cycle = (busy ? channel->free_from.cycle : t) + units / memory->units_per_cycle;
  channel->free_from.units = units % memory->units_per_cycle;
  trax_memory_count(memory, number, request->bytes);
  uint64_t over = ceiling(channel->free_from);
  if (request->kind == TRAX_REQUEST_ATOMIC)
    over = trax_memory_increment(memory, number, request, over);
  return over + memory->latency;
}

void trax_memory_complete(const struct trax_memory *memory, struct trax_tm *tms, trax_request_id id,
                          uint64_t completion) {
  struct trax_queue *const queue = &tms[id >> TRAX_REQUEST_BITS].queue;
  struct trax_served *const served = &queue->served[memory->side];
  const uint32_t place = id & ((1u << TRAX_REQUEST_BITS) - 1);
  queue->requests[place].completion = completion;
  queue->requests[place].next = served->first;
  served->first = place;
  served->count++;
}

/* Whether the bus is free before the end of cycle t. */
static bool is_free(const struct trax_channel *channel, uint64_t t) {
  return channel->free_from.cycle <= t;
}

void trax_memory_finish(struct trax_memory *memory, struct trax_tm *tms, unsigned number, trax_request_id id,
                        uint64_t back) {
  memory->waiting--;
  if (id >= TRAX_LINE_REQUEST) {
    trax_l2_set_arrival(memory, tms, number, id, back);
    return;
  }
  const bool atomic = trax_memory_request(memory, tms, id)->kind == TRAX_REQUEST_ATOMIC;
  trax_memory_complete(memory, tms, id,
                       back + (memory->l2 ? memory->l2->latency : 0) + (atomic ? memory->atomic_latency : 0));
}

/* A channel whose bus is free serves one of the requests that wait for it. */
static void serve(struct trax_memory *memory, struct trax_tm *tms, unsigned number, uint64_t t) {
  struct trax_waiting *waiting = &memory->channel[number].waiting;
  const trax_request_id id = trax_waiting_take(memory, tms, waiting, trax_waiting_arbitrate(waiting));
  struct trax_request *request = trax_memory_request(memory, tms, id);
  trax_memory_notify(memory, number, id, request, t);
  trax_memory_finish(memory, tms, number, id, transfer(memory, number, request, t));
}

static inline void serve_channel(struct trax_memory *memory, struct trax_tm *tms, unsigned number, uint64_t t) {
  while (memory->channel[number].waiting.tms && is_free(&memory->channel[number], t))
    serve(memory, tms, number, t);
}

void trax_memory_cycle(struct trax_memory *memory, struct trax_tm *tms, uint64_t t) {
  if (memory->l2 && memory->l2->waiting)
    trax_l2_cycle(memory, tms, t);
  for (unsigned i = 0; i < memory->channels && memory->waiting; i++)
    if (memory->dram)
      trax_memory_serve_dram(memory, tms, i, t);
    else
      serve_channel(memory, tms, i, t);
}

bool trax_memory_has_waiting(const struct trax_memory *memory) {
  return memory->waiting || (memory->l2 && memory->l2->waiting);
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
    if ((memory->dram || channel->waiting.tms) && free_cycle < next)
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
