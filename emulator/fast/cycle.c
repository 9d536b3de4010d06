/* The five steps of a TM's cycle on masks of its TPs (docs/timing.md, "A cycle"). */
#include "fast/head.h"

static inline unsigned count_bits(uint64_t mask) {
  return (unsigned)__builtin_popcountll(mask);
}

/* --- arrivals and alarms --- */

/* Returns those who wake with their instruction; the others ask for one. */
static uint64_t wake(struct trax_fast_tm *ftm, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  const uint64_t awake = tm->awake;
  if (tm->queue.started && trax_queue_oldest(&tm->queue)->completion <= t) {
    uint32_t pending = 0;
    for (uint32_t i = 0; i < tm->icaches; i++)
      pending += tm->icache[i].pending_count;
    trax_tm_arrive(tm, t);
    for (uint32_t i = 0; i < tm->icaches; i++)
      pending -= tm->icache[i].pending_count;
    if (pending)
      ftm->same_line = 0; /* an instruction line came, and perhaps in the place of another */
  }
  if (tm->wheel_occupied >> t % TRAX_WHEEL & 1)
    trax_tm_wake_sleepers(tm, t);
  const uint64_t woken = tm->awake & ~awake;
  for (uint64_t rest = woken & ~tm->holding; rest; rest &= rest - 1)
    trax_fast_ask_fetch(ftm, trax_first(rest));
  return woken & tm->holding;
}

/* --- step 1 --- */

static void fault_outside(struct trax_fast_tm *ftm, uint64_t t) {
  for (; ftm->outside; ftm->outside &= ftm->outside - 1) {
    const unsigned number = trax_first(ftm->outside);
    const uint32_t pc = ftm->tm->tp[number].pc;
    trax_tm_fault(ftm->tm, number, t, pc % 4 ? TRAX_FAULT_MISALIGNED_PC : TRAX_FAULT_EXECUTE, pc);
  }
}

/* Returns the losers. */
static uint64_t lose_fetches(struct trax_fast_tm *ftm) {
  const uint32_t ports = ftm->tm->config->icache.ports_per_bank;
  uint64_t losers = 0;
  for (uint32_t i = 0; i < ftm->tm->icaches; i++) {
    struct trax_fast_icache *icache = &ftm->icache[i];
    uint64_t asked = 0, conflicts = 0;
    for (uint64_t rest = icache->conflicts; rest; rest &= rest - 1) {
      struct trax_fast_bank *bank = &icache->bank[trax_first(rest)];
      uint64_t asking = bank->asking, last = bank->last;
      for (uint32_t port = 0; port < ports && asking; port++) {
        last = trax_fast_first_after(last, asking);
        asking ^= last;
      }
      losers |= asking;
      bank->last = last;
      bank->asking = asking ? asking : last;
      asked |= asking ? rest & -rest : 0;
      conflicts |= asking & (asking - 1) ? rest & -rest : 0;
    }
    icache->banks = asked;
    icache->conflicts = conflicts;
  }
  return losers;
}

/* Returns those who hold their instructions now. */
static uint64_t fetch(struct trax_fast_tm *ftm, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  if (ftm->outside)
    fault_outside(ftm, t);
  const uint64_t askers = tm->awake & ~tm->holding;
  if (!askers)
    return 0;
  const uint64_t losers = lose_fetches(ftm);
  const uint64_t winners = askers & ~losers;
  trax_fast_count(&ftm->tally[TRAX_CAUSE_ICACHE_BANK], losers);

  uint64_t hits = winners;
  for (uint64_t rest = winners & ~ftm->same_line; rest; rest &= rest - 1) {
    const unsigned number = trax_first(rest);
    const struct trax_fast_slot *slot = &ftm->slot[number];
    if (trax_fast_is_resident(slot->icache->tags, slot->step->inst)) {
      ftm->same_line |= rest & -rest;
      continue;
    }
    hits ^= rest & -rest;
    trax_fast_show(ftm, number);
    trax_icache_look_up(&tm->icache[ftm->icache_of[number]], tm, number, t);
    if (tm->awake & rest & -rest)
      trax_fast_ask_fetch(ftm, number); /* refused by the memory queue */
  }
  tm->stats->icache_hits += count_bits(hits);
  tm->holding |= hits;
  return hits;
}

/* --- step 2 --- */

