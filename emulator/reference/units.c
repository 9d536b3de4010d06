/* docs/timing.md, "Units": step 3 but for the data cache's banks. */
#include "reference/reference.h"

/* What an instruction executes on. */
static trax_unit unit_of(const struct trax_ref_tp *tp, const struct trax_config *config) {
  const trax_unit unit = trax_ref_info(tp)->unit;
  const bool compares = unit == TRAX_UNIT_FP_ADD && !trax_ref_is(tp, TRAX_IS_FLOP);
  return compares && config->fpu.compare_units ? TRAX_UNIT_INT /* the TP's own */ : unit;
}

static bool converts(const struct trax_ref_tp *tp) {
  const trax_op op = tp->inst.op;
  return op == TRAX_OP_FCVT_S_W || op == TRAX_OP_FCVT_S_WU || op == TRAX_OP_FCVT_W_S || op == TRAX_OP_FCVT_WU_S;
}

uint32_t trax_ref_latency(const struct trax_ref_tp *tp, const struct trax_config *config) {
  switch (trax_ref_info(tp)->unit) {
  case TRAX_UNIT_INT_MUL:
    return config->int_mul.latency_cycles;
  case TRAX_UNIT_FP_ADD:
    return trax_ref_is(tp, TRAX_IS_FLOP) ? config->fpu.add_latency_cycles
           : converts(tp)                ? config->fpu.convert_latency_cycles
                                         : config->fpu.compare_latency_cycles;
  case TRAX_UNIT_FP_MUL:
    return config->fpu.mul_latency_cycles;
  case TRAX_UNIT_SPECIAL:
    return config->special.latency_cycles;
  default:
    return config->tp.int_latency_cycles;
  }
}

static void find_askers(const struct trax_ref_tm *tm, trax_unit unit, bool *asks) {
  for (uint32_t i = 0; i < tm->tps; i++)
    asks[i] = trax_ref_active(&tm->tp[i]) && unit_of(&tm->tp[i], tm->config) == unit;
}

static void charge_losers(struct trax_ref_tm *tm, const bool *asks, uint64_t t, trax_cause cause) {
  for (uint32_t i = 0; i < tm->tps; i++)
    if (asks[i])
      trax_ref_charge(tm, &tm->tp[i], t, cause);
}

/* One unit for each group of `size` TPs. */
static void grant_shared(struct trax_ref_tm *tm, trax_unit unit, uint32_t size, trax_ref_turn *turns, uint64_t t,
                         trax_cause cause) {
  bool asks[MOST] = {false};
  find_askers(tm, unit, asks);
  for (uint32_t first = 0; first < tm->tps; first += size) {
    const uint32_t n = first + size < tm->tps ? size : tm->tps - first;
    const int winner = trax_ref_pick(&turns[first / size], asks + first, n);
    if (winner >= 0)
      asks[first + (uint32_t)winner] = false;
  }
  charge_losers(tm, asks, t, cause);
}

static void grant_special(struct trax_ref_tm *tm, uint64_t t) {
  const struct trax_config *config = tm->config;
  bool asks[MOST] = {false};
  find_askers(tm, TRAX_UNIT_SPECIAL, asks);
  for (uint32_t unit = 0; unit < config->special.units_per_tm; unit++) {
    if (tm->special_free[unit] > t)
      continue;
    const int winner = trax_ref_pick(&tm->special, asks, tm->tps);
    if (winner < 0)
      break;
    asks[winner] = false;
    tm->special_free[unit] = t + (config->special.pipelined ? 1 : config->special.latency_cycles);
  }
  charge_losers(tm, asks, t, TRAX_CAUSE_SPECIAL);
}

void trax_ref_grant_units(struct trax_ref_tm *tm, uint64_t t) {
  const struct trax_config *config = tm->config;
  grant_shared(tm, TRAX_UNIT_FP_ADD, config->fpu.tps_per_cluster, tm->fp_add, t, TRAX_CAUSE_FP_ADD);
  grant_shared(tm, TRAX_UNIT_FP_MUL, config->fpu.tps_per_cluster, tm->fp_mul, t, TRAX_CAUSE_FP_MUL);
  grant_shared(tm, TRAX_UNIT_INT_MUL, config->int_mul.tps_per_unit, tm->int_mul, t, TRAX_CAUSE_INT_MUL);
  grant_special(tm, t);
}
