/* The five steps of a TM's cycle (docs/timing.md, "A cycle"), as operations on masks of its TPs. */
#include "fast/time/grant.h"
#include "fast/time/issue.h"
#include "fast/time/prefetch.h"
#include "fast/time/refusals.h"

/* --- arrivals and wake-ups --- */

static ALWAYS_INLINE bool has_arrival(const struct trax_tm *tm, uint64_t t) {
  return tm->queue.started && trax_queue_oldest(&tm->queue)->completion <= t;
}

/* A line has arrived in the data cache, and perhaps evicted another one of its set. */
static void data_line_arrived(struct trax_tm *tm, uint32_t line) {
  const struct trax_cache_tags *const tags = &tm->dcache.tags;
  for (unsigned tp = 0; tp < tm->tps; tp++)
    if (!((trax_line_of(tags, tm->heads.address[tp]) ^ line) & tags->set_mask))
      trax_fast_find_line(tm, tp);
}

/* Handles the arrivals of cycle t. */
static void arrive(struct trax_tm *tm, uint64_t t) {
  while (has_arrival(tm, t)) {
    const struct trax_request request = *trax_queue_oldest(&tm->queue);
    trax_queue_pop(&tm->queue);
    trax_tm_complete(tm, &request, t);
    if (request.kind == TRAX_REQUEST_INSTRUCTION_LINE)
      trax_fast_line_arrived(tm, request.icache, request.line);
    else if (request.kind == TRAX_REQUEST_DATA_LINE)
      data_line_arrived(tm, request.line);
  }
}

/* Wakes TPs. Returns those whose operands must be checked: they wake holding an instruction, or held one at an import.
 */
static ALWAYS_INLINE uint64_t wake(struct trax_tm *tm, uint64_t t) {
  const uint64_t awake = tm->awake;
  if (has_arrival(tm, t))
    arrive(tm, t);
  if (tm->wheel_occupied >> t % TRAX_WHEEL & 1)
    trax_tm_wake_sleepers(tm, t);
  const uint64_t woken = tm->awake & ~awake;
  const uint64_t recheck = tm->recheck;
  tm->recheck = 0;
  return (woken & tm->holding) | recheck;
}

/* --- step 1 --- */

static void fault_no_text(struct trax_tm *tm, uint64_t t) {
  for (uint64_t rest = tm->no_text & tm->awake & ~tm->holding; rest; rest &= rest - 1) {
    const unsigned number = trax_first(rest);
    const uint32_t pc = tm->tp[number].pc;
    trax_tm_fault(tm, number, t, pc % 4 ? TRAX_FAULT_MISALIGNED_PC : TRAX_FAULT_EXECUTE, pc);
  }
}

/* Grants the banks of instruction caches of any shape, one after the other; returns the losers. */
static uint64_t refuse_fetches_of_any_shape(struct trax_tm *tm, uint64_t requesters) {
  const struct trax_config *const config = tm->config;
  uint64_t losers = 0;
  for (uint64_t rest = requesters, here; rest; rest &= ~here) {
    const unsigned first = trax_first(rest), icache = tm->icache_of[first];
    trax_arbiter *const arbiters = &tm->fetch_arbiters[icache * config->icache.banks];
    here = like_first(tm, rest & trax_group_mask(icache, config->icache.tps_per_cache), TRAX_STEP_FETCH);
    losers |= here ^ trax_arbiter_grant(&arbiters[step_of(tm, first) >> TRAX_STEP_FETCH_SHIFT], here,
                                        config->icache.ports_per_bank);
  }
  return losers;
}

/* Grants the instruction caches' banks; returns the losers. */
static ALWAYS_INLINE uint64_t refuse_fetches(struct trax_tm *tm, const bool wide, uint64_t requesters) {
  uint64_t bit[4];
  if (!tm->simple_fetch)
    return refuse_fetches_of_any_shape(tm, requesters);
  trax_fast_transpose(&tm->heads, wide, TRAX_STEP_FETCH_SHIFT, 4, bit);
  return wide ? trax_fast_refuse_four(tm->fetch_rr_masks16, requesters, bit)
              : trax_fast_refuse_two(tm->fetch_rr_masks16, requesters, bit);
}

