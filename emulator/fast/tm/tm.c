#include "fast/tm/tm.h"

#include "fast/chip.h"
#include "fast/store_buffer.h"

#include <string.h>

/* --- sleeping, ending, faulting --- */

/* The wheel spans the 64 cycles after the current one, t. A TP that sleeps longer is put into it again when its slot is
   reached. */
static void set_alarm(struct trax_tm *tm, unsigned tp, uint64_t t, uint64_t until) {
  const uint64_t alarm = until - t <= TRAX_WHEEL ? until : t + TRAX_WHEEL;
  tm->tp[tp].asleep_until = until;
  tm->wheel[alarm % TRAX_WHEEL] |= (uint64_t)1 << tp;
  tm->wheel_occupied |= (uint64_t)1 << alarm % TRAX_WHEEL;
}

void trax_tm_sleep_until(struct trax_tm *tm, unsigned tp, uint64_t t, uint64_t since, uint64_t until,
                         trax_cause cause) {
  trax_tm_sleep(tm, tp, since, cause);
  set_alarm(tm, tp, t, until);
}

void trax_tm_end_thread(struct trax_tm *tm, unsigned tp, uint64_t since, int32_t status) {
  trax_tm_sleep(tm, tp, since, TRAX_CAUSE_HALTED);
  tm->ended |= (uint64_t)1 << tp;
  tm->exit_statuses[tp] = status;
  tm->running--;
}

void trax_tm_fault(struct trax_tm *tm, unsigned number, uint64_t t, trax_fault_kind kind, uint32_t address) {
  trax_tm_end_thread(tm, number, t, 1);
  if (tm->fault.kind && tm->fault.tp < number)
    return;
  const struct trax_tp *tp = &tm->tp[number];
  struct trax_fault *fault = &tm->fault;
  trax_fault_record(fault, &tm->machine->space, tp->inst, kind, tp->pc, address);
  fault->thread = tm->number * tm->tps + number;
  fault->tm = tm->number;
  fault->tp = number;
  fault->cycle = t;
  memcpy(fault->registers, tp->reg, sizeof fault->registers);
  memcpy(fault->local, tp->local, sizeof fault->local);
}

/* --- arrivals --- */

void trax_tm_data_arrival(struct trax_tm *tm, unsigned tp, unsigned rd, uint64_t t) {
  const uint64_t bit = (uint64_t)1 << tp;
  tm->tp[tp].usable[rd] = t;
  if (tm->awaiting & bit) {
    tm->awaiting &= ~bit;
    trax_tm_wake(tm, tp, t);
  }
}

void trax_tm_complete(struct trax_tm *tm, const struct trax_request *request, uint64_t t) {
  switch ((trax_request_kind)request->kind) {
  case TRAX_REQUEST_INSTRUCTION_LINE:
    trax_icache_arrival(&tm->icache[request->icache], tm, request->line, t);
    break;
  case TRAX_REQUEST_DATA_LINE:
    trax_dcache_arrival(&tm->dcache, tm, request->line, t);
    break;
  case TRAX_REQUEST_ATOMIC:
    tm->tp[request->tp].increments--;
    tm->tp[request->tp].reg[request->rd] = tm->tp[request->tp].begin_reg[request->rd] = request->value;
    if (tm->observer && !tm->observed && tm->observer->arrival && request->rd != TRAX_NO_REGISTER)
      tm->observer->arrival(tm->observer->context,
                            &(struct trax_arrival){t, tm->number, request->tp, request->rd, request->value});
    trax_tm_data_arrival(tm, request->tp, request->rd, t);
    break;
  case TRAX_REQUEST_LOAD:
    trax_tm_data_arrival(tm, request->tp, request->rd, t);
    break;
  case TRAX_REQUEST_WRITE:
    tm->tp[request->tp].writes--;
    break;
  }
}

void trax_tm_wake_sleepers(struct trax_tm *tm, uint64_t t) {
  const unsigned slot = t % TRAX_WHEEL;
  uint64_t wakers = tm->wheel[slot];
  tm->wheel[slot] = 0;
  tm->wheel_occupied &= ~((uint64_t)1 << slot);
  for (; wakers; wakers &= wakers - 1) {
    const unsigned tp = trax_first(wakers);
    if (tm->tp[tp].asleep_until > t)
      set_alarm(tm, tp, t, tm->tp[tp].asleep_until);
    else
      trax_tm_wake(tm, tp, t);
  }
}

