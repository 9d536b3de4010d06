/* Steps 3 and 4: units, banks and the memory queue are granted. Included by cycle.c. */
#ifndef TRAX_FAST_GRANT_H
#define TRAX_FAST_GRANT_H

#include "fast/time/head.h"

static inline unsigned count_bits(uint64_t mask) {
  return (unsigned)__builtin_popcountll(mask);
}

static inline unsigned step_of(const struct trax_tm *tm, unsigned tp) {
  return tm->heads.low[tp] | (unsigned)tm->heads.high[tp] << 8;
}

/* Returns the data bank of the head's step, or what stands in its place. */
static inline unsigned bank_of(const struct trax_tm *tm, unsigned tp) {
  return step_of(tm, tp) >> TRAX_STEP_BANK_SHIFT & 63;
}

/* Returns those of the TPs, which are some, whose steps are equal to the first one's in the bits of `mask`. */
static inline uint64_t like_first(const struct trax_tm *tm, uint64_t tps, unsigned mask) {
  const unsigned first = step_of(tm, trax_first(tps));
  uint64_t like = tps & -tps;
  for (uint64_t rest = tps & (tps - 1); rest; rest &= rest - 1)
    like |= (step_of(tm, trax_first(rest)) ^ first) & mask ? 0 : rest & -rest;
  return like;
}

/* Grants the banks of the data cache, and returns the losers, one bank after the other for any number of banks. */
static __attribute__((noinline)) uint64_t refuse_many_banks(struct trax_tm *tm, uint64_t requesters) {
  uint64_t losers = 0;
  for (uint64_t rest = requesters, here; rest; rest &= ~here) {
    uint64_t *const rr_mask = &tm->data_bank_rr_masks[bank_of(tm, trax_first(rest))];
    here = like_first(tm, rest, 63 << TRAX_STEP_BANK_SHIFT);
    const uint64_t among = here & *rr_mask ? here & *rr_mask : here, winner = among & -among;
    *rr_mask = -2 * winner;
    losers |= here ^ winner;
  }
  return losers;
}

/* Returns those of the TPs whose data bank is being filled. */
static __attribute__((noinline)) uint64_t in_filling_banks(const struct trax_tm *tm, uint64_t requesters, uint64_t t) {
  uint64_t found = 0;
  for (uint64_t rest = requesters; rest; rest &= rest - 1)
    found |= tm->dcache.fills_end[bank_of(tm, trax_first(rest))] > t ? rest & -rest : 0;
  return found;
}

/* Serves a TP by itself. False: it was refused. */
static bool serve(struct trax_tm *tm, unsigned number, uint64_t t) {
  const struct trax_tp *tp = &tm->tp[number];
  trax_fast_export_head(tm, number);
  const trax_cause refused = trax_tm_serve(tm, number, t);
  if (refused != TRAX_CAUSE_ISSUED) {
    trax_tm_charge(tm, number, refused);
    return false;
  }
  if (!tp->inst->is_store && tp->usable[tp->inst->rd] > t + 1)
    trax_fast_set_busy(tm, number, tp->inst->rd);
  return true;
}

/* Serves those of the slow heads that are stores and combine with their TPs' runs, so that they make no request.
   Returns them. In an epoch, one whose word no burst has loaded ahead also takes effect, and becomes quick, unless a
   head that executes at issue may come before it. */
static uint64_t serve_combining(struct trax_tm *tm, uint64_t stores, uint64_t *slow, uint64_t t) {
  const bool at_once = tm->buffer && !(tm->ready & tm->executes_at_issue);
  uint64_t served = 0;
  for (uint64_t rest = stores; rest; rest &= rest - 1) {
    const unsigned number = trax_first(rest), load = tm->heads.load[number];
    const uint64_t bit = (uint64_t)1 << number;
    struct trax_tp *const tp = &tm->tp[number];
    const struct trax_burst_access *const store = &tp->burst.access[load];
    const unsigned bytes = trax_fast_head_timing(tm, number)->decoded->bytes;
    if (!trax_tp_stores(tp, load) || !trax_tp_combine(tp, store->address, bytes))
      continue;
    served |= bit;
    if (at_once && tm->heads.at[number] < tm->heads.last[number] &&
        !((tm->readers[trax_fast_line_hash(store->address)] & ~bit) &&
          trax_fast_find_readers(tm, store->address, bit))) {
      trax_fast_store_in_epoch(&tm->chip->blocks, tm->buffer, t, store->address, store->word, bytes);
      *slow ^= bit;
    }
  }
  tm->stats->combined_stores += count_bits(served);
  tm->stats->store_hits += count_bits(served & tm->load_hits);
  tm->stats->store_misses += count_bits(served & ~tm->load_hits);
  return served;
}

