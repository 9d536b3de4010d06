/* The five steps of a TM's cycle on masks of its TPs (docs/timing.md, "A cycle"). */
#include "fast/head.h"

static inline unsigned count_bits(uint64_t mask) {
  return (unsigned)__builtin_popcountll(mask);
}

/* --- arrivals and alarms --- */

/* Arrivals; lines of instructions are noted. */
static void arrive(struct trax_fast_tm *ftm, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  while (tm->queue.started && trax_queue_oldest(&tm->queue)->completion <= t) {
    const struct trax_request request = *trax_queue_oldest(&tm->queue);
    if (request.kind == TRAX_REQUEST_INSTRUCTION_LINE)
      trax_fast_line_arrives(ftm, request.icache, request.line);
    trax_queue_pop(&tm->queue);
    trax_tm_complete(tm, &request, t);
  }
}

/* Returns those who wake with their instruction; the others ask for one. */
static uint64_t wake(struct trax_fast_tm *ftm, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  const uint64_t awake = tm->awake;
  arrive(ftm, t);
  if (tm->wheel_occupied >> t % TRAX_WHEEL & 1)
    trax_tm_wake_sleepers(tm, t);
  const uint64_t woken = tm->awake & ~awake;
  for (uint64_t rest = woken & ~tm->holding; rest; rest &= rest - 1)
    trax_fast_ask_fetch(ftm, trax_first(rest));
  const uint64_t taken_up = ftm->taken_up;
  ftm->taken_up = 0;
  return (woken & tm->holding) | taken_up;
}

/* --- step 1 --- */

static void fault_outside(struct trax_fast_tm *ftm, uint64_t t) {
  for (; ftm->outside; ftm->outside &= ftm->outside - 1) {
    const unsigned number = trax_first(ftm->outside);
    const uint32_t pc = ftm->tm->tp[number].pc;
    trax_tm_fault(ftm->tm, number, t, pc % 4 ? TRAX_FAULT_MISALIGNED_PC : TRAX_FAULT_EXECUTE, pc);
  }
}

/* Grants the banks of instruction caches that more than 16 TPs share, or that let more than one TP into a bank. */
static uint64_t lose_fetches_somehow(struct trax_fast_tm *ftm) {
  const struct trax_tm *tm = ftm->tm;
  const uint32_t ports = tm->config->icache.ports_per_bank, vectors = ftm->vectors;
  uint64_t losers = 0;
  for (uint32_t icache = 0; icache < tm->icaches; icache++) {
    trax_fast_lanes lost = {0};
    for (uint32_t i = icache * vectors; i < (icache + 1) * vectors; i++) {
      for (uint32_t port = 0; port < ports; port++)
        if (ftm->narrow) {
          trax_fast_lanes16 winners;
          TRAX_FAST_ARBITRATE(trax_fast_lanes16, &ftm->behind16[i], ftm->asking16[i], &winners);
          ftm->asking16[i] ^= winners;
        } else {
          trax_fast_lanes winners;
          TRAX_FAST_ARBITRATE(trax_fast_lanes, &ftm->behind[i], ftm->asking[i], &winners);
          ftm->asking[i] ^= winners;
        }
      lost |= ftm->narrow ? (trax_fast_lanes)ftm->asking16[i] : ftm->asking[i];
    }
    losers |= ftm->narrow ? trax_fast_any16(&lost) << icache * tm->config->icache.tps_per_cache : trax_fast_any(&lost);
  }
  return losers;
}

/* Grants the instruction caches' banks; returns the losers, who go on asking. */
static inline uint64_t lose_fetches(struct trax_fast_tm *ftm) {
  if (!ftm->simple_fetch)
    return lose_fetches_somehow(ftm);
  uint64_t losers = 0;
  for (uint32_t i = 0, icaches = ftm->tm->icaches, shift = 0; i < icaches; i++, shift += ftm->tps_per_icache) {
    const trax_fast_lanes16 askers = ftm->asking16[i];
    trax_fast_lanes16 winners;
    TRAX_FAST_ARBITRATE(trax_fast_lanes16, &ftm->behind16[i], askers, &winners);
    const trax_fast_lanes16 rest = askers ^ winners;
    ftm->asking16[i] = rest;
    losers |= trax_fast_any16((const trax_fast_lanes *)&rest) << shift;
  }
  return losers;
}

/* A bank has let the TP look up the line of its head. True if it is there. */
static bool look_up(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  struct trax_icache *icache = &tm->icache[ftm->icache_of[number]];
  if (ftm->resident[ftm->icache_of[number]][ftm->head[number]->line])
    return true;
  trax_fast_show(ftm, number);
  if (trax_cache_tags_have(&icache->tags, trax_line_of(&icache->tags, tm->tp[number].pc)))
    return true;
  trax_icache_look_up(icache, tm, number, t);
  if (tm->awake >> number & 1)
    trax_fast_ask_fetch(ftm, number); /* refused by the memory queue */
  return false;
}

/* --- step 2 --- */

