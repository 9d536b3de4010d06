/* The energy of a run, from its counters and the energy of each access (docs/statistics.md, "Energy"). */
#ifndef TRAX_REPORT_ENERGY_H
#define TRAX_REPORT_ENERGY_H

#include "machine/config.h"
#include "machine/stats.h"

/* J */
struct trax_energy {
#define TRAX_ENERGY_FIELD(X, ID, MEANING) double ID;
  TRAX_ENERGIES(TRAX_ENERGY_FIELD, )
#undef TRAX_ENERGY_FIELD
  double total;    /* the sum of the members above */
  double off_chip; /* not part of the total */
};

struct trax_energy trax_energy_of(const struct trax_stats *stats, const struct trax_config *config);

/* nJ per access to a data cache of 64-byte lines. Sizes between the table's rows count as the next smaller one, numbers
   of banks are interpolated, and values outside the table count as the nearest one in it. */
double trax_energy_of_cache(uint32_t bytes, uint32_t banks);

#endif
