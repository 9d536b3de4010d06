/* docs/simt.md, "Data cache": the banks of step 3. */
#include "simt/simt.h"

static bool is_load(const struct trax_ref_tp *lane) {
  return !trax_ref_is(lane, TRAX_IS_STORE);
}

/* The lanes of the set that the winner's access serves, itself included. */
static uint64_t served(const struct trax_simt_tm *tm, uint32_t winner, uint64_t set) {
  const struct trax_ref_tp *first = &tm->ref->tp[winner];
  const uint32_t width = tm->ref->config->simt.width;
  uint64_t lanes = trax_simt_bit(winner);
  set &= tm->warp[winner / width].lanes;
  while (is_load(first) && set) {
    const struct trax_ref_tp *lane = &tm->ref->tp[trax_simt_take(&set)];
    if (is_load(lane) && lane->address / 4 == first->address / 4)
      lanes |= trax_simt_bit(lane->number);
  }
  return lanes;
}

void trax_simt_grant_data_banks(struct trax_simt_tm *tm, uint64_t t) {
  const uint32_t banks = trax_ref_data_banks(tm->ref);
  uint64_t asks[MOST] = {0};
  for (uint32_t i = 0; i < tm->ref->tps; i++)
    if (trax_ref_asks_for_bank(&tm->ref->tp[i]))
      asks[tm->ref->tp[i].address / 4 % banks] |= trax_simt_bit(i);
  tm->broadcast = 0;
  for (uint32_t bank = 0; bank < banks; bank++) {
    if (t >= tm->ref->dcache_fills_end[bank] && asks[bank]) {
      const uint64_t winner = trax_simt_arbitrate(&tm->ref->dcache_bank[bank], asks[bank], 0, tm->ref->tps);
      const uint64_t all = served(tm, (uint32_t)__builtin_ctzll(winner), asks[bank]);
      tm->broadcast |= all & ~winner;
      asks[bank] &= ~all;
    }
    trax_simt_charge(tm, asks[bank], t, TRAX_CAUSE_DCACHE_BANK);
  }
}
