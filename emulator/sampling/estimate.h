/* Estimating a total from a sample drawn with known probabilities. */
#ifndef TRAX_SAMPLING_ESTIMATE_H
#define TRAX_SAMPLING_ESTIMATE_H

#include "machine/stats.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct trax_estimate {
  double total;
  double deviation;  /* the estimate's standard deviation */
  double half;       /* of the 95 % interval; valid if has_interval */
  bool has_interval; /* there were draws enough */
};

/* The unit that a place between 0 and the sum of all sizes falls into; sizes: [units + 1], sums of those before each.
   Of places spread evenly, each unit has as many as it is large. */
uint32_t trax_estimate_unit(const double *sizes, uint32_t units, double place);

/* Of `count` units, each drawn with a probability in proportion to its `size`, the measured sizes relative to those:
   the mean times the known sum of all sizes (Hansen and Hurwitz, "On the Theory of Sampling from Finite Populations",
   Annals of Mathematical Statistics 14, 1943). Its variance is that of independent draws: too large, not too small, if
   each is drawn from a part of its own of the units. The interval is Student's. */
struct trax_estimate trax_estimate_total(const double *ratios, size_t count, double total_size);

/* Student's t: with probability 0.95 a value of this distribution lies between minus and plus the result. */
double trax_student_95(uint64_t degrees_of_freedom);

/* How many draws of that spread give an interval of plus and minus `relative` times the estimate; at least `count`. */
size_t trax_estimate_draws(const double *ratios, size_t count, double relative);

/* A TP's estimated charges, [TRAX_CAUSE_COUNT], as whole numbers whose sum is `cycles`. */
void trax_estimate_charges(struct trax_tp_stats *stats, const double *charges, uint64_t cycles);

#endif