/* --- the memory queue --- */

void trax_tm_receive(struct trax_tm *tm, unsigned side) {
  if (!tm->queue.served[side].count)
    return;
  trax_queue_receive(&tm->queue, side);
  if (trax_queue_oldest(&tm->queue)->completion < tm->next_cycle)
    tm->next_cycle = trax_queue_oldest(&tm->queue)->completion;
}

void trax_tm_request(struct trax_tm *tm, struct trax_request request) {
  struct trax_tm_stats *stats = tm->stats;
  uint64_t *const bytes[] = {[TRAX_REQUEST_INSTRUCTION_LINE] = &stats->instruction_read_bytes,
                             [TRAX_REQUEST_DATA_LINE] = &stats->data_read_bytes,
                             [TRAX_REQUEST_LOAD] = &stats->nontemporal_read_bytes,
                             [TRAX_REQUEST_WRITE] = &stats->written_bytes,
                             [TRAX_REQUEST_ATOMIC] = &stats->atomic_bytes};
  const bool writes = request.kind == TRAX_REQUEST_WRITE, increments = request.kind == TRAX_REQUEST_ATOMIC;
  const bool dram = tm->config->memory.model == TRAX_MEMORY_DRAM;
  if (dram)
    request.bytes = trax_dram_bytes(tm->config, request.address, increments ? 4 : request.bytes);
  else if (request.bytes < tm->config->memory.min_transfer_bytes)
    request.bytes = tm->config->memory.min_transfer_bytes;
  *bytes[request.kind] += dram && increments ? 0 : request.bytes;
  stats->write_requests += writes;
  tm->tp[request.tp].writes += writes;
  tm->tp[request.tp].increments += increments;
  stats->memory_requests++;
  const uint32_t place = trax_queue_push(&tm->queue, request);
  if (tm->buffer)
    trax_store_buffer_record(tm->buffer, (struct trax_store_buffer_entry){tm->now, place, 0, TRAX_REQUEST});
  else
    trax_memory_submit(&tm->chip->memory, tm, place);
}

static bool request_and_advance(struct trax_tm *tm, unsigned tp, struct trax_request request) {
  if (!trax_queue_has_place(&tm->queue))
    return false;
  trax_tm_request(tm, request);
  trax_arbiter_to_back(&tm->queue_arbiter, tp);
  return true;
}

static bool request_write(struct trax_tm *tm, unsigned number, uint32_t begin, uint32_t end) {
  const struct trax_request request = {
      .kind = TRAX_REQUEST_WRITE, .tp = (uint8_t)number, .address = begin, .bytes = end - begin};
  return request_and_advance(tm, number, request);
}

/* Writes the run in the TP's write-combining buffer, if there is one. False: it needs a place and gets none. */
static bool write_run(struct trax_tm *tm, unsigned number) {
  struct trax_tp *tp = &tm->tp[number];
  if (tp->run_begin != tp->run_end && !request_write(tm, number, tp->run_begin, tp->run_end))
    return false;
  tp->run_begin = tp->run_end = 0;
  return true;
}

/* Combines a store with the run in its TP's write-combining buffer, or writes that run and begins a new one. False: the
   run needs a place and gets none. */
static bool store_past_cache(struct trax_tm *tm, unsigned number) {
  struct trax_tp *tp = &tm->tp[number];
  const uint32_t begin = tp->address, end = begin + tp->inst->bytes;
  if (!tm->config->memory.write_combining)
    return request_write(tm, number, begin, end);
  if (trax_tp_combine(tp, begin, tp->inst->bytes)) {
    tm->stats->combined_stores++;
    tp->outcome = TRAX_OUTCOME_COMBINED;
    return true;
  }
  if (!write_run(tm, number))
    return false;
  tp->run_begin = begin;
  tp->run_end = end;
  return true;
}