/* Notes what a deferred head asks for, now that its operands are known. False if it faults. */
static bool classify(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  struct trax_tp *tp = &tm->tp[number];
  const struct trax_decoded *inst = tp->inst;
  const uint64_t bit = (uint64_t)1 << number;
  trax_fast_class class = (trax_fast_class)ftm->slot[number].step->inst->class;
  ftm->want[TRAX_CLASS_DEFERRED] &= ~bit;
  if (inst->ask == TRAX_ASK_ILLEGAL) {
    trax_tm_fault(tm, number, t, TRAX_FAULT_ILLEGAL, 0);
    return false;
  }
  if (inst->ask == TRAX_ASK_END)
    class = TRAX_CLASS_QUEUE;
  if (inst->ask == TRAX_ASK_MEMORY) {
    tp->address = tp->reg[inst->ra] + (uint32_t)inst->imm;
    const trax_fault_kind kind = trax_tp_check_access(tp, &tm->machine->space, tp->address);
    if (kind) {
      trax_tm_fault(tm, number, t, kind, tp->address);
      return false;
    }
    if (tp->address >= TRAX_LOCAL_BASE)
      class = inst->is_store ? TRAX_CLASS_LOCAL_STORE : TRAX_CLASS_LOCAL_LOAD;
    else if (inst->is_nontemporal || inst->is_atomic)
      class = TRAX_CLASS_QUEUE;
    else {
      class = TRAX_CLASS_BANK;
      ftm->tp[number].only.address = tp->address;
    }
  }
  ftm->want[class] |= bit;
  return true;
}

static bool operands_usable(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  trax_fast_show(ftm, number);
  const struct trax_tp *tp = &tm->tp[number];
  if (trax_tp_operands_usable(tp, t) || tp->inst->ask == TRAX_ASK_ILLEGAL) {
    ftm->slot[number].busy &= ~ftm->slot[number].step->inst->waits;
    return true;
  }
  uint64_t until = 0;
  const trax_cause cause = trax_tp_wait(tp, t, &until);
  if (until == TRAX_NEVER) {
    trax_tm_sleep(tm, number, t, cause);
    tm->awaiting |= (uint64_t)1 << number;
  } else {
    trax_tm_sleep_until(tm, number, t, t, until, cause);
  }
  return false;
}

/* fetched: those who hold their instructions since this cycle; woken: those whose operands may be usable now. */
static void check_operands(struct trax_fast_tm *ftm, uint64_t fetched, uint64_t woken, uint64_t t) {
  uint64_t passed = fetched & ftm->clear & ~woken;
  for (uint64_t rest = (fetched | woken) & ~passed; rest; rest &= rest - 1)
    if (operands_usable(ftm, trax_first(rest), t))
      passed |= rest & -rest;
  for (uint64_t rest = passed & ftm->want[TRAX_CLASS_DEFERRED]; rest; rest &= rest - 1)
    if (!classify(ftm, trax_first(rest), t))
      passed &= ~(rest & -rest);
  ftm->ready |= passed;
}

/* --- steps 3 and 4 --- */

/* Charges those who were refused and returns the others. */
static inline uint64_t refuse(struct trax_fast_tm *ftm, uint64_t askers, uint64_t winners, trax_cause cause) {
  trax_fast_count(&ftm->tally[cause], askers & ~winners);
  return winners;
}

static inline uint64_t grant_unit(struct trax_fast_unit *unit, uint64_t askers) {
  uint64_t winners = 0;
  for (uint32_t i = 0; i < unit->groups; i++) {
    const uint64_t winner = trax_fast_first_after(unit->last[i], askers & unit->group[i]);
    unit->last[i] = winner ? winner : unit->last[i];
    winners |= winner;
  }
  return winners;
}

static uint64_t grant_units(struct trax_fast_tm *ftm, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  const uint64_t ready = ftm->ready, *want = ftm->want;
  uint64_t granted = ready & (want[TRAX_CLASS_OWN] | want[TRAX_CLASS_LOCAL_LOAD] | want[TRAX_CLASS_LOCAL_STORE]);
  tm->stats->local_loads += count_bits(ready & want[TRAX_CLASS_LOCAL_LOAD]);
  tm->stats->local_stores += count_bits(ready & want[TRAX_CLASS_LOCAL_STORE]);
  uint64_t askers;
  if ((askers = ready & want[TRAX_CLASS_FP_ADD]))
    granted |= refuse(ftm, askers, grant_unit(&ftm->fp_add, askers), TRAX_CAUSE_FP_ADD);
  if ((askers = ready & want[TRAX_CLASS_FP_MUL]))
    granted |= refuse(ftm, askers, grant_unit(&ftm->fp_mul, askers), TRAX_CAUSE_FP_MUL);
  if ((askers = ready & want[TRAX_CLASS_INT_MUL]))
    granted |= refuse(ftm, askers, grant_unit(&ftm->int_mul, askers), TRAX_CAUSE_INT_MUL);
  if ((askers = ready & want[TRAX_CLASS_SPECIAL]))
    granted |= refuse(ftm, askers, trax_special_unit_grant(&tm->special, askers, t), TRAX_CAUSE_SPECIAL);
  return granted;
}

