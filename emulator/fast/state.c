#include "fast/chip.h"

#include "fast/memory/l2.h"

static void visit_tags(const struct trax_visitor *visitor, struct trax_cache_tags *tags) {
  const size_t sets = (size_t)tags->set_mask + 1;
  TRAX_VISIT_NUMBERS(uint32_t, tags->lines, sets * tags->ways);
  TRAX_VISIT_NUMBERS(uint32_t, tags->next, sets);
}

static void visit_queue(const struct trax_visitor *visitor, struct trax_queue *queue) {
  TRAX_VISIT_WITHIN(trax_queue, TRAX_QUEUE_STATE, queue, 1);
  TRAX_VISIT_ALL(trax_request, TRAX_REQUEST_STATE, queue->requests, queue->depth);
  TRAX_VISIT_DERIVED(queue->places, queue->depth);
}

static void visit_unit(const struct trax_visitor *visitor, struct trax_shared_unit *unit) {
  TRAX_VISIT_WITHIN(trax_shared_unit, TRAX_SHARED_UNIT_STATE, unit, 1);
  TRAX_VISIT_NUMBERS(uint64_t, unit->free_from, trax_shared_unit_count(unit));
}

static void visit_icache(const struct trax_visitor *visitor, struct trax_icache *icache, uint32_t tps) {
  TRAX_VISIT_ALL(trax_icache, TRAX_ICACHE_STATE, icache, 1);
  TRAX_VISIT_ALL(trax_icache_pending, TRAX_ICACHE_PENDING_STATE, icache->pending, tps);
  visit_tags(visitor, &icache->tags);
}

static void visit_dcache(const struct trax_visitor *visitor, struct trax_dcache *dcache, uint32_t tps) {
  TRAX_VISIT_WITHIN(trax_dcache, TRAX_DCACHE_STATE, dcache, 1);
  TRAX_VISIT_ALL(trax_mshr, TRAX_MSHR_STATE, dcache->mshr, dcache->mshr_limit);
  TRAX_VISIT_NUMBERS(uint16_t, dcache->next_waiter, (size_t)tps *TRAX_NUM_REGISTERS);
  visit_tags(visitor, &dcache->tags);
}

static void visit_tm(const struct trax_visitor *visitor, struct trax_tm *tm) {
  TRAX_VISIT_ALL(trax_tm, TRAX_TM_STATE, tm, 1); /* the structures in it have lists of their own */
  TRAX_VISIT_ALL(trax_tp, TRAX_TP_STATE, tm->tp, tm->tps);
  for (unsigned i = 0; i < TRAX_SHARED_COUNT; i++)
    visit_unit(visitor, &tm->unit[i]);
  TRAX_VISIT_WITHIN(trax_fast_units, TRAX_FAST_UNITS_STATE, &tm->fp, 1);
  TRAX_VISIT_NUMBERS(trax_arbiter, tm->fetch_arbiters, (size_t)tm->icaches * tm->config->icache.banks);
  for (uint32_t i = 0; i < tm->icaches; i++)
    visit_icache(visitor, &tm->icache[i], tm->tps);
  visit_dcache(visitor, &tm->dcache, tm->tps);
  visit_queue(visitor, &tm->queue);
  TRAX_VISIT_COUNTERS(trax_tm_stats, tm->stats, 1);
  TRAX_VISIT_COUNTERS(trax_tp_stats, tm->tp_stats, tm->tps);
  TRAX_VISIT_NUMBERS(int32_t, tm->exit_statuses, tm->tps);
  /* The program and the states of blocks are not visited: they stay valid after a roll back. */
  TRAX_VISIT_DERIVED(tm->count_deltas, tm->chip->program.inst_count + 1);
  TRAX_VISIT_DERIVED(tm->ray_counts, tm->ray_counts ? 1 : 0); /* no checkpoint has them */
  TRAX_VISIT_DERIVED(tm->rays, tm->rays ? tm->tps : 0);
  TRAX_VISIT_DERIVED(tm->resident, tm->icaches);
  TRAX_VISIT_DERIVED(tm->observed, tm->observed ? 1 : 0);
}

static void visit_l2(const struct trax_visitor *visitor, struct trax_l2 *l2) {
  TRAX_VISIT_ALL(trax_l2, TRAX_L2_STATE, l2, 1);
  TRAX_VISIT_ALL(trax_waiting, TRAX_WAITING_STATE, l2->bank, l2->banks);
  TRAX_VISIT_ALL(trax_l2_mshr, TRAX_L2_MSHR_STATE, l2->mshr, l2->mshr_limit);
  visit_tags(visitor, &l2->tags);
}

static void visit_memory(const struct trax_visitor *visitor, struct trax_memory *memory) {
  TRAX_VISIT_DERIVED(memory, 1);
  TRAX_VISIT_WITHIN(trax_channel, TRAX_CHANNEL_STATE, memory->channel, memory->channels);
  for (uint32_t i = 0; i < memory->channels; i++)
    TRAX_VISIT_WITHIN(trax_waiting, TRAX_WAITING_STATE, &memory->channel[i].waiting, 1);
  TRAX_VISIT_COUNTERS(trax_memory_stats, memory->stats, 1);
  if (memory->dram)
    trax_dram_visit(memory->dram, visitor);
  if (memory->l2)
    visit_l2(visitor, memory->l2);
}

void trax_state_visit(void *state, trax_section_visitor *visit, void *context) {
  struct trax_chip *chip = state;
  const struct trax_visitor the_visitor = {visit, context}, *visitor = &the_visitor;
  TRAX_VISIT_NONE(trax_request_list, TRAX_REQUEST_LIST_STATE);
  TRAX_VISIT_NONE(trax_instant, TRAX_INSTANT_STATE);
  for (uint32_t i = 0; i < chip->tms; i++)
    visit_tm(visitor, &chip->tm[i]);
  visit_memory(visitor, &chip->memory);
}
