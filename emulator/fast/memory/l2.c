#include "fast/memory/l2.h"

#include "fast/tm/tm.h"

#include <stdlib.h>

trax_status trax_l2_create(struct trax_l2 **result, const struct trax_config *config, trax_error *error) {
  struct trax_l2 *l2 = *result = calloc(1, sizeof *l2);
  if (!l2)
    return trax_fail(error, "out of memory");
  const uint32_t least = config->memory.min_transfer_bytes;
  l2->banks = config->l2.banks;
  l2->latency = config->l2.latency_cycles;
  l2->line_cost = config->memory.model == TRAX_MEMORY_DRAM ? trax_dram_bytes(config, 0, config->l2.line_bytes)
                  : config->l2.line_bytes > least          ? config->l2.line_bytes
                                                           : least;
  l2->mshr_limit = config->l2.mshrs;
  l2->bank = calloc(l2->banks, sizeof *l2->bank);
  l2->mshr = calloc(l2->mshr_limit, sizeof *l2->mshr);
  if (!trax_cache_tags_create(&l2->tags, config->l2.bytes, config->l2.line_bytes, config->l2.ways,
                              config->l2.replacement) ||
      !l2->bank || !l2->mshr)
    return trax_fail(error, "out of memory for the second-level cache");
  for (uint32_t i = 0; i < l2->banks; i++)
    trax_waiting_begin(&l2->bank[i]);
  for (unsigned i = 0; i < TRAX_MAX_CHANNELS; i++)
    l2->arriving[i] = trax_empty_list;
  l2->next_arrival = TRAX_NEVER;
  return TRAX_OK;
}

void trax_l2_destroy(struct trax_l2 *l2) {
  if (!l2)
    return;
  trax_cache_tags_destroy(&l2->tags);
  free(l2->bank);
  free(l2->mshr);
  free(l2);
}

/* --- lines on their way --- */

static uint32_t line_of(const struct trax_l2 *l2, const struct trax_l2_mshr *mshr) {
  return trax_line_of(&l2->tags, mshr->request.address);
}

/* Returns the line's miss register. NULL: it is not on its way. */
static struct trax_l2_mshr *find(const struct trax_l2 *l2, uint32_t line) {
  for (uint32_t i = 0; i < l2->mshr_limit; i++)
    if (l2->mshr[i].request.bytes && line_of(l2, &l2->mshr[i]) == line)
      return &l2->mshr[i];
  return NULL;
}

/* Returns the number of a free miss register; mshr_limit: there is none. */
static uint32_t find_free(const struct trax_l2 *l2) {
  uint32_t i = 0;
  while (i < l2->mshr_limit && l2->mshr[i].request.bytes)
    i++;
  return i;
}

static struct trax_l2_mshr *mshr_of(const struct trax_l2 *l2, trax_request_id id) {
  return &l2->mshr[id - TRAX_LINE_REQUEST];
}

/* Returns the channel of the line that arrives next, the lowest one of several, and sets next_arrival to its cycle. */
static unsigned next_to_arrive(struct trax_l2 *l2) {
  unsigned soonest = 0;
  l2->next_arrival = TRAX_NEVER;
  for (unsigned i = 0; i < TRAX_MAX_CHANNELS; i++)
    if (l2->arriving[i].first != TRAX_NO_REQUEST && mshr_of(l2, l2->arriving[i].first)->arrival < l2->next_arrival) {
      soonest = i;
      l2->next_arrival = mshr_of(l2, l2->arriving[i].first)->arrival;
    }
  return soonest;
}

/* Enters the lines that have arrived into the cache. That may be after their cycle, but before the next look-up. */
static void install(struct trax_memory *memory, struct trax_tm *tms, uint64_t t) {
  struct trax_l2 *l2 = memory->l2;
  while (l2->next_arrival <= t) {
    struct trax_l2_mshr *const mshr =
        mshr_of(l2, trax_memory_take_first(memory, tms, &l2->arriving[next_to_arrive(l2)]));
    trax_cache_tags_install(&l2->tags, line_of(l2, mshr));
    mshr->request.bytes = 0;
    next_to_arrive(l2);
  }
}

void trax_l2_import(struct trax_memory *memory, struct trax_tm *tms) {
  struct trax_l2 *l2 = memory->l2;
  l2->waiting = 0;
  for (uint32_t i = 0; i < l2->banks; i++)
    l2->waiting += trax_waiting_import(memory, tms, &l2->bank[i]);
  for (uint32_t i = 0; i < l2->mshr_limit; i++)
    if (l2->mshr[i].request.bytes)
      trax_memory_import_list(memory, tms, &l2->mshr[i].waiters);
  for (unsigned i = 0; i < TRAX_MAX_CHANNELS; i++)
    trax_memory_import_list(memory, tms, &l2->arriving[i]);
  next_to_arrive(l2);
}

