#include "core/unit.h"

#include <string.h>

void trax_shared_unit_create(struct trax_shared_unit *unit, uint32_t group_size, uint32_t tps) {
  memset(unit, 0, sizeof *unit);
  unit->group_size = group_size;
  unit->groups = (tps + group_size - 1) / group_size;
}

void trax_special_unit_create(struct trax_special_unit *unit, uint32_t units, uint32_t interval) {
  memset(unit, 0, sizeof *unit);
  unit->units = units;
  unit->interval = interval;
}

uint64_t trax_special_unit_grant(struct trax_special_unit *unit, uint64_t askers, uint64_t t) {
  uint64_t winners = 0;
  for (uint32_t i = 0; i < unit->units && askers & ~winners; i++)
    if (unit->free_from[i] <= t) {
      unit->free_from[i] = t + unit->interval;
      winners |= trax_arbiter_grant(&unit->turn, askers & ~winners, 1);
    }
  return winners;
}