/* The TP has won its bank and looks up the line of its head. True: a hit. */
static bool look_up(struct trax_tm *tm, unsigned number, uint64_t t) {
  struct trax_icache *icache = &tm->icache[tm->icache_of[number]];
  if (!trax_fast_is_resident(tm, tm->icache_of[number], tm->chip->program.line[trax_fast_head(tm, number)])) {
    trax_fast_export_head(tm, number);
    if (!trax_cache_tags_have(&icache->tags, trax_line_of(&icache->tags, tm->tp[number].pc))) {
      trax_icache_miss(icache, tm, number, t); /* if the memory queue is full, the TP fetches again */
      return false;
    }
  }
  tm->looked_up += !(tm->executes_at_issue >> number & 1);
  return true;
}

/* --- step 2 --- */

/* Completes the step of a head that executes at issue, now that its operands are known. False: it faults. */
static bool classify(struct trax_tm *tm, unsigned number, uint64_t t) {
  struct trax_tp *tp = &tm->tp[number];
  const struct trax_decoded *inst = tp->inst;
  uint16_t step = tm->chip->program.step[trax_fast_head(tm, number)];
  if (inst->resource == TRAX_RESOURCE_ILLEGAL) {
    trax_tm_fault(tm, number, t, TRAX_FAULT_ILLEGAL, 0);
    return false;
  }
  if (inst->resource == TRAX_RESOURCE_END || inst->resource == TRAX_RESOURCE_FENCE)
    step |= TRAX_STEP_QUEUE;
  if (inst->resource == TRAX_RESOURCE_MEMORY) {
    tp->address = tp->reg[inst->ra] + (uint32_t)inst->imm;
    const trax_fault_kind kind = trax_access_check(inst, &tm->machine->space, tp->address);
    if (kind) {
      trax_tm_fault(tm, number, t, kind, tp->address);
      return false;
    }
    if (tp->address >= TRAX_LOCAL_BASE)
      step &= TRAX_STEP_FETCH;
    else if (inst->is_nontemporal || inst->is_atomic)
      step |= TRAX_STEP_QUEUE;
    else
      step |= (uint16_t)(TRAX_STEP_BANK | tp->address / 4 % tm->dcache.banks << TRAX_STEP_BANK_SHIFT);
  }
  tm->tp[number].burst.step[0] = step | TRAX_STEP_SLOW;
  trax_fast_set_head(&tm->heads, number, 0);
  return true;
}

static bool operands_usable(struct trax_tm *tm, unsigned number, bool fetched, uint64_t t) {
  const struct trax_tp *tp = &tm->tp[number];
  const uint32_t waits = trax_fast_head_timing(tm, number)->waits;
  for (uint32_t rest = waits & tm->busy_registers[number]; rest; rest &= rest - 1)
    if (tp->usable[trax_first(rest)] > t) {
      uint64_t until = 0;
      unsigned rd;
      trax_fast_export_head(tm, number);
      const trax_cause cause = trax_tp_wait(tp, t, &until, &rd);
      if (until == TRAX_NEVER) {
        trax_tm_sleep(tm, number, t, cause);
        tm->awaiting |= (uint64_t)1 << number;
      } else {
        trax_tm_sleep_until(tm, number, t, t, until, cause);
      }
      return false;
    }
  tm->busy_registers[number] &= ~waits;
  tm->busy &= ~((uint64_t)!tm->busy_registers[number] << number);
  if ((tm->busy | tm->uncertain) >> number & 1)
    trax_fast_schedule_check(tm, number, fetched);
  return true;
}