static uint64_t grant_queue(struct trax_tm *tm, uint64_t requesters, uint64_t t) {
  const unsigned pointer = tm->queue_arbiter % 64;
  uint64_t granted = 0;
  for (uint64_t rest = requesters >> pointer | requesters << (-pointer & 63); rest;
       rest &= rest - 1) { /* bit 0: the pointer's TP */
    const unsigned number = (trax_first(rest) + pointer) & 63;
    granted |= (uint64_t)serve(tm, number, t) << number;
  }
  return granted;
}

/* Grants units of a kind to requesters, group by group; returns the losers. */
static __attribute__((noinline)) uint64_t refuse_several(struct trax_tm *tm, trax_shared which, uint64_t requesters,
                                                         uint64_t t) {
  struct trax_shared_unit *unit = &tm->unit[which];
  const struct trax_shared_kind *const kind = &unit->kind;
  uint64_t winners = 0, all;
  for (uint64_t rest = requesters; rest; rest &= ~all) {
    const unsigned group = trax_first(rest) / kind->group_size;
    all = requesters & trax_group_mask(group, kind->group_size);
    if (!unit->free_from) {
      winners |= trax_arbiter_grant(&unit->arbiter[group], all, kind->per_group);
      continue;
    }
    uint64_t *const free_from = &unit->free_from[(size_t)group * kind->per_group];
    for (uint32_t i = 0; i < kind->per_group && all & ~winners; i++)
      if (free_from[i] <= t) {
        const uint64_t winner = trax_arbiter_grant(&unit->arbiter[group], all & ~winners, 1);
        const trax_op op = (trax_op)trax_fast_head_timing(tm, trax_first(winner))->decoded->op;
        free_from[i] = t + trax_timing_of(op, tm->config).interval;
        winners |= winner;
      }
  }
  return requesters & ~winners;
}

static inline uint64_t refuse_any(struct trax_tm *tm, trax_shared which, uint64_t requesters, uint64_t t) {
  struct trax_shared_unit *unit = &tm->unit[which];
  if (!requesters || (requesters & (requesters - 1)) || unit->free_from)
    return refuse_several(tm, which, requesters, t);
  trax_arbiter_to_back(&unit->arbiter[trax_first(requesters) / unit->kind.group_size], trax_first(requesters));
  return 0;
}

/* The same for adders and multipliers; returns the winners. */
static ALWAYS_INLINE trax_fast_pair grant_fp(struct trax_tm *tm, trax_fast_pair requesters, uint64_t t) {
  if (__builtin_expect(tm->fp.even, true))
    return trax_fast_grant_units(&tm->fp, requesters);
  const trax_fast_pair losers = {refuse_any(tm, TRAX_SHARED_FP_ADD, requesters[0], t),
                                 refuse_any(tm, TRAX_SHARED_FP_MUL, requesters[1], t)};
  return requesters & ~losers;
}

_Static_assert(TRAX_SHARED_COUNT - TRAX_FAST_FURTHER <= 8, "three bits of a step say which of them");

/* Grants the kinds of units that steps encode by a number in the place of a bank's. Returns the winners. */
static __attribute__((noinline)) uint64_t grant_further(struct trax_tm *tm, struct trax_fast_refused *refused,
                                                        uint64_t requesters, uint64_t t) {
  uint64_t granted = requesters;
  for (uint64_t rest = requesters, here; rest; rest &= ~here) {
    const trax_shared unit = TRAX_FAST_FURTHER + bank_of(tm, trax_first(rest));
    here = like_first(tm, rest, 63 << TRAX_STEP_BANK_SHIFT);
    granted ^= refused->unit[unit] = refuse_any(tm, unit, here, t);
  }
  return granted;
}

