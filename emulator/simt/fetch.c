/* docs/simt.md, "Fetch": step 1. */
#include "simt/simt.h"

/* Lanes of the group take the instruction that their first lane holds. */
static void take(struct trax_simt_tm *tm, struct trax_simt_warp *warp) {
  const struct trax_ref_tp *first = trax_simt_speaker(tm, warp->group);
  if (!first->holds || warp->left)
    return;
  warp->left = warp->group;
  for (uint64_t set = warp->group & (warp->group - 1); set;) {
    struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&set)];
    lane->inst = first->inst;
    lane->holds = true;
  }
}

/* The first lane of a group holds its instruction. */
static void hold(const struct trax_simt_tm *tm, struct trax_ref_tp *first) {
  const uint32_t place = (first->pc - tm->text->segments->begin) / 4;
  if (place < tm->inst_count) {
    first->inst = tm->inst[place];
  } else {
    uint32_t word = 0;
    trax_ref_text(tm->ref, first->pc, &word);
    first->inst = trax_decode(word);
  }
  first->holds = true;
}

/* The instruction at pc. Most are in the first segment. */
static const struct trax_decoded *text_at(const struct trax_simt_tm *tm, uint32_t pc) {
  const struct trax_text_segment *first = tm->text->segments;
  if (tm->text->count && pc % 4 == 0 && pc >= first->begin && pc < first->end)
    return &first->decoded[(pc - first->begin) / 4];
  return trax_text_at(tm->text, pc);
}

static void fault_outside_text(struct trax_simt_tm *tm, struct trax_ref_tp *first, uint64_t t) {
  uint32_t word;
  trax_ref_fault(tm->ref, first, t, trax_ref_text(tm->ref, first->pc, &word), first->pc);
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
    warp->inst = text_at(tm, first->pc);
    tm->lane[first->number].bank = warp->inst->bank;
    if (warp->inst->resource == TRAX_RESOURCE_NO_TEXT)
      fault_outside_text(tm, first, t);
    if (!trax_simt_note_charge(warp, first))
      asks |= trax_simt_bit(first->number);
  }
  return asks;
}

/* The lanes of the set that win a bank, for which all of them ask. `first`: of the n lanes of its cache. */
static uint64_t grant_bank(const struct trax_simt_tm *tm, trax_ref_pointer *bank, uint64_t asks, uint32_t first,
                           uint32_t n) {
  uint64_t won = 0;
  for (uint32_t port = 0; asks & ~won && port < tm->ref->config->icache.ports_per_bank; port++)
    won |= trax_simt_arbitrate(bank, asks & ~won, first, n);
  return won;
}

/* The lanes of the set that win their banks in the cache to which all of them belong. */
static uint64_t grant_banks(struct trax_simt_tm *tm, struct trax_ref_icache *icache, uint64_t set, uint32_t first,
                            uint32_t n) {
  uint64_t asks[MOST], asked = 0, won = 0;
  while (set) {
    const uint32_t i = trax_simt_take(&set), bank = tm->lane[i].bank;
    asks[bank] = (asked & trax_simt_bit(bank) ? asks[bank] : 0) | trax_simt_bit(i);
    asked |= trax_simt_bit(bank);
  }
  while (asked) {
    const uint32_t bank = trax_simt_take(&asked);
    won |= grant_bank(tm, &icache->bank[bank], asks[bank], first, n);
  }
  return won;
}

/* The lanes of the set that win their banks. */
static uint64_t grant_caches(struct trax_simt_tm *tm, uint64_t asks) {
  const uint32_t size = tm->ref->config->icache.tps_per_cache, tps = tm->ref->tps;
  uint64_t won = 0;
  for (uint32_t first = 0; asks; first += size) {
    const uint32_t n = first + size < tps ? size : tps - first;
    const uint64_t set = asks & trax_simt_lanes(first, n);
    won |= set ? grant_banks(tm, &tm->ref->icache[first / size], set, first, n) : 0;
    asks &= ~set;
  }
  return won;
}

void trax_simt_fetch(struct trax_simt_tm *tm, uint64_t t) {
  const uint64_t asks = collect(tm, t), won = grant_caches(tm, asks);
  for (uint64_t set = won; set;) {
    struct trax_ref_tp *first = &tm->ref->tp[trax_simt_take(&set)];
    if (trax_ref_look_up(tm->ref, first, t))
      hold(tm, first);
  }
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
