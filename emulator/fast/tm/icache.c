#include "fast/tm/icache.h"

#include "fast/tm/tm.h"

#include <stdlib.h>

bool trax_icache_create(struct trax_icache *icache, const struct trax_tm *tm) {
  icache->pending = calloc(tm->tps, sizeof *icache->pending);
  return trax_cache_tags_create(&icache->tags, tm->config->icache.bytes, tm->config->icache.line_bytes,
                                tm->config->icache.ways, TRAX_REPLACE_FIFO) &&
         icache->pending;
}

void trax_icache_destroy(struct trax_icache *icache) {
  trax_cache_tags_destroy(&icache->tags);
  free(icache->pending);
}

void trax_icache_miss(struct trax_icache *icache, struct trax_tm *tm, unsigned tp, uint64_t t) {
  const uint64_t bit = (uint64_t)1 << tp;
  const uint32_t line = trax_line_of(&icache->tags, tm->tp[tp].pc);
  for (uint32_t i = 0; i < icache->pending_count; i++)
    if (icache->pending[i].line == line) {
      tm->stats->icache_merged++;
      icache->pending[i].waiting |= bit;
      trax_tm_sleep(tm, tp, t, TRAX_CAUSE_ICACHE_MISS);
      return;
    }
  if (!trax_queue_has_place(&tm->queue)) {
    trax_tm_charge(tm, tp, TRAX_CAUSE_MEMORY_QUEUE);
    return;
  }
  tm->stats->icache_misses++;
  trax_tm_request(tm, (struct trax_request){.kind = TRAX_REQUEST_INSTRUCTION_LINE,
                                            .icache = tm->icache_of[tp],
                                            .line = line,
                                            .address = line << icache->tags.line_shift,
                                            .bytes = tm->config->icache.line_bytes});
  icache->pending[icache->pending_count++] = (struct trax_icache_pending){.line = line, .waiting = bit};
  trax_tm_sleep(tm, tp, t, TRAX_CAUSE_ICACHE_MISS);
}

void trax_icache_arrival(struct trax_icache *icache, struct trax_tm *tm, uint32_t line, uint64_t t) {
  icache->evicted = trax_cache_tags_install(&icache->tags, line);
  for (uint32_t i = 0; i < icache->pending_count; i++)
    if (icache->pending[i].line == line) {
      tm->holding |= icache->pending[i].waiting;
      for (uint64_t waiting = icache->pending[i].waiting; waiting; waiting &= waiting - 1)
        trax_tm_wake(tm, trax_first(waiting), t);
      icache->pending[i] = icache->pending[--icache->pending_count];
      return;
    }
}
