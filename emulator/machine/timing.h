/* What the rows of machine/units.h say of an instruction and of a kind of unit. */
#ifndef TRAX_MACHINE_TIMING_H
#define TRAX_MACHINE_TIMING_H

#include "machine/config.h"
#include "machine/stats.h"
#include "machine/units.h"
#include "trax/isa.h"

trax_class trax_class_of(trax_op op);

/* Of an instruction, unless it accesses memory. */
struct trax_timing {
  trax_shared unit; /* that it asks for */
  uint32_t latency;
  trax_cause cause; /* of a wait for the result */
};

struct trax_timing trax_timing_of(trax_op op, const struct trax_config *config);

/* Of a kind of shared unit, in a TM. */
struct trax_shared_kind {
  uint32_t group_size, groups, per_group;
  bool is_pipelined;
  trax_cause refused;
  double area; /* mm2 of a unit */
};

struct trax_shared_kind trax_shared_kind(trax_shared unit, const struct trax_config *config);

/* Units of a TM. */
uint32_t trax_shared_units(trax_shared unit, const struct trax_config *config);
/* Unit-cycles in which such units were taken; `operations`: how many they accepted. */
double trax_shared_cycles(trax_shared unit, const struct trax_config *config, const struct trax_tm_stats *stats,
                          uint64_t operations);
/* mm2 of a TM's, as far as area_mm2's fit has not got them. */
double trax_shared_area(const struct trax_config *config);

#endif