/* Notes what a deferred head asks for, now that its operands are known. False if it faults. */
static bool classify(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  struct trax_tp *tp = &tm->tp[number];
  const struct trax_decoded *inst = tp->inst;
  uint16_t asks = ftm->fast->program.inst[ftm->head[number]->index].step.asks;
  if (inst->ask == TRAX_ASK_ILLEGAL) {
    trax_tm_fault(tm, number, t, TRAX_FAULT_ILLEGAL, 0);
    return false;
  }
  if (inst->ask == TRAX_ASK_END)
    asks = TRAX_ASKS_QUEUE;
  if (inst->ask == TRAX_ASK_MEMORY) {
    tp->address = tp->reg[inst->ra] + (uint32_t)inst->imm;
    const trax_fault_kind kind = trax_tp_check_access(tp, &tm->machine->space, tp->address);
    if (kind) {
      trax_tm_fault(tm, number, t, kind, tp->address);
      return false;
    }
    if (tp->address >= TRAX_LOCAL_BASE)
      asks = 0;
    else if (inst->is_nontemporal || inst->is_atomic)
      asks = TRAX_ASKS_QUEUE;
    else {
      asks = (uint16_t)(TRAX_ASKS_BANK | tp->address / 4 % ftm->data_banks << TRAX_ASKS_BANK_SHIFT);
      ftm->tp[number].only.address = tp->address;
    }
  }
  ftm->asks[number] = asks | TRAX_ASKS_SLOWLY;
  return true;
}

