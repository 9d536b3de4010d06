#include "fast/tm/unit.h"

#include <stdlib.h>
#include <string.h>

bool trax_shared_unit_create(struct trax_shared_unit *unit, trax_shared which, const struct trax_config *config) {
  memset(unit, 0, sizeof *unit);
  unit->kind = trax_shared_kind(which, config);
  if (trax_always_free(which, config))
    return true;
  unit->free_from = calloc((size_t)unit->kind.groups * unit->kind.per_group + 1, sizeof *unit->free_from);
  return unit->free_from != NULL;
}

void trax_shared_unit_destroy(struct trax_shared_unit *unit) {
  free(unit->free_from);
}
