/* Energy and power of a run, from its counts and a figure for each access (docs/emulator.md, "Energy"). */
#ifndef TRAX_REPORT_ENERGY_H
#define TRAX_REPORT_ENERGY_H

#include "machine/config.h"
#include "machine/stats.h"

/* J */
struct trax_energy {
#define TRAX_ENERGY_FIELD(X, ID, MEANING) double ID;
  TRAX_ENERGIES(TRAX_ENERGY_FIELD, )
#undef TRAX_ENERGY_FIELD
  double total;    /* of those above */
  double off_chip; /* apart from the total */
};

struct trax_energy trax_energy_of(const struct trax_stats *stats, const struct trax_config *config);

/* nJ for an access to a data cache of 64-byte lines. Between the table's rows: the next smaller size, and banks in
   proportion; outside it, the nearest row. */
double trax_energy_of_cache(uint32_t bytes, uint32_t banks);

#endif
