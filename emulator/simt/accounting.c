/* docs/simt.md, "Accounting", and the ends of groups. */
#include "simt/simt.h"

uint64_t trax_simt_arbitrate(trax_ref_pointer *pointer, uint64_t asks, uint32_t first, uint32_t n) {
  bool positions[MOST];
  for (uint32_t i = 0; i < n; i++)
    positions[i] = asks & trax_simt_bit(first + i);
  const int winner = trax_ref_arbitrate(pointer, positions, n);
  return winner < 0 ? 0 : trax_simt_bit(first + (uint32_t)winner);
}

void trax_simt_charge(struct trax_simt_tm *tm, uint64_t set, uint64_t t, trax_cause cause) {
  while (set) {
    struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&set)];
    if (!lane->charged)
      trax_ref_charge(tm->ref, lane, t, cause);
  }
}

/* The lanes of the set that have not issued the instruction. */
static uint64_t not_issued(const struct trax_simt_tm *tm, uint64_t set) {
  uint64_t lanes = 0;
  while (set) {
    const struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&set)];
    if (lane->holds && !lane->ended)
      lanes |= trax_simt_bit(lane->number);
  }
  return lanes;
}

void trax_simt_account(struct trax_simt_tm *tm, uint64_t t) {
  for (uint32_t i = 0; i < tm->warps; i++) {
    struct trax_simt_warp *warp = &tm->warp[i];
    trax_simt_charge(tm, warp->group, t, TRAX_CAUSE_LOCKSTEP);
    trax_simt_charge(tm, warp->lanes, t, TRAX_CAUSE_DIVERGENCE);
    if (!warp->left)
      continue;
    const uint64_t left = not_issued(tm, warp->left);
    tm->ref->stats->broadcast_loads += trax_simt_count(tm->broadcast & warp->left & ~left);
    warp->left = left;
    if (!left)
      trax_simt_dissolve(tm, warp);
  }
}
