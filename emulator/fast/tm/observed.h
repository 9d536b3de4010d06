/* A TM's record for an observer of stretches (machine/observer.h). */
#ifndef TRAX_FAST_OBSERVED_H
#define TRAX_FAST_OBSERVED_H

#include "machine/config.h"
#include "translate/burst.h"

#include <stdint.h>

enum { TRAX_FAST_NO_OUTCOME = 0xFF /* a load that hit */ };

struct trax_fast_observed {
  uint8_t told[TRAX_MAX_TPS_PER_TM];       /* steps of the burst of which the observer knows */
  uint8_t told_loads[TRAX_MAX_TPS_PER_TM]; /* the accesses to global memory among them */
  /* The refusals of the head, and the TPs with some. They go to `refused` when the head of a burst issues, and
     otherwise to the log. */
  uint64_t tps;
  _Alignas(64) uint8_t of_head[TRAX_MAX_TPS_PER_TM]; /* trax_stretch.refused */
  uint8_t refused[TRAX_MAX_TPS_PER_TM][TRAX_BURST];  /* the same, of each step */
  /* Of each access to global memory of the burst; they are read by eight. */
  uint8_t outcomes[TRAX_MAX_TPS_PER_TM][TRAX_BURST + 8];
};

#endif