/* Requests the word of an atomic increment or a load past the cache. False: there is no place. */
static bool read_past_cache(struct trax_tm *tm, unsigned number) {
  struct trax_tp *tp = &tm->tp[number];
  const bool atomic = tp->inst->is_atomic;
  const struct trax_request request = {.kind = atomic ? TRAX_REQUEST_ATOMIC : TRAX_REQUEST_LOAD,
                                       .tp = (uint8_t)number,
                                       .rd = tp->inst->rd,
                                       .address = tp->address,
                                       .bytes = atomic ? tm->config->memory.atomic_bytes : tp->inst->bytes};
  if (!request_and_advance(tm, number, request))
    return false;
  tm->stats->nontemporal_loads += !atomic;
  trax_tp_set_usable(tp, tp->inst->rd, TRAX_NEVER, atomic ? TRAX_CAUSE_DATA_ATOMIC : TRAX_CAUSE_DATA_MISS);
  return true;
}

static bool count_store(struct trax_tm *tm, struct trax_tp *tp) {
  if (tp->inst->is_nontemporal) {
    tm->stats->nontemporal_stores++;
  } else if (trax_cache_tags_use(&tm->dcache.tags, trax_line_of(&tm->dcache.tags, tp->address))) {
    tm->stats->store_hits++;
    tp->outcome |= TRAX_OUTCOME_HIT;
  } else {
    tm->stats->store_misses++;
  }
  return true;
}

static trax_cause serve_fence(struct trax_tm *tm, unsigned number) {
  const struct trax_tp *tp = &tm->tp[number];
  const bool of_writes = tp->inst->imm & TRAX_FENCE_W;
  if (of_writes && !write_run(tm, number))
    return TRAX_CAUSE_MEMORY_QUEUE;
  return tp->increments || (of_writes && tp->writes) ? TRAX_CAUSE_DATA_MISS : TRAX_CAUSE_ISSUED;
}

/* Serves instructions other than fences in step 4. False: it needs a place and gets none. */
static bool serve_others(struct trax_tm *tm, unsigned number, uint64_t t) {
  struct trax_tp *tp = &tm->tp[number];
  if (tp->inst->resource == TRAX_RESOURCE_END)
    return write_run(tm, number);
  if (tp->inst->is_store)
    return store_past_cache(tm, number) && count_store(tm, tp);
  if (tp->inst->is_nontemporal || tp->inst->is_atomic)
    return read_past_cache(tm, number);
  return trax_dcache_load(&tm->dcache, tm, number, t);
}

trax_cause trax_tm_serve(struct trax_tm *tm, unsigned number, uint64_t t) {
  if (tm->tp[number].inst->resource == TRAX_RESOURCE_FENCE)
    return serve_fence(tm, number);
  return serve_others(tm, number, t) ? TRAX_CAUSE_ISSUED : TRAX_CAUSE_MEMORY_QUEUE;
}

uint64_t trax_tm_quiet_until(const struct trax_tm *tm, uint64_t t, uint64_t end) {
  if (tm->queue.started && trax_queue_oldest(&tm->queue)->completion < end)
    end = trax_queue_oldest(&tm->queue)->completion;
  if (tm->wheel_occupied) { /* rotated so that bit 0 is cycle t */
    const unsigned slot = t % TRAX_WHEEL;
    const uint64_t rotated = tm->wheel_occupied >> slot | tm->wheel_occupied << (-slot & 63);
    if (t + trax_first(rotated) < end)
      end = t + trax_first(rotated);
  }
  return end;
}

uint64_t trax_tm_next_cycle(const struct trax_tm *tm, uint64_t t) {
  return tm->awake ? t + 1 : trax_tm_quiet_until(tm, t + 1, TRAX_NEVER);
}

void trax_tm_settle(struct trax_tm *tm, uint64_t t) {
  for (unsigned i = 0; i < tm->tps; i++) {
    struct trax_tp *tp = &tm->tp[i];
    if (tm->awake >> i & 1)
      continue;
    tm->tp_stats[i].cycles[tp->asleep_cause] += t - tp->asleep_since;
    trax_tm_notify_charge(tm, i, (trax_cause)tp->asleep_cause, tp->asleep_since, t - tp->asleep_since);
    tp->asleep_since = t;
  }
}
