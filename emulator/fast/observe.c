/* Notifies an observer of the run (machine/observer.h). */
#include "fast/time/head.h"

#include <emmintrin.h>
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
    const uint8_t refused = observed->of_head[tp];
    trax_log_charge(tm->observer, log_of(tm, tp), at, TRAX_CAUSE_ICACHE_BANK, 0, trax_refused_fetch(refused));
    trax_log_charge(tm->observer, log_of(tm, tp), at, refusal_of(tm, tp), 0, trax_refused_others(refused));
    observed->of_head[tp] = 0;
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
  for (uint64_t rest = issued; rest; rest &= rest - 1) {
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

/* Returns a bit for each of 16 numbers: those that are equal to `value` in the bits of `mask`. */
static inline unsigned like_16(__m128i some, __m128i others, uint16_t mask, uint16_t value) {
  const __m128i bits = _mm_set1_epi16((short)mask), wanted = _mm_set1_epi16((short)value);
  return (unsigned)_mm_movemask_epi8(_mm_packs_epi16(_mm_cmpeq_epi16(_mm_and_si128(some, bits), wanted),
                                                     _mm_cmpeq_epi16(_mm_and_si128(others, bits), wanted)));
}

/* Returns a bit for each of 16 steps: those that are behind a taken jump. The step before the first one exists. */
static inline unsigned jumps_of_16(const uint16_t *index) {
  const __m128i *const at = (const __m128i *)index, *const before = (const __m128i *)(index - 1);
  return 0xFFFF ^ like_16(_mm_sub_epi16(_mm_loadu_si128(at), _mm_loadu_si128(before)),
                          _mm_sub_epi16(_mm_loadu_si128(at + 1), _mm_loadu_si128(before + 1)), UINT16_MAX, 1);
}

/* Returns a bit for each of 16 steps: those that access global memory. */
static inline unsigned accesses_of_16(const uint16_t *step) {
  return like_16(_mm_loadu_si128((const __m128i *)step), _mm_loadu_si128((const __m128i *)(step + 8)), TRAX_STEP_KIND,
                 TRAX_STEP_BANK);
}

/* Returns a bit for each of the first `count` of 64 steps, at most, that `of_16` finds: few branches are left that the
   host would have to predict. Up to 31 steps behind the last one exist. */
static ALWAYS_INLINE uint64_t find(const uint16_t *steps, unsigned count, unsigned (*of_16)(const uint16_t *steps)) {
  uint64_t found = of_16(steps);
  if (count > 16)
    found |= (uint64_t)of_16(steps + 16) << 16;
  if (count > 32)
    found |= (uint64_t)of_16(steps + 32) << 32 | (uint64_t)of_16(steps + 48) << 48;
  return count < 64 ? found & (((uint64_t)1 << count) - 1) : found;
}
_Static_assert((int)TRAX_CHUNK >= 31, "so many steps may follow the last one");

/* Lists the pieces of the steps from `begin` to `end`. */
static size_t list_pieces(const struct trax_tm *tm, unsigned number, unsigned begin, unsigned end,
                          struct trax_piece *pieces) {
  const struct trax_tp *const tp = &tm->tp[number];
  const struct trax_fast_timing *const timing = tm->chip->program.timing;
  size_t count = 0;
  unsigned at = begin;
  for (unsigned first = begin + 1; first < end; first += 64)
    for (uint64_t rest = find(tp->burst.index + first, end - first, jumps_of_16); rest; rest &= rest - 1) {
      const unsigned next = first + trax_first(rest);
      pieces[count++] = (struct trax_piece){timing[trax_fast_index(tp, at)].pc, next - at, 0};
      at = next;
    }
  pieces[count++] = (struct trax_piece){timing[trax_fast_index(tp, at)].pc, end - at, 0};
  return count;
}

/* Returns a bit for each of 32 outcomes: those of accesses that have not hit. */
static inline uint32_t outcomes_of_32(const uint8_t *outcomes) {
  const __m128i none = _mm_set1_epi8((char)TRAX_FAST_NO_OUTCOME), *const some = (const __m128i *)outcomes;
  const unsigned first = (unsigned)_mm_movemask_epi8(_mm_cmpeq_epi8(_mm_loadu_si128(some), none)),
                 second = (unsigned)_mm_movemask_epi8(_mm_cmpeq_epi8(_mm_loadu_si128(some + 1), none));
  return ~(first | second << 16);
}

/* Takes the outcomes of accesses that have not hit. Returns whether there are any. */
static bool take_outcomes(uint8_t *outcomes, struct trax_accessed *accessed, size_t count) {
  bool any = false;
  for (size_t i = 0; i < count; i += 32) {
    uint32_t some = outcomes_of_32(outcomes + i);
    if (count - i < 32)
      some &= ((uint32_t)1 << (count - i)) - 1;
    for (; __builtin_expect(some != 0, false); some &= some - 1, any = true) {
      const size_t at = i + trax_first(some);
      accessed[at].outcome = outcomes[at];
      outcomes[at] = TRAX_FAST_NO_OUTCOME;
    }
  }
  return any;
}

/* Lists the accesses to global memory of the steps from `begin` to `end`. *misses: not all have hit. */
static size_t list_accesses(struct trax_tm *tm, unsigned number, unsigned begin, unsigned end,
                            struct trax_accessed *accessed, bool *misses) {
  const struct trax_burst *const burst = &tm->tp[number].burst;
  const unsigned told = tm->observed->told_loads[number];
  const struct trax_burst_access *access = &burst->access[told];
  size_t count = 0;
  for (unsigned first = begin; first < end; first += 64)
    for (uint64_t rest = find(&burst->step[first], end - first, accesses_of_16); rest; rest &= rest - 1)
      accessed[count++] = (struct trax_accessed){.address = (access++)->address,
                                                 .at = (uint8_t)(first - begin + trax_first(rest)),
                                                 .outcome = TRAX_OUTCOME_HIT};
  *misses = take_outcomes(&tm->observed->outcomes[number][told], accessed, count);
  return count;
}

void trax_fast_tell_steps(struct trax_tm *tm, unsigned number, unsigned end, uint32_t next_pc) {
  struct trax_fast_observed *const observed = tm->observed;
  const unsigned begin = observed->told[number];
  struct trax_piece own_piece[TRAX_BURST], *piece = own_piece;
  struct trax_accessed own_accessed[TRAX_BURST], *accessed = own_accessed;
  bool misses;
  if (begin == end)
    return;
  void *const room = tm->observer->room ? tm->observer->room(tm->observer->context, tm->number) : NULL;
  if (room)
    piece = room;
  const size_t pieces = list_pieces(tm, number, begin, end, piece);
  if (room)
    accessed = (void *)(piece + pieces);
  const size_t accessed_count = list_accesses(tm, number, begin, end, accessed, &misses);
  tell(tm, &(struct trax_stretch){.cycle = tm->now,
                                  .tm = tm->number,
                                  .tp = number,
                                  .count = end - begin,
                                  .piece = piece,
                                  .pieces = pieces,
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
  observed->of_head[number] = *refused;
  observed->tps |= (uint64_t)1 << number;
  trax_fast_log_refusals(tm, (uint64_t)1 << number);
  *refused = 0;
  if (*outcome != TRAX_FAST_NO_OUTCOME)
    tm->tp[number].outcome = *outcome;
  *outcome = TRAX_FAST_NO_OUTCOME;
}
