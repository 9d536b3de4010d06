/* Notifies an observer of the run (machine/observer.h). */
#include "fast/time/head.h"

#include <string.h>

_Static_assert((int)TRAX_BURST <= (int)TRAX_MOST_STRETCH, "a burst is a stretch");

static struct trax_thread_log *log_of(const struct trax_tm *tm, unsigned tp) {
  return &tm->observer->logs[tm->number * tm->tps + tp];
}

void trax_tm_tell_charge(struct trax_tm *tm, unsigned tp, trax_cause cause, uint64_t since, uint64_t cycles) {
  uint64_t until;
  unsigned rd = 0;
  if (!cycles || cause == TRAX_CAUSE_ISSUED)
    return;
  if (trax_is_wait(cause)) /* its value may have arrived, but only after `since` */
    trax_tp_wait(&tm->tp[tp], since, &until, &rd);
  if (tm->observer->stretch) {
    trax_fast_log_refusals(tm, (uint64_t)1 << tp);
    trax_log_charge(tm->observer, log_of(tm, tp), trax_fast_next_of_stretch(tm, tp), cause, rd, cycles);
  } else if (tm->observer->charge)
    tm->observer->charge(tm->observer->context, tm->number, tp, cause, rd, since, cycles);
}

/* --- refusals --- */

/* The cause of the head's refusals after its fetch. */
static trax_cause refusal_of(const struct trax_tm *tm, unsigned tp) {
  const struct trax_decoded *inst = trax_fast_head_timing(tm, tp)->decoded;
  return inst->resource == TRAX_RESOURCE_UNIT ? tm->unit[inst->unit].kind.refused : TRAX_CAUSE_DCACHE_BANK;
}

void trax_fast_log_refusals(struct trax_tm *tm, uint64_t tps) {
  struct trax_fast_observed *const observed = tm->observed;
  for (uint64_t rest = tps & observed->tps; rest; rest &= rest - 1) {
    const unsigned tp = trax_first(rest), at = trax_fast_next_of_stretch(tm, tp);
    trax_log_charge(tm->observer, log_of(tm, tp), at, TRAX_CAUSE_ICACHE_BANK, 0, observed->fetch[tp]);
    trax_log_charge(tm->observer, log_of(tm, tp), at, refusal_of(tm, tp), 0, observed->others[tp]);
    observed->fetch[tp] = observed->others[tp] = 0;
  }
  observed->tps &= ~tps;
}

static void notify_charges(struct trax_tm *tm, uint64_t tps, trax_cause cause) {
  for (; tps; tps &= tps - 1)
    trax_tm_notify_charge(tm, trax_first(tps), cause, tm->now, 1);
}

void trax_fast_notify_refusals(struct trax_tm *tm, const struct trax_fast_refused *refused) {
  const uint64_t *const losers = (const uint64_t *)refused;
  for (unsigned i = 0; i < TRAX_FAST_REFUSALS; i++)
    notify_charges(tm, losers[i], trax_fast_refusal_causes[i]);
}

static uint32_t result_of(const struct trax_tp *tp, const struct trax_decoded *inst) {
  if (inst->is_store)
    return inst->bytes < 4 ? tp->reg[inst->rb] & ((1u << 8 * inst->bytes) - 1) : tp->reg[inst->rb];
  return tp->reg[inst->op == TRAX_OP_TRAP ? inst->ra : inst->rd];
}

/* The outcome of the access that the TP has just issued; 0: it is none to global memory. */
static uint8_t take_outcome(struct trax_tp *tp, const struct trax_decoded *inst, bool is_global) {
  const uint8_t outcome = tp->outcome;
  tp->outcome = 0;
  if (is_global && !inst->is_store && !inst->is_nontemporal && !inst->is_atomic && !outcome)
    return TRAX_OUTCOME_HIT;
  return outcome;
}