/* Steps 1 and 2; woken: TPs that hold an instruction whose operands must be checked. */
static ALWAYS_INLINE void fetch_and_check(struct trax_tm *tm, const bool wide, uint64_t woken,
                                          struct trax_fast_refused *refused, uint64_t t) {
  if (tm->no_text)
    fault_no_text(tm, t);
  const uint64_t requesters = tm->awake & ~tm->holding;
  uint64_t hits = 0;
  if (requesters) {
    const uint64_t losers = refuse_fetches(tm, wide, requesters);
    refused->fetch = losers;
    hits = requesters & ~losers;
  }
  const uint64_t due = trax_fast_due(&tm->heads, wide);
  const uint64_t maybe_missing = (tm->uncertain & due) | tm->executes_at_issue;
  uint64_t passed = hits & ~((tm->busy & due) | maybe_missing);
  for (uint64_t rest = (hits & ~passed) | woken; rest; rest &= rest - 1) {
    const uint64_t bit = rest & -rest;
    const unsigned number = trax_first(rest);
    if ((hits & maybe_missing & bit) && !look_up(tm, number, t))
      hits ^= bit;
    else if (operands_usable(tm, number, hits & bit, t) && (!(tm->executes_at_issue & bit) || classify(tm, number, t)))
      passed |= bit;
  }
  tm->stats->icache_hits += count_bits(hits);
  tm->holding |= hits;
  tm->ready |= passed;
}

/* Step 5; banks: the TPs that have requested a bank. */
static ALWAYS_INLINE void issue(struct trax_tm *tm, const bool wide, uint64_t granted, uint64_t slow, uint64_t banks,
                                uint64_t t) {
  const uint64_t quick = granted & ~slow;
  slow &= granted;
  if (__builtin_expect(tm->observed != NULL, false)) {
    record_refusals(tm, wide, granted & tm->observed->tps);
    const uint64_t hits = tm->serial_hits ? 0 : tm->load_hits & ~tm->storing, /* of which grant() knew */
        others = granted & banks & ~(tm->executes_at_issue | hits);
    if (others)
      trax_fast_record_outcomes(tm, others);
  }
  for (uint64_t loads = quick & banks; loads; loads &= loads - 1)
    trax_fast_set_load(tm, trax_first(loads), tm->heads.load[trax_first(loads)] + 1u);
  if (slow)
    issue_in_order(tm, quick, slow, t);
  else
    issue_quickly(tm, wide, quick);
}

static ALWAYS_INLINE void simulate(struct trax_tm *tm, const bool wide, uint64_t woken, uint64_t t) {
  struct trax_fast_refused refused = {0};
  uint64_t slow, banks;
  fetch_and_check(tm, wide, woken, &refused, t);
  const uint64_t granted = grant(tm, wide, &refused, &slow, &banks, t);
  const bool refuses = refused.fetch | tm->ready; /* who is still ready was refused something */
  issue(tm, wide, granted, slow, banks, t);
  if (refuses && trax_fast_count(&tm->refusal_counts, wide, &refused))
    trax_fast_charge_refusals(tm);
  if (__builtin_expect(tm->observer != NULL, false)) {
    if (!tm->observed)
      trax_fast_notify_refusals(tm, &refused);
    else if (refuses)
      count_refusals(tm, wide, &refused);
  }
  tm->next_cycle = tm->awake ? t + 1 : trax_tm_next_cycle(tm, t);
}

static void run_cycle(struct trax_tm *tm, uint64_t t) {
  tm->now = t;
  const uint64_t woken = wake(tm, t);
  if (tm->wide)
    simulate(tm, true, woken, t);
  else
    simulate(tm, false, woken, t);
}

static void run_quantum(struct trax_tm *tm, uint64_t end) {
  const struct trax_tm *const next = tm->number + 1 < tm->chip->tms ? tm + 1 : tm->chip->tm;
  unsigned prefetched = tm->chip->is_large ? 0 : tm->tps;
  while (tm->next_cycle < end && !tm->buffer->stop && !tm->fault.kind) {
    if (prefetched < tm->tps)
      prefetch_tp(next, prefetched++);
    if (!trax_tm_has_one_awake(tm) || !trax_fast_run_alone(tm, tm->next_cycle, end))
      run_cycle(tm, tm->next_cycle);
  }
  if (tm->chip->is_large)
    leave_outlook(tm);
}

#ifndef TRAX_FAST_VARIANT
#define TRAX_FAST_VARIANT trax_fast_variant
#endif
const struct trax_fast_variant TRAX_FAST_VARIANT = {run_cycle, run_quantum};
