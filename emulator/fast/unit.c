#include "fast/unit.h"

#include <string.h>

void trax_shared_unit_create(struct trax_shared_unit *unit, uint32_t group_size, uint32_t per_group, uint32_t tps) {
  memset(unit, 0, sizeof *unit);
  unit->group_size = group_size;
  unit->per_group = per_group;
  unit->groups = (tps + group_size - 1) / group_size;
}

void trax_special_unit_create(struct trax_special_unit *unit, uint32_t units, uint32_t interval,
                              uint32_t root_interval) {
  memset(unit, 0, sizeof *unit);
  unit->units = units;
  unit->interval = interval;
  unit->root_interval = root_interval;
}

uint64_t trax_special_unit_grant(struct trax_special_unit *unit, uint64_t askers, uint64_t roots, uint64_t t) {
  uint64_t winners = 0;
  for (uint32_t i = 0; i < unit->units && askers & ~winners; i++)
    if (unit->free_from[i] <= t) {
      const uint64_t winner = trax_arbiter_grant(&unit->turn, askers & ~winners, 1);
      unit->free_from[i] = t + (winner & roots ? unit->root_interval : unit->interval);
      winners |= winner;
    }
  return winners;
}
