/* Estimates of a total from a sample drawn with known probabilities. */
#ifndef TRAX_SAMPLING_ESTIMATE_H
#define TRAX_SAMPLING_ESTIMATE_H

#include "machine/stats.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct trax_estimate {
  double total;
  double deviation;  /* the estimate's standard deviation */
  double half;       /* half width of the 95 % interval; valid if has_interval */
  bool has_interval; /* there were at least two draws */
};

/* Returns the unit that contains a place between 0 and the sum of all sizes. sizes: [units + 1], the sum of the sizes
   before each unit, then of all. So uniformly distributed places draw each unit in proportion to its size. */
uint32_t trax_estimate_unit(const double *sizes, uint32_t units, double place);

/* The estimator of Hansen and Hurwitz ("On the Theory of Sampling from Finite Populations", Annals of Mathematical
   Statistics 14, 1943). ratios: [count], of units drawn with probabilities in proportion to their sizes, the measured
   value divided by the size. The estimate is their mean times total_size, the sum of all sizes. The variance is that of
   independent draws, which is too large rather than too small if each draw is from its own part of the units. The
   interval is Student's. */
struct trax_estimate trax_estimate_total(const double *ratios, size_t count, double total_size);

/* The quantile of Student's distribution: a value lies between minus and plus the result with probability 0.95. */
double trax_student_95(uint64_t degrees_of_freedom);

/* The number of draws that gives this half width of the estimate of trax_estimate_total, if further draws vary as these
   `count` do; at least `count`. */
double trax_estimate_draws(const double *ratios, size_t count, double total_size, double half);

/* Rounds a TP's estimated charges, [TRAX_CAUSE_COUNT], to whole numbers whose sum is `cycles`. */
void trax_estimate_charges(struct trax_tp_stats *stats, const double *charges, uint64_t cycles);

#endif
