/* Counts that the engine keeps in forms of its own: instructions, and refusals of banks and units. */
#include "fast/time/head.h"

#include <string.h>

void trax_fast_collect(void *context) {
  struct trax_chip *chip = context;
  for (uint32_t i = 0; i < chip->tms; i++) {
    struct trax_tm *tm = &chip->tm[i];
    int64_t count = 0;
    for (size_t index = 0; index < chip->program.inst_count; index++) {
      count += tm->count_deltas[index];
      tm->stats->instructions[chip->program.timing[index].decoded->op] += (uint64_t)count;
      tm->count_deltas[index] = 0;
    }
    tm->count_deltas[chip->program.inst_count] = 0;
  }
}

/* Counts the accesses to local memory: all loads and stores that were neither past nor through the data cache. */
static void count_local(struct trax_tm_stats *stats) {
  uint64_t loads = 0, stores = 0;
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++) {
    const unsigned flags = trax_op_table[op].flags;
    loads += (flags & (TRAX_IS_LOAD | TRAX_IS_ATOMIC)) == TRAX_IS_LOAD ? stats->instructions[op] : 0;
    stores += flags & TRAX_IS_STORE ? stats->instructions[op] : 0;
  }
  stats->local_loads =
      loads - stats->dcache_hits - stats->dcache_merged - stats->dcache_misses - stats->nontemporal_loads;
  stats->local_stores = stores - stats->store_hits - stats->store_misses - stats->nontemporal_stores;
}

/* The causes of refusals, in the order of struct trax_fast_refused and of the counters. */
const trax_cause trax_fast_refusal_causes[TRAX_FAST_REFUSALS] = {
#define CAUSE(X, ID, ...) TRAX_CAUSE_##ID,
    TRAX_CAUSE_ICACHE_BANK, TRAX_SHARED_UNITS(CAUSE, ) TRAX_CAUSE_DCACHE_BANK
#undef CAUSE
};

void trax_fast_charge_refusals(struct trax_tm *tm) {
  for (unsigned refused = 0; refused < TRAX_FAST_REFUSALS; refused++)
    for (unsigned tp = 0; tp < tm->tps; tp++)
      tm->tp_stats[tp].cycles[trax_fast_refusal_causes[refused]] += tm->refusal_counts.count[refused][tp];
  memset(&tm->refusal_counts, 0, sizeof tm->refusal_counts);
}

/* Returns how many steps of the current burst have been issued. */
static unsigned issued_of_burst(const struct trax_tm *tm, unsigned tp) {
  return (tm->executes_at_issue | tm->ended) >> tp & 1 ? 0 : tm->heads.at[tp];
}

void trax_fast_read_charges(const struct trax_tm *tm, unsigned number, uint64_t *charges) {
  memcpy(charges, tm->tp_stats[number].cycles, sizeof tm->tp_stats[number].cycles);
  charges[TRAX_CAUSE_ISSUED] += tm->tp[number].issued + issued_of_burst(tm, number);
  for (unsigned refused = 0; refused < TRAX_FAST_REFUSALS; refused++)
    charges[trax_fast_refusal_causes[refused]] += tm->refusal_counts.count[refused][number];
}

void trax_fast_count_rays(struct trax_tm *tm, unsigned number, int32_t code, uint32_t value) {
  uint64_t charges[TRAX_CAUSE_COUNT];
  trax_fast_read_charges(tm, number, charges);
  trax_ray_cycles_trap(tm->ray_counts, &tm->rays[number], charges, code, value);
}

void trax_fast_settle_rays(struct trax_tm *tm) {
  uint64_t charges[TRAX_CAUSE_COUNT];
  for (unsigned tp = 0; tm->ray_counts && tp < tm->tps; tp++) {
    trax_fast_read_charges(tm, tp, charges);
    trax_ray_cycles_add(tm->ray_counts, &tm->rays[tp], charges);
  }
}

/* Counts the issued part of a burst, and takes it off what the burst's end will count. */
static void count_burst(struct trax_tm *tm, unsigned number) {
  struct trax_tp *tp = &tm->tp[number];
  const unsigned issued = issued_of_burst(tm, number);
  uint64_t jumps = 0;
  for (unsigned i = 0; i < issued; i++)
    jumps += trax_fast_index(tp, i + 1) != trax_fast_index(tp, i) + 1;
  tm->tp_stats[number].cycles[TRAX_CAUSE_ISSUED] += tp->issued + issued;
  tm->stats->taken_branches += tp->jumps + jumps;
  tp->issued = -(uint64_t)issued;
  tp->jumps = -jumps;
}

/* Adds (sign 1) or removes (sign -1) the executed instructions that have not been issued. */
static void count_unissued(struct trax_tm *tm, int sign) {
  for (unsigned tp = 0; tp < tm->tps; tp++)
    if (!((tm->executes_at_issue | tm->ended) >> tp & 1))
      trax_fast_count_steps(tm, tp, tm->heads.at[tp], tm->heads.last[tp] + 1u, sign);
}

void trax_fast_settle(struct trax_chip *chip) {
  for (uint32_t i = 0; i < chip->tms; i++) {
    struct trax_tm *tm = &chip->tm[i];
    for (unsigned tp = 0; tp < tm->tps; tp++)
      count_burst(tm, tp);
    trax_fast_charge_refusals(tm);
    count_unissued(tm, -1);
  }
  trax_fast_collect(chip);
  for (uint32_t i = 0; i < chip->tms; i++) {
    count_local(chip->tm[i].stats);
    count_unissued(&chip->tm[i], 1);
  }
}