void trax_tm_notify_issue(struct trax_tm *tm, unsigned number, uint32_t pc, const struct trax_decoded *inst,
                          uint32_t next_pc) {
  struct trax_tp *tp = &tm->tp[number];
  struct trax_issue issue = {.cycle = tm->now,
                             .tm = tm->number,
                             .tp = number,
                             .pc = pc,
                             .next_pc = next_pc,
                             .result = result_of(tp, inst),
                             .address = inst->bytes ? tp->address : 0};
  issue.outcome = take_outcome(tp, inst, inst->bytes && issue.address < TRAX_LOCAL_BASE);
  memcpy(&issue.word, tm->machine->space.bytes + pc, sizeof issue.word);
  if (tm->observer->issue)
    tm->observer->issue(tm->observer->context, &issue);
}

/* --- stretches --- */

static void tell(const struct trax_tm *tm, const struct trax_stretch *stretch) {
  tm->observer->stretch(tm->observer->context, stretch);
  if (!tm->buffer && tm->observer->single) /* else by trax_fast_keep */
    tm->chip->burst = 1;
}

void trax_fast_keep(struct trax_chip *chip, bool holds) {
  const struct trax_observer *observer = chip->machine->observer;
  if (!observer || !observer->keep)
    return;
  observer->keep(observer->context, holds);
  if (observer->single)
    chip->burst = 1;
}

void trax_fast_record_outcomes(struct trax_tm *tm, uint64_t issued) {
  const uint64_t hits = tm->serial_hits ? 0 : tm->load_hits & ~tm->storing; /* of which grant() knew */
  for (uint64_t rest = issued & ~(tm->executes_at_issue | hits); rest; rest &= rest - 1) {
    const unsigned number = trax_first(rest);
    tm->observed->outcomes[number][tm->heads.load[number]] =
        take_outcome(&tm->tp[number], trax_fast_head_timing(tm, number)->decoded, true);
  }
}

void trax_fast_tell_single(struct trax_tm *tm, unsigned number, uint32_t pc, const struct trax_decoded *inst) {
  struct trax_tp *tp = &tm->tp[number];
  const bool is_global = inst->bytes && tp->address < TRAX_LOCAL_BASE;
  struct trax_accessed accessed = {.address = tp->address};
  uint64_t cycles[TRAX_CAUSE_COUNT];
  if (inst->op == TRAX_OP_TRAP)
    trax_fast_read_charges(tm, number, cycles);
  if (is_global)
    accessed.outcome = take_outcome(tp, inst, true);
  tell(tm, &(struct trax_stretch){.cycle = tm->now,
                                  .tm = tm->number,
                                  .tp = number,
                                  .count = 1,
                                  .piece = &(struct trax_piece){pc, 1, 0},
                                  .pieces = 1,
                                  .accessed = &accessed,
                                  .accessed_count = is_global,
                                  .stores = inst->is_store,
                                  .misses = accessed.outcome != TRAX_OUTCOME_HIT,
                                  .cycles = inst->op == TRAX_OP_TRAP ? cycles : NULL,
                                  .next_pc = tp->pc,
                                  .result = result_of(tp, inst)});
}

typedef uint16_t eight __attribute__((vector_size(16)));
typedef int8_t eight_bytes __attribute__((vector_size(8)));

static inline eight load_8(const uint16_t *from) {
  eight some;
  memcpy(&some, from, sizeof some);
  return some;
}

/* Returns bit 8 * i of those of eight steps for which `which` is all ones. */
static inline uint64_t bits_of_8(eight which) {
  return (uint64_t) __builtin_convertvector(which, eight_bytes) & 0x0101010101010101;
}
_Static_assert((int)TRAX_CHUNK >= 8, "so many steps may follow the last one");

/* Returns the first step from `at` on, and before `end`, that is behind a taken jump; else `end`. `at` is not 0. */
static unsigned next_piece(const struct trax_burst *burst, unsigned at, unsigned end) {
  for (; at < end; at += 8) {
    const uint64_t jumps = bits_of_8((eight)(load_8(&burst->index[at]) - load_8(&burst->index[at - 1]) != 1));
    if (jumps)
      return at + trax_first(jumps) / 8 < end ? at + trax_first(jumps) / 8 : end;
  }
  return end;
}

/* Lists the accesses to global memory of the steps from `begin` to `end`, and clears their outcomes. *misses: not all
   have hit. */
