/* Units that several TPs share (docs/timing.md, "Units"): adders, multipliers and integer multipliers, one for each
   group of neighbours, and the TM's FPDIV/iSQRT units. */
#ifndef TRAX_FAST_UNIT_H
#define TRAX_FAST_UNIT_H

#include "fast/arbiter.h"

#include <stdbool.h>
#include <stdint.h>

/* One kind of unit, `per_group` of them for each group of TPs; each accepts an instruction every cycle. */
struct trax_shared_unit {
  uint32_t group_size, groups, per_group;
  trax_arbiter turn[64]; /* [groups] */
};

void trax_shared_unit_create(struct trax_shared_unit *unit, uint32_t group_size, uint32_t per_group, uint32_t tps);

/* FPDIV/iSQRT: alike, with one arbiter; each is taken for `interval` cycles by an FPDIV, for `root_interval` by an
   iSQRT. */
struct trax_special_unit {
  uint32_t units, interval, root_interval;
  uint64_t free_from[64]; /* [units]: cycle */
  trax_arbiter turn;
};

void trax_special_unit_create(struct trax_special_unit *unit, uint32_t units, uint32_t interval,
                              uint32_t root_interval);
/* The winners. roots: those of the askers that ask for an iSQRT; need not be given if the intervals are the same. */
uint64_t trax_special_unit_grant(struct trax_special_unit *unit, uint64_t askers, uint64_t roots, uint64_t t);

#endif
