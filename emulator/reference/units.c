/* docs/timing.md, "Units": step 3, except for the data cache's banks. */
#include "reference/reference.h"

static void charge_losers(struct trax_ref_tm *tm, const bool *asks, uint64_t t, trax_cause cause) {
  for (uint32_t i = 0; i < tm->tps; i++)
    if (asks[i])
      trax_ref_charge(tm, &tm->tp[i], t, cause);
}

/* Each free unit of a group accepts one instruction, in ascending order of units. Clears `asks` of the winners. */
static void grant_group(struct trax_ref_tm *tm, const struct trax_shared_kind *kind, struct trax_ref_group *group,
                        uint32_t first, bool *asks, uint64_t t) {
  const uint32_t n = first + kind->group_size < tm->tps ? kind->group_size : tm->tps - first;
  for (uint32_t unit = 0; unit < kind->per_group; unit++) {
    if (group->free_from[unit] > t)
      continue;
    const int winner = trax_ref_arbitrate(&group->pointer, asks + first, n);
    if (winner < 0)
      break;
    const struct trax_ref_tp *tp = &tm->tp[first + (uint32_t)winner];
    asks[tp->number] = false;
    group->free_from[unit] = t + trax_ref_timing(tm, tp)->interval;
  }
}

void trax_ref_grant_units(struct trax_ref_tm *tm, uint64_t t) {
  bool asks[TRAX_SHARED_COUNT + 1][MOST] = {{false}};
  for (uint32_t i = 0; i < tm->tps; i++)
    if (trax_ref_active(&tm->tp[i]))
      asks[trax_ref_timing(tm, &tm->tp[i])->unit][i] = true;
  for (trax_shared unit = 0; unit < TRAX_SHARED_COUNT; unit++) {
    const struct trax_shared_kind *kind = &tm->kind[unit];
    for (uint32_t i = 0; i < kind->groups; i++)
      grant_group(tm, kind, &tm->group[unit][i], i * kind->group_size, asks[unit], t);
    charge_losers(tm, asks[unit], t, kind->refused);
  }
}