void trax_l2_set_arrival(struct trax_memory *memory, struct trax_tm *tms, unsigned channel, trax_request_id id,
                         uint64_t arrival) {
  struct trax_l2 *l2 = memory->l2;
  struct trax_l2_mshr *mshr = mshr_of(l2, id);
  mshr->arrival = arrival;
  if (arrival < l2->next_arrival)
    l2->next_arrival = arrival;
  while (mshr->waiters.first != TRAX_NO_REQUEST)
    trax_memory_complete(memory, tms, trax_memory_take_first(memory, tms, &mshr->waiters), arrival + l2->latency);
  trax_memory_append(memory, tms, &l2->arriving[channel], id);
}

/* --- banks --- */

static void request_line(struct trax_memory *memory, struct trax_tm *tms, uint32_t line, trax_request_id waiter) {
  struct trax_l2 *l2 = memory->l2;
  const uint32_t number = find_free(l2);
  l2->mshr[number] = (struct trax_l2_mshr){
      .request = {.kind = TRAX_REQUEST_DATA_LINE, .address = line << l2->tags.line_shift, .bytes = l2->line_cost},
      .arrival = TRAX_NEVER,
      .waiters = trax_empty_list};
  trax_memory_append(memory, tms, &l2->mshr[number].waiters, waiter);
  trax_memory_pass(memory, tms, TRAX_LINE_REQUEST + number);
  memory->stats->l2_misses++;
  memory->stats->l2_read_bytes += l2->line_cost;
}

enum outcome { REFUSED, HIT, MERGED, MISSED, PASSED };

/* *on_its_way: the line's miss register, if it is MERGED. */
static enum outcome look_up(struct trax_l2 *l2, struct trax_memory_stats *stats, const struct trax_request *request,
                            struct trax_l2_mshr **on_its_way) {
  const uint32_t line = trax_line_of(&l2->tags, request->address);
  const bool present = trax_cache_tags_use(&l2->tags, line);
  if (request->kind == TRAX_REQUEST_WRITE || request->kind == TRAX_REQUEST_ATOMIC) {
    *(present ? &stats->l2_store_hits : &stats->l2_store_misses) += 1;
    return PASSED;
  }
  if (present) {
    stats->l2_hits++;
    return HIT;
  }
  *on_its_way = find(l2, line);
  if (*on_its_way) {
    stats->l2_merged++;
    return MERGED;
  }
  if (request->kind == TRAX_REQUEST_LOAD) {
    stats->l2_passed++;
    return PASSED;
  }
  return find_free(l2) < l2->mshr_limit ? MISSED : REFUSED;
}

static void serve_bank(struct trax_memory *memory, struct trax_tm *tms, struct trax_waiting *bank, uint64_t t) {
  struct trax_l2 *l2 = memory->l2;
  const unsigned tm = trax_waiting_arbitrate(bank);
  const struct trax_request *request = trax_memory_request(memory, tms, bank->list[tm].first);
  struct trax_l2_mshr *mshr = NULL;
  const enum outcome outcome = look_up(l2, memory->stats, request, &mshr);
  if (outcome == REFUSED) {
    memory->stats->l2_refused++;
    return;
  }
  const trax_request_id id = trax_waiting_take(memory, tms, bank, tm);
  l2->waiting--;
  if (outcome == PASSED) {
    trax_memory_pass(memory, tms, id);
  } else if (outcome == MISSED) {
    request_line(memory, tms, trax_line_of(&l2->tags, request->address), id);
  } else {
    memory->stats->l2_served_bytes += request->bytes;
    if (mshr && mshr->arrival == TRAX_NEVER)
      trax_memory_append(memory, tms, &mshr->waiters, id);
    else
      trax_memory_complete(memory, tms, id, (mshr ? mshr->arrival : t) + l2->latency);
  }
}

void trax_l2_cycle(struct trax_memory *memory, struct trax_tm *tms, uint64_t t) {
  struct trax_l2 *l2 = memory->l2;
  install(memory, tms, t);
  for (uint32_t i = 0; i < l2->banks && l2->waiting; i++)
    if (l2->bank[i].tms)
      serve_bank(memory, tms, &l2->bank[i], t);
}
