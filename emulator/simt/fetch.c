/* docs/simt.md, "Fetch": step 1. */
#include "simt/simt.h"

/* Lanes of the group take the instruction that their first lane holds. */
static void take(struct trax_simt_tm *tm, struct trax_simt_warp *warp) {
  const struct trax_ref_tp *first = trax_simt_speaker(tm, warp->group);
  if (!first->holds || warp->left)
    return;
  warp->left = warp->group;
  for (uint64_t set = warp->group; set;) {
    struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&set)];
    lane->inst = first->inst;
    lane->holds = true;
  }
}

/* Returns the first lanes of the groups that ask. Those whose pc is no text fault. */
static uint64_t collect(struct trax_simt_tm *tm, uint64_t t) {
  uint64_t asks = 0;
  for (uint64_t awake = tm->awake; awake;) {
    struct trax_simt_warp *warp = &tm->warp[trax_simt_take(&awake)];
    if (warp->left)
      continue;
    struct trax_ref_tp *first = trax_simt_speaker(tm, warp->group);
    take(tm, warp); /* its line may have arrived */
    if (warp->left || first->awaits_line || warp->uncharged != warp->group)
      continue;
    uint32_t word;
    const trax_fault_kind kind = trax_ref_text(tm->ref, first->pc, &word);
    if (kind)
      trax_ref_fault(tm->ref, first, t, kind, first->pc);
    if (!trax_simt_note_charge(warp, first))
      asks |= trax_simt_bit(first->number);
  }
  return asks;
}

static uint32_t icache_of(const struct trax_simt_tm *tm, uint32_t lane) {
  return lane / tm->ref->config->icache.tps_per_cache;
}

/* The lanes of the set that win the bank, for which all of them ask. */
static uint64_t grant_bank(struct trax_simt_tm *tm, uint32_t bank, uint64_t asks) {
  const struct trax_config *config = tm->ref->config;
  const uint32_t icache = icache_of(tm, trax_simt_first(asks)), size = config->icache.tps_per_cache,
                 first = icache * size, n = first + size < tm->ref->tps ? size : tm->ref->tps - first;
  uint64_t won = 0;
  for (uint32_t port = 0; asks & ~won && port < config->icache.ports_per_bank; port++)
    won |= trax_simt_arbitrate(&tm->ref->icache[icache].bank[bank], asks & ~won, first, n);
  return won;
}

/* Returns the lanes that win their banks. */
static uint64_t grant_banks(struct trax_simt_tm *tm, uint64_t asks) {
  struct {
    uint32_t icache, bank;
  } of[MOST];
  for (uint64_t set = asks; set;) {
    const uint32_t i = trax_simt_take(&set);
    of[i].icache = icache_of(tm, i);
    of[i].bank = tm->ref->tp[i].pc / 4 % tm->ref->config->icache.banks;
  }
  uint64_t won = 0;
  while (asks) {
    const uint32_t first = trax_simt_take(&asks);
    uint64_t rivals = trax_simt_bit(first);
    for (uint64_t set = asks; set;) {
      const uint32_t i = trax_simt_take(&set);
      if (of[i].bank == of[first].bank && of[i].icache == of[first].icache)
        rivals |= trax_simt_bit(i);
    }
    won |= grant_bank(tm, of[first].bank, rivals);
    asks &= ~rivals;
  }
  return won;
}

void trax_simt_fetch(struct trax_simt_tm *tm, uint64_t t) {
  const uint64_t asks = collect(tm, t), won = grant_banks(tm, asks);
  for (uint64_t set = won; set;)
    trax_ref_look_up(tm->ref, &tm->ref->tp[trax_simt_take(&set)], t);
  for (uint64_t awake = tm->awake; awake;) {
    struct trax_simt_warp *warp = &tm->warp[trax_simt_take(&awake)];
    if (warp->left)
      continue;
    take(tm, warp);
    struct trax_ref_tp *first = trax_simt_speaker(tm, warp->group);
    const uint64_t bit = trax_simt_bit(first->number);
    if (first->awaits_line)
      trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_ICACHE_MISS);
    else if (asks & ~won & bit)
      trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_ICACHE_BANK);
    else if (trax_simt_note_charge(warp, first))
      trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_MEMORY_QUEUE);
  }
}
