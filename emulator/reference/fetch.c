/* docs/timing.md, "Fetch": step 1. */
#include "reference/reference.h"

static uint32_t icache_of(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  return tp->number / tm->config->icache.tps_per_cache;
}

static uint32_t line_of(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  return tp->pc / tm->config->icache.line_bytes;
}

/* A TP that holds no instruction and waits for none asks for one. */
static bool asks(const struct trax_ref_tp *tp) {
  return !tp->charged && !tp->holds && !tp->awaits_line;
}

static void hold(struct trax_ref_tm *tm, struct trax_ref_tp *tp) {
  uint32_t word = 0;
  trax_ref_text(tm, tp->pc, &word);
  tp->inst = trax_decode(word);
  tp->holds = true;
}

static void fault_outside_text(struct trax_ref_tm *tm, uint64_t t) {
  for (uint32_t i = 0; i < tm->tps; i++) {
    struct trax_ref_tp *tp = &tm->tp[i];
    uint32_t word;
    const trax_fault_kind kind = asks(tp) ? trax_ref_text(tm, tp->pc, &word) : TRAX_FAULT_NONE;
    if (kind)
      trax_ref_fault(tm, tp, t, kind, tp->pc);
  }
}

static uint32_t bank_of(const struct trax_ref_tm *tm, const struct trax_ref_tp *tp) {
  return tp->pc / 4 % tm->config->icache.banks;
}

/* Grants a bank: marks the winners among the cache's n TPs, which begin with `first`, and charges the losers. */
static void grant_bank(struct trax_ref_tm *tm, uint32_t bank, uint32_t first, uint32_t n, uint64_t t, bool *won) {
  trax_ref_pointer *pointer = &tm->icache[icache_of(tm, &tm->tp[first])].bank[bank];
  bool asking[MOST] = {false};
  for (uint32_t i = 0; i < n; i++)
    asking[i] = asks(&tm->tp[first + i]) && bank_of(tm, &tm->tp[first + i]) == bank;
  for (uint32_t port = 0; port < tm->config->icache.ports_per_bank; port++) {
    const int winner = trax_ref_arbitrate(pointer, asking, n);
    if (winner < 0)
      break;
    asking[winner] = false;
    won[first + (uint32_t)winner] = true;
  }
  for (uint32_t i = 0; i < n; i++)
    if (asking[i])
      trax_ref_charge(tm, &tm->tp[first + i], t, TRAX_CAUSE_ICACHE_BANK);
}

bool trax_ref_look_up(struct trax_ref_tm *tm, struct trax_ref_tp *tp, uint64_t t) {
  const uint32_t icache = icache_of(tm, tp), line = line_of(tm, tp);
  if (trax_ref_lines_have(&tm->icache[icache].lines, line)) {
    tm->stats->icache_hits++;
    return true;
  }
  if (trax_ref_on_its_way(tm, INSTRUCTION_LINE, icache, line)) {
    tm->stats->icache_merged++;
    tp->awaits_line = true;
  } else if (trax_ref_request(tm, (struct trax_ref_request){.kind = INSTRUCTION_LINE,
                                                            .icache = icache,
                                                            .line = line,
                                                            .address = line * tm->config->icache.line_bytes,
                                                            .bytes = tm->config->icache.line_bytes})) {
    tm->stats->icache_misses++;
    tp->awaits_line = true;
  } else {
    trax_ref_charge(tm, tp, t, TRAX_CAUSE_MEMORY_QUEUE);
  }
  return false;
}

void trax_ref_fetch(struct trax_ref_tm *tm, uint64_t t) {
  fault_outside_text(tm, t);
  const uint32_t size = tm->config->icache.tps_per_cache;
  bool won[MOST] = {false};
  for (uint32_t first = 0; first < tm->tps; first += size)
    for (uint32_t bank = 0; bank < tm->config->icache.banks; bank++)
      grant_bank(tm, bank, first, first + size < tm->tps ? size : tm->tps - first, t, won);
  for (uint32_t i = 0; i < tm->tps; i++)
    if (won[i] && trax_ref_look_up(tm, &tm->tp[i], t))
      hold(tm, &tm->tp[i]);
  for (uint32_t i = 0; i < tm->tps; i++)
    if (tm->tp[i].awaits_line)
      trax_ref_charge(tm, &tm->tp[i], t, TRAX_CAUSE_ICACHE_MISS);
}

void trax_ref_instruction_arrives(struct trax_ref_tm *tm, uint32_t icache, uint32_t line) {
  trax_ref_lines_install(&tm->icache[icache].lines, line);
  for (uint32_t i = 0; i < tm->tps; i++) {
    struct trax_ref_tp *tp = &tm->tp[i];
    if (tp->awaits_line && icache_of(tm, tp) == icache && line_of(tm, tp) == line) {
      tp->awaits_line = false;
      hold(tm, tp);
    }
  }
}
