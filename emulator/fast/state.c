#include "fast/chip.h"

#include "fast/memory/l2.h"

struct visitor {
  trax_section_visitor *visit;
  void *context;
};

/* --- fields --- */

#define FIELDS(NAME, LIST) static const struct trax_field NAME##_fields[] = {LIST(TRAX_FIELD_ROW, struct NAME)}
FIELDS(trax_icache_pending, TRAX_ICACHE_PENDING_STATE);
FIELDS(trax_icache, TRAX_ICACHE_STATE);
FIELDS(trax_mshr, TRAX_MSHR_STATE);
FIELDS(trax_dcache, TRAX_DCACHE_STATE);
FIELDS(trax_request, TRAX_REQUEST_STATE);
FIELDS(trax_queue, TRAX_QUEUE_STATE);
FIELDS(trax_fast_units, TRAX_FAST_UNITS_STATE);
FIELDS(trax_shared_unit, TRAX_SHARED_UNIT_STATE);
FIELDS(trax_tp, TRAX_TP_STATE);
FIELDS(trax_tm, TRAX_TM_STATE);
FIELDS(trax_request_list, TRAX_REQUEST_LIST_STATE);
FIELDS(trax_waiting, TRAX_WAITING_STATE);
FIELDS(trax_instant, TRAX_INSTANT_STATE);
FIELDS(trax_channel, TRAX_CHANNEL_STATE);
FIELDS(trax_dram_request, TRAX_DRAM_REQUEST_STATE);
FIELDS(trax_dram_bank, TRAX_DRAM_BANK_STATE);
FIELDS(trax_dram_rank, TRAX_DRAM_RANK_STATE);
FIELDS(trax_dram_channel, TRAX_DRAM_CHANNEL_STATE);
FIELDS(trax_l2_mshr, TRAX_L2_MSHR_STATE);
FIELDS(trax_l2, TRAX_L2_STATE);

/* --- sections --- */

#define COUNT_OF(ARRAY) (sizeof(ARRAY) / sizeof *(ARRAY))
#define VISIT(...) visitor->visit(visitor->context, &(struct trax_section){__VA_ARGS__})

