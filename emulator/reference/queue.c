/* docs/timing-memory.md, "Memory queue": step 4, and the arrivals of "A cycle". */
#include "reference/reference.h"

bool trax_ref_request(struct trax_ref_tm *tm, struct trax_ref_request request) {
  struct trax_tm_stats *stats = tm->stats;
  if (tm->places == tm->config->memory.queue_depth)
    return false;
  const bool dram = tm->config->memory.model == TRAX_MEMORY_DRAM;
  if (dram)
    request.bytes = trax_dram_bytes(tm->config, request.address, request.kind == ATOMIC ? 4 : request.bytes);
  else if (request.bytes < tm->config->memory.min_transfer_bytes)
    request.bytes = tm->config->memory.min_transfer_bytes;
  request.tm = tm->number;
  request.channel = trax_ref_channel_of(tm->config, request.address);
  request.stage = tm->config->l2.bytes ? AT_BANK : AT_CHANNEL;
  tm->queue[tm->places++] = request;

  if (tm->places > stats->queue_peak)
    stats->queue_peak = tm->places;
  stats->memory_requests++;
  stats->write_requests += request.kind == WRITE;
  uint64_t *const bytes[] = {[INSTRUCTION_LINE] = &stats->instruction_read_bytes,
                             [DATA_LINE] = &stats->data_read_bytes,
                             [LOAD_PAST_CACHE] = &stats->nontemporal_read_bytes,
                             [WRITE] = &stats->written_bytes,
                             [ATOMIC] = &stats->atomic_bytes};
  *bytes[request.kind] += dram && request.kind == ATOMIC ? 0 : request.bytes;
  return true;
}

uint32_t trax_ref_lines_on_their_way(const struct trax_ref_tm *tm, trax_ref_kind kind) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < tm->places; i++)
    count += tm->queue[i].kind == kind;
  return count;
}

const struct trax_ref_request *trax_ref_on_its_way(const struct trax_ref_tm *tm, trax_ref_kind kind, uint32_t icache,
                                                   uint32_t line) {
  for (uint32_t i = 0; i < tm->places; i++)
    if (tm->queue[i].kind == kind && tm->queue[i].icache == icache && tm->queue[i].line == line)
      return &tm->queue[i];
  return NULL;
}

struct trax_ref_request *trax_ref_oldest_at_bank(struct trax_ref_tm *tm, uint32_t bank) {
  for (uint32_t i = 0; i < tm->places; i++)
    if (tm->queue[i].stage == AT_BANK && trax_ref_bank_of(tm->config, tm->queue[i].address) == bank)
      return &tm->queue[i];
  return NULL;
}

struct trax_ref_request *trax_ref_oldest_at_channel(struct trax_ref_tm *tm, uint32_t channel) {
  for (uint32_t i = 0; i < tm->places; i++)
    if (tm->queue[i].stage == AT_CHANNEL && tm->queue[i].channel == channel)
      return &tm->queue[i];
  return NULL;
}

/* --- arrivals --- */

static void arrive(struct trax_ref_tm *tm, const struct trax_ref_request *request, uint64_t t) {
  switch (request->kind) {
  case INSTRUCTION_LINE:
    trax_ref_instruction_arrives(tm, request->icache, request->line);
    break;
  case DATA_LINE:
    trax_ref_data_arrives(tm, request, t);
    break;
  case ATOMIC:
    if (request->rd != 0) {
      tm->tp[request->tp].reg[request->rd] = request->old_value;
      trax_ref_notify_arrival(tm, request, t);
    }
    tm->tp[request->tp].scoreboard[request->rd].usable = t;
    break;
  case LOAD_PAST_CACHE:
    tm->tp[request->tp].scoreboard[request->rd].usable = t;
    break;
  case WRITE:
    break;
  }
}

void trax_ref_arrivals(struct trax_ref_tm *tm, uint64_t t) {
  uint32_t kept = 0;
  for (uint32_t i = 0; i < tm->places; i++)
    if (tm->queue[i].stage == SERVED && tm->queue[i].completion == t)
      arrive(tm, &tm->queue[i], t);
    else if (kept++ < i)
      tm->queue[kept - 1] = tm->queue[i];
  tm->places = kept;
}

/* --- step 4 --- */

/* Serves a load past the cache or an atomic increment. False: it needs a place and gets none. */
static bool read_word(struct trax_ref_tm *tm, struct trax_ref_tp *tp) {
  const bool atomic = trax_ref_is(tp, TRAX_IS_ATOMIC);
  if (!trax_ref_request(tm, (struct trax_ref_request){.kind = atomic ? ATOMIC : LOAD_PAST_CACHE,
                                                      .tp = tp->number,
                                                      .rd = tp->inst.rd,
                                                      .address = tp->address,
                                                      .bytes = atomic ? tm->config->memory.atomic_bytes : 4}))
    return false;
  tm->stats->nontemporal_loads += !atomic;
  trax_ref_result(tp, UNKNOWN, atomic ? TRAX_CAUSE_DATA_ATOMIC : TRAX_CAUSE_DATA_MISS);
  return true;
}

/* Serves a TP in its turn. False: it needs a place and gets none. */
static bool serve(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  if (trax_ref_ends_thread(tp) || trax_ref_fences(tp, TRAX_FENCE_W))
    return trax_ref_write_run(tm, tp);
  if (!trax_ref_accesses_memory(tp) || trax_ref_accesses_local(tp))
    return true; /* it needs nothing in this step */
  if (trax_ref_is(tp, TRAX_IS_STORE))
    return trax_ref_store(tm, tp);
  if (trax_ref_is(tp, TRAX_IS_NONTEMPORAL | TRAX_IS_ATOMIC))
    return read_word(tm, tp);
  return trax_ref_load(tm, tp, t);
}

void trax_ref_take_turn(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  const uint32_t taken = tm->places;
  if (!serve(tm, tp, t))
    trax_ref_charge(tm, tp, t, TRAX_CAUSE_MEMORY_QUEUE);
  else if (trax_ref_fence_waits(tm, tp))
    trax_ref_charge(tm, tp, t, TRAX_CAUSE_DATA_MISS);
  if (tm->places > taken)
    tm->queue_pointer = (tp->number + 1) % tm->tps;
}

void trax_ref_grant_places(struct trax_ref_tm *tm, uint64_t t) {
  const trax_ref_pointer first = tm->queue_pointer;
  for (uint32_t i = 0; i < tm->tps; i++) {
    struct trax_ref_tp *tp = &tm->tp[(first + i) % tm->tps];
    if (trax_ref_active(tp))
      trax_ref_take_turn(tm, tp, t);
  }
}
