/* docs/simt.md, "Fetch": step 1. */
#include "simt/simt.h"

/* The lanes of the group hold its instruction. */
static void hold(struct trax_simt_tm *tm, struct trax_simt_warp *warp) {
  warp->left = warp->group;
  for (uint64_t set = warp->group; set;) {
    struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&set)];
    lane->inst = warp->inst->inst;
    lane->holds = true;
  }
}

/* The warp's instruction at pc. Most are in the first segment. */
static const struct trax_simt_inst *inst_at(struct trax_simt_tm *tm, uint32_t warp, uint32_t pc) {
  const uint32_t place = (pc - tm->inst_begin) / 4;
  if (pc % 4 == 0 && place < tm->inst_count)
    return &tm->inst[place];
  tm->fetched[warp].inst = trax_simt_decode_at(tm, pc);
  return &tm->fetched[warp].inst;
}

static void fault_outside_text(struct trax_simt_tm *tm, struct trax_ref_tp *first, uint64_t t) {
  uint32_t word;
  trax_ref_fault(tm->ref, first, t, trax_ref_text(tm->ref, first->pc, &word), first->pc);
}

/* Returns the first lanes of the groups that ask. Those whose pc is no text fault. */
static uint64_t collect(struct trax_simt_tm *tm, uint64_t t) {
  uint64_t asks = 0;
  for (uint64_t awake = tm->awake; awake;) {
    const uint32_t i = trax_simt_take(&awake);
    struct trax_simt_warp *warp = &tm->warp[i];
    if (warp->left)
      continue;
    struct trax_ref_tp *first = trax_simt_speaker(tm, warp->group);
    if (first->holds) /* its line has arrived */
      hold(tm, warp);
    if (warp->left || first->awaits_line || warp->uncharged != warp->group)
      continue;
    warp->inst = inst_at(tm, i, first->pc);
    tm->lane[first->number].bank = warp->inst->decoded->bank;
    if (warp->inst->decoded->resource == TRAX_RESOURCE_NO_TEXT)
      fault_outside_text(tm, first, t);
    if (!trax_simt_note_charge(warp, first))
      asks |= trax_simt_bit(first->number);
  }
  return asks;
}

/* The lanes of the set that win their banks in the cache to which all of them belong. `first`: of its n lanes. */
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
    for (uint32_t port = 0; asks[bank] && port < tm->ref->config->icache.ports_per_bank; port++) {
      const uint64_t winner = trax_simt_arbitrate(&icache->bank[bank], asks[bank], first, n);
      asks[bank] &= ~winner;
      won |= winner;
    }
  }
  return won;
}

/* The lanes of the set that win their banks. */
static uint64_t grant_caches(struct trax_simt_tm *tm, uint64_t asks) {
  const uint32_t size = tm->ref->config->icache.tps_per_cache, tps = tm->ref->tps;
  uint64_t won = 0;
  while (asks) {
    const struct trax_simt_lane *lane = &tm->lane[trax_simt_first(asks)];
    struct trax_ref_icache *icache = &tm->ref->icache[lane->icache];
    const uint32_t first = lane->icache * size, n = first + size < tps ? size : tps - first;
    const uint64_t set = asks & trax_simt_lanes(first, n);
    const bool is_alone = !(set & (set - 1));
    won |= is_alone ? trax_simt_arbitrate(&icache->bank[lane->bank], set, first, n)
                    : grant_banks(tm, icache, set, first, n);
    asks &= ~set;
  }
  return won;
}

/* Looks up the line of a lane that won its bank. A line that was found stays while none arrives. */
static bool look_up(struct trax_simt_tm *tm, uint32_t i, uint64_t t) {
  struct trax_simt_fetched *fetched = &tm->fetched[tm->lane[i].warp];
  const struct trax_ref_lines *lines = &tm->ref->icache[tm->lane[i].icache].lines;
  const uint32_t line = tm->ref->tp[i].pc / lines->line_bytes;
  if (line == fetched->line && lines->uses == fetched->arrivals) {
    tm->ref->stats->icache_hits++;
    return true;
  }
  if (!trax_ref_look_up(tm->ref, &tm->ref->tp[i], t))
    return false;
  fetched->line = line;
  fetched->arrivals = lines->uses;
  return true;
}

void trax_simt_fetch(struct trax_simt_tm *tm, uint64_t t) {
  const uint64_t asks = collect(tm, t), won = asks ? grant_caches(tm, asks) : 0;
  for (uint64_t set = won; set;) {
    const uint32_t i = trax_simt_take(&set);
    if (look_up(tm, i, t))
      hold(tm, &tm->warp[tm->lane[i].warp]);
  }
  tm->lost_bank = asks & ~won;
}

void trax_simt_charge_fetch(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t) {
  struct trax_ref_tp *first = trax_simt_speaker(tm, warp->group);
  if (first->awaits_line)
    trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_ICACHE_MISS);
  else if (tm->lost_bank & trax_simt_bit(first->number))
    trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_ICACHE_BANK);
  else if (trax_simt_note_charge(warp, first))
    trax_simt_charge(tm, warp, warp->group, t, TRAX_CAUSE_MEMORY_QUEUE);
}