/* Visits an array of structures. */
#define VISIT_ALL(NAME, POINTER, COUNT)                                                                                \
  VISIT(#NAME, NAME##_fields, COUNT_OF(NAME##_fields), POINTER, sizeof(struct NAME), COUNT)

/* Visits no structure, but adds the fields of one that is only a field of others to the layout. */
#define VISIT_NONE(NAME) VISIT_ALL(NAME, NULL, 0)

/* Visits an array of numbers. */
#define VISIT_NUMBERS(TYPE, POINTER, COUNT)                                                                            \
  VISIT(#POINTER, &(const struct trax_field){#TYPE, "", 0, sizeof(TYPE)}, 1, 1 ? (POINTER) : (TYPE *)NULL,             \
        sizeof(TYPE), COUNT)

/* Visits an array of structures of statistics, each as one field: its counters are part of the layout's sources. */
#define VISIT_COUNTERS(NAME, POINTER, COUNT)                                                                           \
  VISIT(#NAME, &(const struct trax_field){"uint64_t", "", 0, sizeof(struct NAME)}, 1, POINTER, sizeof(struct NAME),    \
        COUNT)

/* Visits data that follow from the rest: they are part of a snapshot, but not of a checkpoint. */
#define VISIT_DERIVED(POINTER, COUNT) VISIT(#POINTER, NULL, 0, POINTER, sizeof *(POINTER), COUNT)

static void visit_tags(const struct visitor *visitor, struct trax_cache_tags *tags) {
  const size_t sets = (size_t)tags->set_mask + 1;
  VISIT_NUMBERS(uint32_t, tags->lines, sets * tags->ways);
  VISIT_NUMBERS(uint32_t, tags->next, sets);
}

static void visit_queue(const struct visitor *visitor, struct trax_queue *queue) {
  VISIT_ALL(trax_queue, queue, 1);
  VISIT_ALL(trax_request, queue->requests, queue->depth);
  VISIT_DERIVED(queue->places, queue->depth);
}

static void visit_unit(const struct visitor *visitor, struct trax_shared_unit *unit) {
  VISIT_ALL(trax_shared_unit, unit, 1);
  VISIT_NUMBERS(uint64_t, unit->free_from, trax_shared_unit_count(unit));
}

static void visit_icache(const struct visitor *visitor, struct trax_icache *icache, uint32_t tps) {
  VISIT_ALL(trax_icache, icache, 1);
  VISIT_ALL(trax_icache_pending, icache->pending, tps);
  visit_tags(visitor, &icache->tags);
}

static void visit_dcache(const struct visitor *visitor, struct trax_dcache *dcache, uint32_t tps) {
  VISIT_ALL(trax_dcache, dcache, 1);
  VISIT_ALL(trax_mshr, dcache->mshr, dcache->mshr_limit);
  VISIT_NUMBERS(uint16_t, dcache->next_waiter, (size_t)tps * TRAX_NUM_REGISTERS);
  visit_tags(visitor, &dcache->tags);
}

static void visit_tm(const struct visitor *visitor, struct trax_tm *tm) {
  VISIT_ALL(trax_tm, tm, 1); /* the structures in it have field lists of their own and are visited below */
  VISIT_ALL(trax_tp, tm->tp, tm->tps);
  for (unsigned i = 0; i < TRAX_SHARED_COUNT; i++)
    visit_unit(visitor, &tm->unit[i]);
  VISIT_ALL(trax_fast_units, &tm->fp, 1);
  VISIT_NUMBERS(trax_arbiter, tm->fetch_arbiters, (size_t)tm->icaches * tm->config->icache.banks);
  for (uint32_t i = 0; i < tm->icaches; i++)
    visit_icache(visitor, &tm->icache[i], tm->tps);
  visit_dcache(visitor, &tm->dcache, tm->tps);
  visit_queue(visitor, &tm->queue);
  VISIT_COUNTERS(trax_tm_stats, tm->stats, 1);
  VISIT_COUNTERS(trax_tp_stats, tm->tp_stats, tm->tps);
  VISIT_NUMBERS(int32_t, tm->exit_statuses, tm->tps);
  /* The program and the states of blocks are not visited: they stay valid after a roll back. */
  VISIT_DERIVED(tm->count_deltas, tm->chip->program.inst_count + 1);
  VISIT_DERIVED(tm->ray_counts, tm->ray_counts ? 1 : 0); /* no checkpoint has them */
  VISIT_DERIVED(tm->rays, tm->rays ? tm->tps : 0);
  VISIT_DERIVED(tm->resident, tm->icaches);
  VISIT_DERIVED(tm->observed, tm->observed ? 1 : 0);
}

static void visit_l2(const struct visitor *visitor, struct trax_l2 *l2) {
  VISIT_ALL(trax_l2, l2, 1);
  VISIT_ALL(trax_waiting, l2->bank, l2->banks);
  VISIT_ALL(trax_l2_mshr, l2->mshr, l2->mshr_limit);
  visit_tags(visitor, &l2->tags);
}

static void visit_dram(const struct visitor *visitor, const struct trax_dram *dram) {
  const struct trax_config *config = dram->config;
  VISIT_ALL(trax_dram_channel, dram->channel, config->memory.channels);
  for (uint32_t i = 0; i < config->memory.channels; i++) {
    struct trax_dram_channel *channel = &dram->channel[i];
    for (unsigned queue = 0; queue < TRAX_DRAM_QUEUES; queue++)
      VISIT_ALL(trax_dram_request, channel->request[queue], dram->capacity[queue]);
    VISIT_ALL(trax_dram_rank, channel->rank, config->dram.ranks);
    VISIT_ALL(trax_dram_bank, channel->bank, config->dram.ranks * config->dram.banks);
  }
}

static void visit_memory(const struct visitor *visitor, struct trax_memory *memory) {
  VISIT_DERIVED(memory, 1);
  VISIT_ALL(trax_channel, memory->channel, memory->channels);
  for (uint32_t i = 0; i < memory->channels; i++)
    VISIT_ALL(trax_waiting, &memory->channel[i].waiting, 1);
  VISIT_COUNTERS(trax_memory_stats, memory->stats, 1);
  if (memory->dram)
    visit_dram(visitor, memory->dram);
  if (memory->l2)
    visit_l2(visitor, memory->l2);
}

void trax_state_visit(void *state, trax_section_visitor *visit, void *context) {
  struct trax_chip *chip = state;
  const struct visitor the_visitor = {visit, context}, *visitor = &the_visitor;
  VISIT_NONE(trax_request_list);
  VISIT_NONE(trax_instant);
  for (uint32_t i = 0; i < chip->tms; i++)
    visit_tm(visitor, &chip->tm[i]);
  visit_memory(visitor, &chip->memory);
}
