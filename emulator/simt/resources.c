/* docs/simt.md, "A cycle", steps 3 and 4: what lanes ask for one by one; and "Data cache". */
#include "simt/simt.h"

/* Charges the active lanes of the set. */
static void charge_active(struct trax_simt_tm *tm, uint64_t set, uint64_t t, trax_cause cause) {
  for (uint64_t awake = tm->awake; set && awake;) {
    struct trax_simt_warp *warp = &tm->warp[trax_simt_take(&awake)];
    trax_simt_charge(tm, warp, set & warp->active, t, cause);
    set &= ~warp->group;
  }
}

/* --- shared units --- */

/* The units of a group of TPs accept lanes of the set. Returns the winners. */
static uint64_t grant_group(struct trax_simt_tm *tm, trax_shared unit, const struct trax_shared_kind *kind,
                            uint32_t number, uint64_t asks, uint64_t t) {
  struct trax_ref_tm *ref = tm->ref;
  struct trax_ref_group *group = &ref->group[unit][number];
  const uint32_t first = number * kind->group_size;
  const uint32_t n = first + kind->group_size < ref->tps ? kind->group_size : ref->tps - first;
  uint64_t won = 0;
  for (uint32_t i = 0; i < kind->per_group && asks & ~won; i++) {
    if (group->free_from[i] > t)
      continue;
    const uint64_t winner = trax_simt_arbitrate(&group->pointer, asks & ~won, first, n);
    group->free_from[i] = t + trax_ref_timing(ref, trax_simt_speaker(tm, winner))->interval;
    won |= winner;
  }
  return won;
}

void trax_simt_grant_units(struct trax_simt_tm *tm, uint64_t t) {
  if (!tm->for_units)
    return;
  uint64_t asks[TRAX_SHARED_COUNT], units = 0;
  for (uint64_t warps = tm->for_units; warps;) {
    const struct trax_simt_warp *warp = &tm->warp[trax_simt_take(&warps)];
    const trax_shared unit = warp->inst->decoded->unit;
    asks[unit] = (units & trax_simt_bit(unit) ? asks[unit] : 0) | warp->active;
    units |= trax_simt_bit(unit);
  }
  while (units) {
    const trax_shared unit = trax_simt_take(&units);
    const struct trax_shared_kind *kind = &tm->ref->kind[unit];
    uint64_t lost = 0;
    for (uint64_t left = asks[unit]; left;) {
      const uint32_t number = trax_simt_first(left) / kind->group_size;
      const uint64_t asking = left & trax_simt_lanes(number * kind->group_size, kind->group_size);
      lost |= asking & ~grant_group(tm, unit, kind, number, asking, t);
      left &= ~asking;
    }
    charge_active(tm, lost, t, kind->refused);
  }
}

/* --- banks of the data cache --- */

static bool is_load(const struct trax_ref_tp *lane) {
  return !trax_ref_is(lane, TRAX_IS_STORE);
}

/* The lanes of the set that the winner's access serves, itself included. */
static uint64_t served(const struct trax_simt_tm *tm, uint32_t winner, uint64_t set) {
  const struct trax_ref_tp *first = &tm->ref->tp[winner];
  uint64_t lanes = trax_simt_bit(winner);
  set &= tm->warp[winner / tm->ref->config->simt.width].group;
  while (is_load(first) && set) {
    const struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&set)];
    if (lane->address / 4 == first->address / 4)
      lanes |= trax_simt_bit(lane->number);
  }
  return lanes;
}

void trax_simt_grant_data_banks(struct trax_simt_tm *tm, uint64_t t) {
  tm->broadcast = 0;
  if (!tm->for_memory)
    return;
  const uint32_t banks = trax_ref_data_banks(tm->ref);
  uint64_t asks[MOST], asked = 0, lost = 0;
  for (uint64_t warps = tm->for_memory; warps;) {
    const struct trax_simt_warp *warp = &tm->warp[trax_simt_take(&warps)];
    const bool asks_for_banks = !warp->inst->decoded->is_nontemporal && !warp->inst->decoded->is_atomic;
    for (uint64_t set = asks_for_banks ? warp->active : 0; set;) {
      const uint32_t i = trax_simt_take(&set), address = tm->ref->tp[i].address, bank = address / 4 % banks;
      if (address >= TRAX_LOCAL_BASE)
        continue;
      asks[bank] = (asked & trax_simt_bit(bank) ? asks[bank] : 0) | trax_simt_bit(i);
      asked |= trax_simt_bit(bank);
    }
  }
  while (asked) {
    const uint32_t bank = trax_simt_take(&asked);
    if (t >= tm->ref->dcache_fills_end[bank]) {
      const uint64_t winner = trax_simt_arbitrate(&tm->ref->dcache_bank[bank], asks[bank], 0, tm->ref->tps);
      const uint64_t all = served(tm, trax_simt_first(winner), asks[bank]);
      tm->broadcast |= all & ~winner;
      asks[bank] &= ~all;
    }
    lost |= asks[bank];
  }
  charge_active(tm, lost, t, TRAX_CAUSE_DCACHE_BANK);
}

/* --- memory queue --- */

void trax_simt_grant_places(struct trax_simt_tm *tm, uint64_t t) {
  uint64_t asks = 0;
  for (uint64_t warps = tm->for_turns; warps;)
    asks |= tm->warp[trax_simt_take(&warps)].active;
  const uint64_t before = trax_simt_bit(tm->ref->queue_pointer) - 1;
  uint64_t rounds[] = {asks & ~before, asks & before};
  for (unsigned i = 0; i < 2; i++)
    while (rounds[i]) {
      struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&rounds[i])];
      trax_ref_take_turn(tm->ref, lane, t);
      trax_simt_note_charge(&tm->warp[lane->number / tm->ref->config->simt.width], lane);
    }
}