static uint64_t grant_banks(struct trax_fast_tm *ftm, uint64_t askers) {
  const uint32_t banks = ftm->tm->dcache.banks;
  const bool power_of_two = (banks & (banks - 1)) == 0;
  uint64_t asking[TRAX_MAX_TPS_PER_TM];
  for (uint32_t bank = 0; bank < banks; bank++)
    asking[bank] = 0;
  for (uint64_t rest = askers; rest; rest &= rest - 1) {
    const uint32_t word = ftm->slot[trax_first(rest)].step->address / 4;
    asking[power_of_two ? word & (banks - 1) : word % banks] |= rest & -rest;
  }
  uint64_t winners = 0;
  for (uint32_t bank = 0; bank < banks; bank++) {
    const uint64_t winner = trax_fast_first_after(ftm->data_bank_last[bank], asking[bank]);
    ftm->data_bank_last[bank] = winner ? winner : ftm->data_bank_last[bank];
    winners |= winner;
  }
  return refuse(ftm, askers, winners, TRAX_CAUSE_DCACHE_BANK);
}

static bool load_hits(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  const struct trax_fast_step *step = ftm->slot[number].step;
  if (!trax_cache_tags_have(&tm->dcache.tags, trax_line_of(&tm->dcache.tags, step->address)))
    return false;
  tm->stats->dcache_hits++;
  const uint32_t latency = tm->config->dcache.hit_latency_cycles;
  if (latency > 1) {
    trax_tp_set_usable(&tm->tp[number], step->inst->rd, t + latency, TRAX_CAUSE_DATA_HIT);
    ftm->slot[number].busy |= trax_fast_register_bit(step->inst->rd);
  }
  return true;
}

static bool serve(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  if (!(ftm->deferred >> number & 1) && load_hits(ftm, number, t))
    return true;
  trax_fast_show(ftm, number);
  if (!trax_tm_serve(tm, number, t)) {
    trax_tm_charge(tm, number, TRAX_CAUSE_MEMORY_QUEUE);
    return false;
  }
  ftm->slot[number].busy |= trax_fast_register_bit(tm->tp[number].inst->rd);
  return true;
}

static uint64_t grant_queue(struct trax_fast_tm *ftm, uint64_t askers, uint64_t t) {
  const unsigned turn = ftm->tm->queue_turn;
  uint64_t granted = 0;
  for (uint64_t rest = askers >> turn | askers << (-turn & 63); rest; rest &= rest - 1) { /* bit 0 is the turn's */
    const unsigned number = (trax_first(rest) + turn) & 63;
    granted |= (uint64_t)serve(ftm, number, t) << number;
  }
  return granted;
}

void trax_fast_cycle(struct trax_fast *fast, uint32_t tm_number, uint64_t t) {
  struct trax_fast_tm *ftm = &fast->tm[tm_number];
  struct trax_tm *tm = ftm->tm;
  const uint64_t woken = wake(ftm, t);
  const uint64_t fetched = fetch(ftm, t);
  check_operands(ftm, fetched, woken, t);
  uint64_t granted = grant_units(ftm, t);
  uint64_t queue_askers = ftm->ready & ftm->want[TRAX_CLASS_QUEUE];
  const uint64_t bank_askers = ftm->ready & ftm->want[TRAX_CLASS_BANK];
  if (bank_askers)
    queue_askers |= grant_banks(ftm, bank_askers);
  if (queue_askers)
    granted |= grant_queue(ftm, queue_askers, t);
  for (unsigned class = 0; class < TRAX_CLASS_COUNT; class ++)
    ftm->want[class] &= ~granted;
  ftm->ready &= ~granted;
  trax_fast_issue(ftm, granted, t);
  tm->next_cycle = trax_tm_next_cycle(tm, t);
}