static size_t list_accesses(struct trax_tm *tm, unsigned number, unsigned begin, unsigned end,
                            struct trax_accessed *accessed, bool *misses) {
  const struct trax_burst *const burst = &tm->tp[number].burst;
  uint8_t *const outcomes = tm->observed->outcomes[number];
  unsigned load = tm->observed->told_loads[number];
  size_t count = 0;
  unsigned all = TRAX_FAST_NO_OUTCOME;
  for (unsigned first = begin; first < end; first += 8) {
    uint64_t rest = bits_of_8((eight)((load_8(&burst->step[first]) & TRAX_STEP_KIND) == TRAX_STEP_BANK));
    if (end - first < 8)
      rest &= ((uint64_t)1 << 8 * (end - first)) - 1;
    for (; rest; rest &= rest - 1, load++) {
      const uint8_t outcome = outcomes[load];
      outcomes[load] = TRAX_FAST_NO_OUTCOME;
      all &= outcome;
      accessed[count++] =
          (struct trax_accessed){.address = burst->access[load].address,
                                 .at = (uint8_t)(first - begin + trax_first(rest) / 8),
                                 .outcome = outcome == TRAX_FAST_NO_OUTCOME ? TRAX_OUTCOME_HIT : outcome};
    }
  }
  *misses = all != TRAX_FAST_NO_OUTCOME;
  return count;
}

void trax_fast_tell_steps(struct trax_tm *tm, unsigned number, unsigned end, uint32_t next_pc) {
  const struct trax_tp *tp = &tm->tp[number];
  struct trax_fast_observed *const observed = tm->observed;
  struct trax_piece pieces[TRAX_BURST];
  struct trax_accessed accessed[TRAX_BURST + 1];
  const unsigned begin = observed->told[number];
  size_t count = 0;
  bool misses;
  if (begin == end)
    return;
  for (unsigned at = begin; at < end;) {
    const uint32_t pc = tm->chip->program.timing[trax_fast_index(tp, at)].pc;
    const unsigned next = next_piece(&tp->burst, at + 1, end);
    pieces[count++] = (struct trax_piece){pc, next - at, 0};
    at = next;
  }
  const size_t accessed_count = list_accesses(tm, number, begin, end, accessed, &misses);
  tell(tm, &(struct trax_stretch){.cycle = tm->now,
                                  .tm = tm->number,
                                  .tp = number,
                                  .count = end - begin,
                                  .piece = pieces,
                                  .pieces = count,
                                  .accessed = accessed,
                                  .accessed_count = accessed_count,
                                  .stores = tm->storing >> number & 1,
                                  .misses = misses,
                                  .refused = &observed->refused[number][begin],
                                  .next_pc = next_pc});
  memset(&observed->refused[number][begin], 0, (end - begin) * sizeof observed->refused[number][0]);
  observed->told_loads[number] += (uint8_t)accessed_count;
  observed->told[number] = (uint8_t)end;
}

void trax_fast_tell_issued(struct trax_tm *tm, unsigned number) {
  trax_fast_log_refusals(tm, (uint64_t)1 << number);
  if (!((tm->executes_at_issue | tm->ended) >> number & 1))
    trax_fast_tell_steps(tm, number, tm->heads.at[number], trax_fast_head_timing(tm, number)->pc);
}

void trax_fast_tell_before(struct trax_tm *tm, unsigned number) {
  struct trax_fast_observed *const observed = tm->observed;
  uint8_t *const refused = &observed->refused[number][tm->heads.at[number]];
  trax_fast_tell_issued(tm, number);
  uint8_t *const outcome =
      &observed->outcomes[number][observed->told_loads[number]]; /* of the head, if it issues now */
  observed->fetch[number] = (uint8_t)trax_refused_fetch(*refused);
  observed->others[number] = (uint8_t)trax_refused_others(*refused);
  observed->tps |= (uint64_t)1 << number;
  trax_fast_log_refusals(tm, (uint64_t)1 << number);
  *refused = 0;
  if (*outcome != TRAX_FAST_NO_OUTCOME)
    tm->tp[number].outcome = *outcome;
  *outcome = TRAX_FAST_NO_OUTCOME;
}
