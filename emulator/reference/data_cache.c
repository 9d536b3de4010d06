/* docs/timing.md, "Data cache". */
#include "reference/reference.h"

/* Only cached loads and stores of global memory use a bank. */
bool trax_ref_asks_for_bank(const struct trax_ref_tp *tp) {
  return trax_ref_active(tp) && trax_ref_accesses_memory(tp) && !trax_ref_accesses_local(tp) &&
         !trax_ref_is(tp, TRAX_IS_NONTEMPORAL | TRAX_IS_ATOMIC);
}

uint32_t trax_ref_data_banks(const struct trax_ref_tm *tm) {
  const uint32_t per_bank = tm->config->dcache.tps_per_bank;
  return (tm->tps + per_bank - 1) / per_bank;
}

void trax_ref_grant_data_banks(struct trax_ref_tm *tm, uint64_t t) {
  const uint32_t banks = trax_ref_data_banks(tm);
  for (uint32_t bank = 0; bank < banks; bank++) {
    bool asks[MOST] = {false};
    for (uint32_t i = 0; i < tm->tps; i++)
      asks[i] = trax_ref_asks_for_bank(&tm->tp[i]) && tm->tp[i].address / 4 % banks == bank;
    const bool filling = t < tm->dcache_fills_end[bank];
    const int winner = filling ? -1 : trax_ref_arbitrate(&tm->dcache_bank[bank], asks, tm->tps);
    for (uint32_t i = 0; i < tm->tps; i++)
      if (asks[i] && (int)i != winner)
        trax_ref_charge(tm, &tm->tp[i], t, TRAX_CAUSE_DCACHE_BANK);
  }
}

static void wait_for_line(struct trax_ref_tp *tp, uint32_t line) {
  trax_ref_result(tp, UNKNOWN, TRAX_CAUSE_DATA_MISS);
  tp->awaits_data |= 1u << tp->inst.rd & ~1u; /* r0 waits for nothing */
  tp->scoreboard[tp->inst.rd].line = line;
}

bool trax_ref_load(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  const uint32_t line = tp->address / tm->config->dcache.line_bytes;
  if (trax_ref_lines_use(&tm->dcache, line)) {
    tm->stats->dcache_hits++;
    tp->outcome |= TRAX_OUTCOME_HIT;
    trax_ref_result(tp, t + tm->config->dcache.hit_latency_cycles, TRAX_CAUSE_DATA_HIT);
    return true;
  }
  const struct trax_ref_request *request = trax_ref_on_its_way(tm, DATA_LINE, 0, line);
  if (request && request->passing)
    return false;
  if (request) {
    tm->stats->dcache_merged++;
    tp->outcome |= TRAX_OUTCOME_MERGED;
    wait_for_line(tp, line);
    return true;
  }
  if (trax_ref_lines_on_their_way(tm, DATA_LINE) == tm->config->dcache.mshrs ||
      !trax_ref_request(tm, (struct trax_ref_request){.kind = DATA_LINE,
                                                      .line = line,
                                                      .address = line * tm->config->dcache.line_bytes,
                                                      .bytes = tm->config->dcache.line_bytes}))
    return false;
  tm->stats->dcache_misses++;
  tp->outcome |= TRAX_OUTCOME_MISS;
  wait_for_line(tp, line);
  return true;
}

/* The line takes the banks of its words. */
static void fill(struct trax_ref_tm *tm, uint32_t line, uint64_t t) {
  const uint32_t banks = trax_ref_data_banks(tm);
  const uint32_t words = tm->config->dcache.line_bytes / 4;
  for (uint32_t bank = 0; bank < banks; bank++)
    for (uint32_t word = 0; word < words; word++)
      if ((line * words + word) % banks == bank) {
        uint64_t *const end = &tm->dcache_fills_end[bank];
        *end = (*end > t ? *end : t) + tm->config->dcache.fill_cycles;
        break;
      }
}

void trax_ref_data_arrives(struct trax_ref_tm *tm, const struct trax_ref_request *request, uint64_t t) {
  if (!request->passing) {
    trax_ref_lines_install(&tm->dcache, request->line);
    fill(tm, request->line, t);
  }
  for (uint32_t i = 0; i < tm->tps; i++) {
    struct trax_ref_tp *tp = &tm->tp[i];
    for (uint32_t set = tp->awaits_data; set; set &= set - 1) {
      struct trax_ref_register *reg = &tp->scoreboard[__builtin_ctz(set)];
      if (reg->line == request->line) {
        tp->awaits_data &= ~(set & -set);
        reg->usable = t;
      }
    }
  }
}
