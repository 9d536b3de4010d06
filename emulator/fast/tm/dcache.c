#include "fast/tm/dcache.h"

#include "fast/tm/tm.h"

#include <stdlib.h>

enum { NO_WAITER = 0xFFFF };

bool trax_dcache_create(struct trax_dcache *dcache, const struct trax_tm *tm) {
  const struct trax_config *config = tm->config;
  dcache->banks = (tm->tps + config->dcache.tps_per_bank - 1) / config->dcache.tps_per_bank;
  dcache->mshr_limit = config->dcache.mshrs;
  dcache->mshr = calloc(dcache->mshr_limit, sizeof *dcache->mshr);
  dcache->next_waiter = calloc((size_t)tm->tps * TRAX_NUM_REGISTERS, sizeof *dcache->next_waiter);
  return trax_cache_tags_create(&dcache->tags, config->dcache.bytes, config->dcache.line_bytes, config->dcache.ways,
                                config->dcache.replacement) &&
         dcache->mshr && dcache->next_waiter;
}

void trax_dcache_destroy(struct trax_dcache *dcache) {
  trax_cache_tags_destroy(&dcache->tags);
  free(dcache->mshr);
  free(dcache->next_waiter);
}

static void wait_for_line(struct trax_dcache *dcache, struct trax_mshr *mshr, struct trax_tp *tp, unsigned number) {
  const unsigned rd = tp->inst->rd;
  if (rd == TRAX_NO_REGISTER)
    return;
  const uint16_t waiter = (uint16_t)(number * TRAX_NUM_REGISTERS + rd);
  dcache->next_waiter[waiter] = mshr->first_waiter;
  mshr->first_waiter = waiter;
  trax_tp_set_usable(tp, rd, TRAX_NEVER, TRAX_CAUSE_DATA_MISS);
}

bool trax_dcache_load(struct trax_dcache *dcache, struct trax_tm *tm, unsigned number, uint64_t t) {
  struct trax_tp *tp = &tm->tp[number];
  const uint32_t line = trax_line_of(&dcache->tags, tp->address);
  if (trax_cache_tags_use(&dcache->tags, line)) {
    tm->stats->dcache_hits++;
    trax_tp_set_usable(tp, tp->inst->rd, t + tm->config->dcache.hit_latency_cycles, TRAX_CAUSE_DATA_HIT);
    return true;
  }
  for (uint32_t i = 0; i < dcache->mshr_count; i++)
    if (dcache->mshr[i].line == line) {
      if (dcache->mshr[i].passing)
        return false;
      tm->stats->dcache_merged++;
      tp->outcome = TRAX_OUTCOME_MERGED;
      wait_for_line(dcache, &dcache->mshr[i], tp, number);
      return true;
    }
  if (dcache->mshr_count == dcache->mshr_limit || !trax_queue_has_place(&tm->queue))
    return false;
  tm->stats->dcache_misses++;
  tp->outcome = TRAX_OUTCOME_MISS;
  trax_tm_request(tm, (struct trax_request){.kind = TRAX_REQUEST_DATA_LINE,
                                            .line = line,
                                            .address = line << dcache->tags.line_shift,
                                            .bytes = tm->config->dcache.line_bytes});
  struct trax_mshr *mshr = &dcache->mshr[dcache->mshr_count++];
  *mshr = (struct trax_mshr){.line = line, .first_waiter = NO_WAITER};
  wait_for_line(dcache, mshr, tp, number);
  trax_arbiter_to_back(&tm->queue_arbiter, number);
  return true;
}

uint32_t trax_dcache_drop(struct trax_dcache *dcache) {
  for (uint32_t i = 0; i < dcache->mshr_count; i++)
    dcache->mshr[i].passing = 1;
  return trax_cache_tags_drop(&dcache->tags);
}

/* The line takes the banks of its words. */
static void fill(struct trax_dcache *dcache, const struct trax_config *config, uint32_t line, uint64_t t) {
  const uint32_t words = config->dcache.line_bytes / 4;
  for (uint32_t i = 0; i < words && i < dcache->banks; i++) {
    uint64_t *const end = &dcache->fills_end[(line * words + i) % dcache->banks];
    *end = (*end > t ? *end : t) + config->dcache.fill_cycles;
    if (*end > dcache->all_fills_end)
      dcache->all_fills_end = *end;
  }
}

void trax_dcache_arrival(struct trax_dcache *dcache, struct trax_tm *tm, uint32_t line, uint64_t t) {
  uint32_t i = 0;
  while (i < dcache->mshr_count && dcache->mshr[i].line != line)
    i++;
  if (i == dcache->mshr_count)
    return; /* only if a checkpoint is wrong, as a cycle of waiters is: each requested line has a miss register */
  if (!dcache->mshr[i].passing) {
    trax_cache_tags_install(&dcache->tags, line);
    if (tm->config->dcache.fill_cycles)
      fill(dcache, tm->config, line, t);
  }
  for (uint16_t waiter = dcache->mshr[i].first_waiter; waiter != NO_WAITER;) {
    const uint16_t next = dcache->next_waiter[waiter];
    dcache->next_waiter[waiter] = NO_WAITER;
    trax_tm_data_arrival(tm, waiter / TRAX_NUM_REGISTERS, waiter % TRAX_NUM_REGISTERS, t);
    waiter = next;
  }
  dcache->mshr[i] = dcache->mshr[--dcache->mshr_count];
}
