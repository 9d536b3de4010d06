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
    trax_fast_log_refusals(tm, tm->unlogged.tps & (uint64_t)1 << tp);
    trax_log_charge(tm->observer, log_of(tm, tp), trax_fast_next_of_stretch(tm, tp), cause, rd, cycles);
  } else if (tm->observer->charge)
    tm->observer->charge(tm->observer->context, tm->number, tp, cause, rd, since, cycles);
}

/* --- refusals --- */

void trax_fast_log_refusals(struct trax_tm *tm, uint64_t tps) {
  tm->unlogged.tps &= ~tps;
  for (; tps; tps &= tps - 1) {
    const unsigned tp = trax_first(tps);
    trax_log_charge(tm->observer, log_of(tm, tp), trax_fast_next_of_stretch(tm, tp), (trax_cause)tm->unlogged.cause[tp],
                    0, tm->unlogged.cycles[tp]);
    tm->unlogged.cause[tp] = 0;
  }
}

/* A byte for each of several TPs, since many TPs are refused in a cycle. */
typedef uint8_t bytes16 __attribute__((vector_size(16), may_alias));
typedef uint64_t halves __attribute__((vector_size(16), may_alias));

static __attribute__((noinline)) void log_bytes(struct trax_tm *tm, unsigned first, halves chosen) {
  uint64_t tps = 0;
  for (unsigned half = 0; half < 2; half++)
    for (unsigned i = 0; i < 8; i++)
      tps |= (chosen[half] >> 8 * i & 1) << (first + 8 * half + i);
  trax_fast_log_refusals(tm, tm->unlogged.tps & tps);
}

/* Returns `cause` in the bytes of the TPs that are chosen by bits 0 to 15. */
static inline bytes16 bytes_with(uint64_t chosen, trax_cause cause) {
  const bytes16 bits = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
  const uint64_t ones = 0x0101010101010101;
  return (bytes16)(((bytes16)(halves){(chosen & 0xFF) * ones, (chosen >> 8 & 0xFF) * ones} & bits) != 0) &
         (uint8_t)cause;
}

/* Counts the refusals of 16 TPs from `first` on. A TP has at most one in a cycle. */
static inline void count_refusals(struct trax_tm *tm, unsigned first, const uint64_t *losers) {
  bytes16 *const causes = (bytes16 *)&tm->unlogged.cause[first], *const cycles = (bytes16 *)&tm->unlogged.cycles[first];
  bytes16 now = {0};
  for (unsigned i = 0; i < TRAX_FAST_REFUSALS; i++)
    if (losers[i] >> first & 0xFFFF)
      now |= bytes_with(losers[i] >> first, trax_fast_refusal_causes[i]);
  const bytes16 refusals = (bytes16)(now != 0);
  const halves others =
      (halves)(((bytes16)((*causes != now) & (*causes != 0)) | (bytes16)(*cycles == 0xFF)) & refusals);
  if (others[0] | others[1])
    log_bytes(tm, first, others);
  *cycles = (*cycles & ((bytes16)(*causes == now) | ~refusals)) + (refusals & 1);
  *causes = (*causes & ~refusals) | now;
}

static void notify_charges(struct trax_tm *tm, uint64_t tps, trax_cause cause) {
  for (; tps; tps &= tps - 1)
    trax_tm_notify_charge(tm, trax_first(tps), cause, tm->now, 1);
}

