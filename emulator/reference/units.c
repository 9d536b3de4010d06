/* docs/timing.md, "Units": step 3 but for the data cache's banks. */
#include "reference/reference.h"

/* What an instruction executes on. */
static trax_unit unit_of(const struct trax_ref_tp *tp, const struct trax_config *config) {
  const trax_unit unit = trax_ref_info(tp)->unit;
  const bool compares = unit == TRAX_UNIT_FP_ADD && !trax_ref_is(tp, TRAX_IS_FLOP);
  return compares && config->fpu.compare_units ? TRAX_UNIT_INT /* the TP's own */ : unit;
}

uint32_t trax_ref_latency(const struct trax_ref_tp *tp, const struct trax_config *config) {
  switch (tp->inst.op) {
  case TRAX_OP_MUL:
  case TRAX_OP_MULH:
  case TRAX_OP_MULHU:
    return config->int_mul.latency_cycles;
  case TRAX_OP_FADD:
  case TRAX_OP_FSUB:
    return config->fpu.add_latency_cycles;
  case TRAX_OP_FMIN:
  case TRAX_OP_FMAX:
  case TRAX_OP_FEQ:
  case TRAX_OP_FLT:
  case TRAX_OP_FLE:
    return config->fpu.compare_latency_cycles;
  case TRAX_OP_FCVT_W_S:
  case TRAX_OP_FCVT_WU_S:
  case TRAX_OP_FCVT_S_W:
  case TRAX_OP_FCVT_S_WU:
    return config->fpu.convert_latency_cycles;
  case TRAX_OP_FMUL:
    return config->fpu.mul_latency_cycles;
  case TRAX_OP_FDIV:
    return config->special.latency_cycles;
  case TRAX_OP_FRSQRT:
    return config->special.rsqrt_latency_cycles ? config->special.rsqrt_latency_cycles : config->special.latency_cycles;
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

/* `count` units for each group of `size` TPs. */
static void grant_shared(struct trax_ref_tm *tm, trax_unit unit, uint32_t size, uint32_t count, trax_ref_turn *turns,
                         uint64_t t, trax_cause cause) {
  bool asks[MOST] = {false};
  find_askers(tm, unit, asks);
  for (uint32_t first = 0; first < tm->tps; first += size) {
    const uint32_t n = first + size < tm->tps ? size : tm->tps - first;
    for (uint32_t i = 0; i < count; i++) {
      const int winner = trax_ref_pick(&turns[first / size], asks + first, n);
      if (winner >= 0)
        asks[first + (uint32_t)winner] = false;
    }
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
    tm->special_free[unit] = t + (config->special.pipelined ? 1 : trax_ref_latency(&tm->tp[winner], config));
  }
  charge_losers(tm, asks, t, TRAX_CAUSE_SPECIAL);
}

void trax_ref_grant_units(struct trax_ref_tm *tm, uint64_t t) {
  const struct trax_config *config = tm->config;
  const uint32_t adder_size = config->fpu.tps_per_cluster;
  const uint32_t multiplier_size = config->fpu.mul_tps_per_cluster ? config->fpu.mul_tps_per_cluster : adder_size;
  grant_shared(tm, TRAX_UNIT_FP_ADD, adder_size, config->fpu.adders_per_cluster, tm->fp_add, t, TRAX_CAUSE_FP_ADD);
  grant_shared(tm, TRAX_UNIT_FP_MUL, multiplier_size, config->fpu.multipliers_per_cluster, tm->fp_mul, t,
               TRAX_CAUSE_FP_MUL);
  grant_shared(tm, TRAX_UNIT_INT_MUL, config->int_mul.tps_per_unit, config->int_mul.units_per_group, tm->int_mul, t,
               TRAX_CAUSE_INT_MUL);
  grant_special(tm, t);
}
