/* The counters of a sampled run: those counted exactly in its beginning and end, and those measured in units, which are
   scaled to an estimate of the whole run. */
#ifndef TRAX_SAMPLING_COUNTS_H
#define TRAX_SAMPLING_COUNTS_H

#include "engine/run.h"

struct trax_slot_counts {
  struct trax_run *run;
  /* Arrays of all counters: first the TMs', then the TPs' charges, the memory's and, if they are counted, the rays'. */
  size_t tp_words, memory_words, ray_words, words; /* the first indices of the latter three, and the length */
  uint64_t counted;                                /* the cycle in which `before` was read */
  uint64_t *before, *now, *exact;                  /* one allocation; exact: counted in beginning and end */
  double *measured; /* counted in units, divided by their expected costs, since costly units are drawn more often */
  uint64_t exact_counted;  /* cycles of `exact` */
  double measured_counted; /* cycles of `measured`, weighted alike */
};

/* The structure is zero before. Also to be destroyed after an error, which is that memory is exhausted. */
trax_status trax_slot_counts_create(struct trax_slot_counts *counts, struct trax_run *run, size_t most_draws);
void trax_slot_counts_destroy(struct trax_slot_counts *counts);

/* Reads the counters in cycle t. The following calls add the difference to them. */
void trax_slot_counts_begin(struct trax_slot_counts *counts, uint64_t t);
void trax_slot_counts_add_exact(struct trax_slot_counts *counts, uint64_t t);
/* Adds a unit of the expected cost `size` that was drawn `draws` times. */
void trax_slot_counts_add_unit(struct trax_slot_counts *counts, size_t draws, double size, uint64_t t);
/* Sets the machine's statistics, but for the cycles, which are set already, to the estimates. */
void trax_slot_counts_estimate(struct trax_slot_counts *counts, const trax_slot_sampling *asked);

#endif
