/* Warps that wait are not visited in every cycle. */
#include "simt/simt.h"

/* The cause to which the lane is charged while its warp sleeps. */
static trax_cause cause_of(const struct trax_simt_tm *tm, const struct trax_simt_warp *warp, uint32_t lane) {
  if (!warp->left)
    return TRAX_CAUSE_ICACHE_MISS;
  const uint8_t waits_for = tm->lane[lane].waits_for;
  return waits_for ? tm->ref->tp[lane].scoreboard[waits_for].cause : TRAX_CAUSE_LOCKSTEP;
}

void trax_simt_charge_sleep(struct trax_simt_tm *tm, struct trax_simt_warp *warp, uint64_t t) {
  if (t <= warp->slept_from)
    return;
  for (uint64_t set = warp->group; set;) {
    const uint32_t lane = trax_simt_take(&set);
    trax_simt_charge_cycles(tm, lane, cause_of(tm, warp, lane), warp->slept_from, t - warp->slept_from);
  }
  warp->slept_from = t;
}

void trax_simt_wake(struct trax_simt_tm *tm, uint64_t t, bool has_arrived) {
  tm->wakes = TRAX_NEVER;
  for (uint32_t i = 0; i < tm->warps; i++) {
    struct trax_simt_warp *warp = &tm->warp[i];
    if (tm->awake & trax_simt_bit(i) || !warp->running)
      continue;
    if (has_arrived || t >= warp->wakes) {
      trax_simt_charge_sleep(tm, warp, t);
      tm->awake |= trax_simt_bit(i);
    } else if (warp->wakes < tm->wakes) {
      tm->wakes = warp->wakes;
    }
  }
}

/* The next cycle in which the warp has something to do, unless something arrives. */
static uint64_t next_cycle(const struct trax_simt_tm *tm, const struct trax_simt_warp *warp, uint64_t t) {
  if (!warp->running)
    return TRAX_NEVER;
  if (!warp->left)
    return trax_simt_speaker(tm, warp->group)->awaits_line ? TRAX_NEVER : t + 1;
  uint64_t next = TRAX_NEVER;
  for (uint64_t set = warp->left; set;) {
    const uint32_t lane = trax_simt_take(&set);
    const uint8_t waits_for = tm->lane[lane].waits_for;
    if (waits_for && tm->ref->tp[lane].scoreboard[waits_for].usable < next)
      next = tm->ref->tp[lane].scoreboard[waits_for].usable;
  }
  return next;
}

void trax_simt_sleep(struct trax_simt_tm *tm, uint32_t i, uint64_t t) {
  struct trax_simt_warp *warp = &tm->warp[i];
  warp->wakes = next_cycle(tm, warp, t);
  if (warp->wakes == t + 1)
    return;
  warp->slept_from = t + 1;
  tm->awake &= ~trax_simt_bit(i);
  if (warp->wakes < tm->wakes)
    tm->wakes = warp->wakes;
}