static bool operands_usable(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  trax_fast_show(ftm, number);
  const struct trax_tp *tp = &tm->tp[number];
  if (trax_tp_operands_usable(tp, t) || tp->inst->ask == TRAX_ASK_ILLEGAL) {
    ftm->busy_registers[number] &= ~ftm->head[number]->waits;
    ftm->busy &= ~((uint64_t)!ftm->busy_registers[number] << number);
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

/* Steps 1 and 2; woken: those whose operands may be usable now. */
static void fetch_and_check(struct trax_fast_tm *ftm, uint64_t woken, struct trax_fast_lost *lost, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  if (ftm->outside)
    fault_outside(ftm, t);
  const uint64_t askers = tm->awake & ~tm->holding;
  uint64_t hits = 0;
  if (askers) {
    const uint64_t losers = lose_fetches(ftm);
    lost->fetch = losers;
    hits = askers & ~losers;
  }
  uint64_t passed = hits & ftm->smooth;
  for (uint64_t rest = hits & ~passed; rest; rest &= rest - 1)
    if (!look_up(ftm, trax_first(rest), t))
      hits ^= rest & -rest;
  tm->stats->icache_hits += count_bits(hits);
  tm->holding |= hits;
  for (uint64_t rest = (hits & ~passed) | woken; rest; rest &= rest - 1) {
    const unsigned number = trax_first(rest);
    if (operands_usable(ftm, number, t) && (!(ftm->deferred >> number & 1) || classify(ftm, number, t)))
      passed |= rest & -rest;
  }
  ftm->ready |= passed;
}

/* --- steps 3 and 4 --- */

/* Those who win a bank of the data cache; `hits` receives those of them whose lines are there and who need no more. */
static inline uint64_t grant_banks(struct trax_fast_tm *ftm, uint64_t askers, const struct trax_fast_planes *asks,
                                   uint64_t *hits) {
  const struct trax_cache_tags *tags = &ftm->tm->dcache.tags;
  const uint64_t *const bit = &asks->bit[TRAX_ASKS_BANK_SHIFT];
  const trax_fast_lanes none = {0}, even = {~(uint64_t)0, 0, ~(uint64_t)0, 0},
                        lower = {~(uint64_t)0, ~(uint64_t)0, 0, 0};
  /* Of the banks that are handled together, by the lowest two bits of their numbers. */
  const trax_fast_lanes by_low_bits = ((none + bit[0]) ^ even) & ((none + bit[1]) ^ lower);
  uint64_t winners = 0, there = 0;
  for (uint32_t first = 0; first < ftm->data_banks; first += TRAX_FAST_LANES) {
    uint64_t asking = askers;
    for (uint32_t k = 2; k < ftm->data_bank_bits; k++)
      asking &= first >> k & 1 ? bit[k] : ~bit[k];
    trax_fast_lanes winner;
    TRAX_FAST_ARBITRATE(trax_fast_lanes, &ftm->data_bank_behind[first / TRAX_FAST_LANES], by_low_bits & (none + asking),
                        &winner);
    winners |= trax_fast_any(&winner);
    for (unsigned i = 0; i < TRAX_FAST_LANES; i++) { /* without branches: who asks is hard to predict */
      const uint32_t line = trax_line_of(tags, ftm->head[trax_first(winner[i] | (uint64_t)1 << 63)]->address);
      const bool is_there = tags->lines[(size_t)(line & tags->set_mask) * tags->ways] == (uint64_t)line + 1;
      there |= winner[i] & -(uint64_t)is_there;
    }
  }
  *hits = there & ~ftm->deferred;
  return winners;
}

static bool load_hits(struct trax_fast_tm *ftm, unsigned number, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  const struct trax_fast_step *step = ftm->head[number];
  if (!trax_cache_tags_use(&tm->dcache.tags, trax_line_of(&tm->dcache.tags, step->address)))
    return false;
  tm->stats->dcache_hits++;
  const uint32_t latency = tm->config->dcache.hit_latency_cycles;
  if (latency > 1) {
    const unsigned rd = ftm->fast->program.inst[step->index].rd;
    trax_tp_set_usable(&tm->tp[number], rd, t + latency, TRAX_CAUSE_DATA_HIT);
    trax_fast_set_busy(ftm, number, rd);
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
  trax_fast_set_busy(ftm, number, tm->tp[number].inst->rd);
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

static uint64_t askers_for_roots(const struct trax_fast_tm *ftm, uint64_t askers) {
  uint64_t roots = 0;
  for (uint64_t rest = askers; rest; rest &= rest - 1)
    if (ftm->fast->program.inst[ftm->head[trax_first(rest)]->index].decoded->op == TRAX_OP_FRSQRT)
      roots |= rest & -rest;
  return roots;
}

/* Steps 3 and 4: those who are granted all they ask for; `slow` receives those whose issue has more to do. */
static inline uint64_t grant(struct trax_fast_tm *ftm, struct trax_fast_lost *lost, uint64_t *slow, uint64_t t) {
  struct trax_tm *tm = ftm->tm;
  struct trax_fast_planes asks;
  trax_fast_transpose(ftm->asks, tm->tps, ftm->data_bank_bits, &asks);
  const uint64_t ready = ftm->ready;
  uint64_t granted = ready & ~(asks.bit[1] | asks.bit[2] | asks.bit[3] | asks.bit[4] | asks.bit[5] | asks.bit[6]);
  uint64_t askers, won;
  const trax_fast_pair fp_askers = {ready & asks.bit[1], ready & asks.bit[2]};
  const trax_fast_pair fp_won = trax_fast_grant_units(&ftm->fp, fp_askers);
  granted |= fp_won[0] | fp_won[1];
  lost->fp_add = fp_askers[0] & ~fp_won[0];
  lost->fp_mul = fp_askers[1] & ~fp_won[1];
  if ((askers = ready & asks.bit[3])) {
    granted |= won = trax_fast_grant_units(&ftm->int_mul, (trax_fast_pair){askers, 0})[0];
    lost->int_mul = askers & ~won;
  }
  if ((askers = ready & asks.bit[4])) {
    const bool differ = tm->special.root_interval != tm->special.interval;
    granted |= won = trax_special_unit_grant(&tm->special, askers, differ ? askers_for_roots(ftm, askers) : 0, t);
    lost->special = askers & ~won;
  }
  uint64_t queue_askers = ready & asks.bit[6];
  if ((askers = ready & asks.bit[5])) {
    uint64_t hits;
    won = grant_banks(ftm, askers, &asks, &hits);
    lost->bank = askers & ~won;
    if (ftm->hits_in_turn)
      hits = 0; /* serve sees to that */
    tm->stats->dcache_hits += count_bits(hits);
    granted |= hits;
    queue_askers |= won & ~hits;
  }
  if (queue_askers)
    granted |= grant_queue(ftm, queue_askers, t);
  ftm->ready &= ~granted;
  *slow = asks.bit[0];
  return granted;
}

static void count_half(struct trax_fast_tally *tally, unsigned half) {
  trax_fast_lanes sum[4] = {0}, carry = {0};
  for (unsigned i = 0; i < tally->logged; i++) {
    trax_fast_lanes term = tally->log[i][half];
#pragma GCC unroll 4
    for (unsigned bit = 0; bit < 4; bit++) {
      const trax_fast_lanes to_next = sum[bit] & term;
      sum[bit] ^= term;
      term = to_next;
    }
  }
  for (unsigned bit = 0; bit < 64 && (bit < 4 || trax_fast_any(&carry)); bit++) {
    trax_fast_lanes *const plane = &tally->planes[bit][half];
    const trax_fast_lanes term = bit < 4 ? sum[bit] : (trax_fast_lanes){0}, either = *plane ^ term;
    const trax_fast_lanes to_next = (*plane & term) | (either & carry);
    *plane = either ^ carry;
    carry = to_next;
  }
}

void trax_fast_count_log(struct trax_fast_tally *tally) {
  count_half(tally, 0);
  count_half(tally, 1);
  tally->logged = 0;
}

void trax_fast_cycle(struct trax_fast *fast, uint32_t tm_number, uint64_t t) {
  struct trax_fast_tm *ftm = &fast->tm[tm_number];
  struct trax_fast_lost lost = {0};
  ftm->tm->now = t;
  fetch_and_check(ftm, wake(ftm, t), &lost, t);
  uint64_t slow;
  const uint64_t granted = grant(ftm, &lost, &slow, t);
  trax_fast_issue(ftm, granted & ~slow, granted & slow, t);
  trax_fast_count(&ftm->tally, &lost);
  if (__builtin_expect(ftm->tm->observer != NULL, false))
    trax_fast_tell(ftm, &lost);
  ftm->tm->next_cycle = trax_tm_next_cycle(ftm->tm, t);
}