void trax_fast_notify_refusals(struct trax_tm *tm, const struct trax_fast_refused *refused) {
  const uint64_t *const losers = (const uint64_t *)refused;
  uint64_t any = 0;
  for (unsigned i = 0; i < TRAX_FAST_REFUSALS; i++) {
    any |= losers[i];
    if (!tm->observer->stretch)
      notify_charges(tm, losers[i], trax_fast_refusal_causes[i]);
  }
  for (unsigned first = 0; tm->observer->stretch && first < tm->tps; first += 16)
    if (any >> first & 0xFFFF)
      count_refusals(tm, first, losers);
  if (tm->observer->stretch)
    tm->unlogged.tps |= any;
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

static void tell(struct trax_tm *tm, const struct trax_stretch *stretch) {
  tm->observer->stretch(tm->observer->context, stretch);
  if (__atomic_load_n(&tm->observer->single, __ATOMIC_RELAXED))
    tm->chip->burst = 1;
}

static void log_access(struct trax_tm *tm, unsigned number, uint32_t address, uint8_t outcome) {
  struct trax_thread_log *log = log_of(tm, number);
  log->accessed[log->accessed_count++] = (struct trax_accessed){
      .address = address, .at = (uint8_t)trax_fast_next_of_stretch(tm, number), .outcome = outcome};
}

void trax_fast_log_accesses(struct trax_tm *tm, uint64_t issued) {
  const uint64_t hits = tm->serial_hits ? 0 : tm->load_hits & ~tm->storing; /* of which grant() knew */
  for (uint64_t rest = issued & ~tm->executes_at_issue; rest; rest &= rest - 1) {
    const unsigned number = trax_first(rest);
    const uint8_t outcome = hits >> number & 1
                                ? TRAX_OUTCOME_HIT
                                : take_outcome(&tm->tp[number], trax_fast_head_timing(tm, number)->decoded, true);
    log_access(tm, number, tm->heads.address[number], outcome);
  }
}

void trax_fast_tell_single(struct trax_tm *tm, unsigned number, uint32_t pc, const struct trax_decoded *inst) {
  struct trax_tp *tp = &tm->tp[number];
  if (inst->bytes && tp->address < TRAX_LOCAL_BASE && !log_of(tm, number)->accessed_count) /* else before a roll back */
    log_access(tm, number, tp->address, take_outcome(tp, inst, true));
  tell(tm, &(struct trax_stretch){.tm = tm->number,
                                  .tp = number,
                                  .count = 1,
                                  .piece = &(struct trax_piece){pc, 1, 0},
                                  .pieces = 1,
                                  .next_pc = tp->pc,
                                  .result = result_of(tp, inst)});
}

/* Returns the first step from `at` on, and before `end`, that is behind a taken jump; else `end`. `at` is not 0. */
static unsigned next_piece(const struct trax_burst *burst, unsigned at, unsigned end) {
  typedef uint16_t eight __attribute__((vector_size(16)));
  for (; at + 8 <= end; at += 8) {
    eight index, before;
    memcpy(&index, &burst->index[at], sizeof index);
    memcpy(&before, &burst->index[at - 1], sizeof before);
    const halves jumps = (halves)(index - before != 1);
    if (jumps[0])
      return at + trax_first(jumps[0]) / 16;
    if (jumps[1])
      return at + 4 + trax_first(jumps[1]) / 16;
  }
  while (at < end && (uint16_t)(burst->index[at] - burst->index[at - 1]) == 1)
    at++;
  return at;
}

void trax_fast_tell_steps(struct trax_tm *tm, unsigned number, unsigned end, uint32_t next_pc) {
  const struct trax_tp *tp = &tm->tp[number];
  struct trax_piece pieces[TRAX_BURST];
  const unsigned begin = tm->told[number];
  size_t count = 0;
  for (unsigned at = begin; at < end;) {
    const uint32_t pc = tm->chip->program.timing[trax_fast_index(tp, at)].pc;
    const unsigned next = next_piece(&tp->burst, at + 1, end);
    pieces[count++] = (struct trax_piece){pc, next - at, 0};
    at = next;
  }
  if (count)
    tell(tm, &(struct trax_stretch){.tm = tm->number,
                                    .tp = number,
                                    .count = end - begin,
                                    .piece = pieces,
                                    .pieces = count,
                                    .next_pc = next_pc});
  tm->told[number] = (uint8_t)end;
}

void trax_fast_tell_issued(struct trax_tm *tm, unsigned number) {
  trax_fast_log_refusals(tm, tm->unlogged.tps & (uint64_t)1 << number);
  if (!((tm->executes_at_issue | tm->ended) >> number & 1))
    trax_fast_tell_steps(tm, number, tm->heads.at[number], trax_fast_head_timing(tm, number)->pc);
}
