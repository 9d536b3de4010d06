#include "machine/machine.h"
#include "machine/timing.h"

#include <inttypes.h>

/* Counts that follow from the operations issued are computed at the end instead of being counted during the run. */
void trax_stats_derive(struct trax_tm_stats *stats, const struct trax_config *config) {
  stats->fences += stats->instructions[TRAX_OP_FENCE];
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++) {
    const trax_op_info *info = &trax_op_table[op];
    const uint64_t count = stats->instructions[op];
    if (info->flags & TRAX_IS_FLOP)
      stats->flops += count;
    if (info->flags & TRAX_IS_ATOMIC)
      stats->atomics += count;
    switch (trax_timing_of((trax_op)op, config).unit) {
#define ADD(X, ID, NAME, ...)                                                                                          \
  case TRAX_SHARED_##ID:                                                                                               \
    stats->NAME##_ops += count;                                                                                        \
    break;
      TRAX_SHARED_UNITS(ADD, )
#undef ADD
    case TRAX_SHARED_NONE:
      break;
    }
  }
}

static void add_stats(struct trax_tm_stats *sum, const struct trax_tm_stats *term) {
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    sum->cycles[cause] += term->cycles[cause];
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
    sum->instructions[op] += term->instructions[op];
#define ADD(ID, NAME, UNIT, MEANING) sum->ID += term->ID;
  TRAX_TM_COUNTERS(ADD)
#undef ADD
}

void trax_stats_sum(const struct trax_machine *machine, struct trax_stats *stats) {
  const uint32_t tps = machine->config.chip.tps_per_tm;
  stats->total = (struct trax_tm_stats){0};
  for (uint32_t i = 0; i < machine->config.chip.tms; i++) {
    struct trax_tm_stats tm = machine->tm_stats[i];
    trax_stats_derive(&tm, &machine->config);
    for (uint32_t tp = 0; tp < tps; tp++)
      for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
        tm.cycles[cause] += machine->tp_stats[(size_t)i * tps + tp].cycles[cause];
    add_stats(&stats->total, &tm);
  }
  stats->instructions = stats->total.cycles[TRAX_CAUSE_ISSUED];
}

trax_status trax_stats_collect(struct trax_machine *machine, bool charged, trax_error *error) {
  const uint32_t tps = machine->config.chip.tps_per_tm;
  for (uint32_t i = 0; i < machine->config.chip.tms; i++) {
    struct trax_tm_stats *stats = &machine->tm_stats[i];
    trax_stats_derive(stats, &machine->config);
    for (uint32_t tp = 0; tp < tps; tp++) {
      const struct trax_tp_stats *charges = &machine->tp_stats[(size_t)i * tps + tp];
      uint64_t charged = 0;
      for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++) {
        stats->cycles[cause] += charges->cycles[cause];
        charged += charges->cycles[cause];
      }
      if (charged != machine->stats.cycles)
        return trax_fail(error, "internal error: TM %u, TP %u is charged for %" PRIu64 " of %" PRIu64 " cycles", i, tp,
                         charged, machine->stats.cycles);
    }
    add_stats(&machine->stats.total, stats);
  }
  if (charged)
    machine->stats.instructions = machine->stats.total.cycles[TRAX_CAUSE_ISSUED];
  else
    for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
      machine->stats.instructions += machine->stats.total.instructions[op];
  return TRAX_OK;
}