/* Steps 3 and 4: returns the TPs that were granted all that they need. `slow` receives the TPs with slow heads, and
   `banks` those that request a data bank. */
static ALWAYS_INLINE uint64_t grant(struct trax_tm *tm, const bool wide, struct trax_fast_refused *refused,
                                    uint64_t *slow, uint64_t *banks, uint64_t t) {
  uint64_t bit[TRAX_STEP_BANK_SHIFT + 3];
  trax_fast_transpose(&tm->heads, wide, 0, TRAX_STEP_BANK_SHIFT + 3, bit);
  *slow = bit[0];
  const uint64_t some[2] = {tm->ready & ~bit[3], tm->ready & bit[3]};
/* The TPs that are ready and need this. */
#define OF(KIND) (some[(KIND) >> 3] & ((KIND) >> 1 & 1 ? bit[1] : ~bit[1]) & ((KIND) >> 2 & 1 ? bit[2] : ~bit[2]))
  uint64_t granted = OF(0);
  uint64_t requesters;
  const trax_fast_pair fp_requesters = {OF(TRAX_STEP_FP_ADD), OF(TRAX_STEP_FP_MUL)};
  if (fp_requesters[0] | fp_requesters[1]) {
    const trax_fast_pair fp_won = grant_fp(tm, fp_requesters, t);
    granted |= fp_won[0] | fp_won[1];
    refused->unit[TRAX_SHARED_FP_ADD] = fp_requesters[0] & ~fp_won[0];
    refused->unit[TRAX_SHARED_FP_MUL] = fp_requesters[1] & ~fp_won[1];
  }
  if ((requesters = OF(TRAX_STEP_INT_MUL)))
    granted |= requesters ^ (refused->unit[TRAX_SHARED_INT_MUL] = refuse_any(tm, TRAX_SHARED_INT_MUL, requesters, t));
  if ((requesters = OF(TRAX_STEP_SPECIAL)))
    granted |= requesters ^ (refused->unit[TRAX_SHARED_SPECIAL] = refuse_any(tm, TRAX_SHARED_SPECIAL, requesters, t));
  if (OF(TRAX_STEP_FURTHER))
    granted |= grant_further(tm, refused, OF(TRAX_STEP_FURTHER), t);
  uint64_t queue_requesters = OF(TRAX_STEP_QUEUE);
  *banks = requesters = OF(TRAX_STEP_BANK);
  if (requesters) {
    uint64_t hits = 0, filling = 0;
    if (__builtin_expect(tm->dcache.all_fills_end > t, false))
      filling = in_filling_banks(tm, requesters, t);
    const uint64_t asking = requesters & ~filling, *const number = bit + TRAX_STEP_BANK_SHIFT;
    const uint64_t losers = __builtin_expect(tm->dcache.banks > TRAX_FAST_BANKS, false) ? refuse_many_banks(tm, asking)
                            : tm->dcache.banks > 4 ? trax_fast_refuse_data8(tm->data_bank_rr_masks, asking, number)
                                                   : trax_fast_refuse_data4(tm->data_bank_rr_masks, asking, number);
    refused->bank = filling | losers;
    const uint64_t won = requesters & ~refused->bank;
    if (!tm->serial_hits) { /* else serve() handles them, as it does other stores */
      const uint64_t stores = won & tm->storing & *slow;
      hits = won & tm->load_hits & ~tm->executes_at_issue & ~stores;
      tm->stats->dcache_hits += count_bits(hits);
      if (stores && !tm->observer)
        hits |= serve_combining(tm, stores, slow, t);
    }
    granted |= hits;
    queue_requesters |= won & ~hits;
  }
#undef OF
  if (queue_requesters)
    granted |= grant_queue(tm, queue_requesters, t);
  tm->ready &= ~granted;
  return granted;
}

#endif
