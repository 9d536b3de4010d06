/* The properties of instructions and of kinds of units under a configuration, from the rows of machine/units.h. */
#ifndef TRAX_MACHINE_TIMING_H
#define TRAX_MACHINE_TIMING_H

#include "machine/config.h"
#include "machine/stats.h"
#include "machine/units.h"
#include "trax/isa.h"

trax_class trax_class_of(trax_op op);

/* The timing of an instruction that does not access memory. */
struct trax_timing {
  trax_shared unit;  /* the shared unit that it needs, or TRAX_SHARED_NONE */
  uint32_t latency;  /* cycles */
  uint32_t interval; /* the number of cycles for which it takes that unit */
  trax_cause cause;  /* of a wait for the result */
};

struct trax_timing trax_timing_of(trax_op op, const struct trax_config *config);
/* Whether an instruction is illegal because the machine has no unit for it. */
bool trax_lacks_unit(trax_op op, const struct trax_config *config);

/* A kind of shared unit in a TM. */
struct trax_shared_kind {
  uint32_t group_size, groups, per_group;
  trax_cause refused; /* the cause of a cycle without a grant */
  double area;        /* mm2 of a unit */
};

struct trax_shared_kind trax_shared_kind(trax_shared unit, const struct trax_config *config);

/* Returns the name of a unit of the kind. */
const char *trax_shared_words(trax_shared unit);
/* Whether no instruction takes a unit of the kind for more than one cycle. */
bool trax_always_free(trax_shared unit, const struct trax_config *config);
/* The number of units of a TM. */
uint32_t trax_shared_units(trax_shared unit, const struct trax_config *config);
/* The unit-cycles in which units of the kind were busy; `operations`: the number of operations that they accepted. */
double trax_shared_cycles(trax_shared unit, const struct trax_config *config, const struct trax_tm_stats *stats,
                          uint64_t operations);
/* The area in mm2 of a TM's shared units that the fit of area_mm2 does not include. */
double trax_shared_area(const struct trax_config *config);

#endif
