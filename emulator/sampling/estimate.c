#include "sampling/estimate.h"

#include <math.h>

uint32_t trax_estimate_unit(const double *sizes, uint32_t units, double place) {
  uint32_t low = 0, high = units - 1;
  while (low < high) { /* the first unit that ends after `place` */
    const uint32_t middle = low + (high - low) / 2;
    if (sizes[middle + 1] > place)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

double trax_student_95(uint64_t degrees_of_freedom) {
  static const double few[] = {0, 12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179};
  const double z = 1.959964, n = (double)degrees_of_freedom;
  if (degrees_of_freedom < sizeof few / sizeof *few)
    return few[degrees_of_freedom];
  return z + (pow(z, 3) + z) / (4 * n) + (5 * pow(z, 5) + 16 * pow(z, 3) + 3 * z) / (96 * n * n) +
         (3 * pow(z, 7) + 19 * pow(z, 5) + 17 * pow(z, 3) - 15 * z) / (384 * n * n * n);
}

static double mean_of(const double *values, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++)
    sum += values[i];
  return count ? sum / (double)count : 0;
}

/* The standard deviation of a single draw. */
static double spread_of(const double *values, size_t count, double mean) {
  double squares = 0;
  for (size_t i = 0; i < count; i++)
    squares += (values[i] - mean) * (values[i] - mean);
  return count > 1 ? sqrt(squares / (double)(count - 1)) : 0;
}

struct trax_estimate trax_estimate_total(const double *ratios, size_t count, double total_size) {
  const double mean = mean_of(ratios, count);
  struct trax_estimate estimate = {.total = mean * total_size, .has_interval = count > 1};
  if (count > 1) {
    estimate.deviation = total_size * spread_of(ratios, count, mean) / sqrt((double)count);
    estimate.half = trax_student_95(count - 1) * estimate.deviation;
  }
  return estimate;
}

double trax_estimate_draws(const double *ratios, size_t count, double total_size, double half) {
  const double spread = spread_of(ratios, count, mean_of(ratios, count));
  if (count < 2 || spread <= 0)
    return (double)count;
  return fmax(ceil(half > 0 ? pow(trax_student_95(count - 1) * spread * total_size / half, 2) : INFINITY),
              (double)count);
}

void trax_estimate_charges(struct trax_tp_stats *stats, const double *charges, uint64_t cycles) {
  unsigned largest = 0;
  uint64_t sum = 0;
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++) {
    stats->cycles[cause] = (uint64_t)llround(charges[cause]);
    sum += stats->cycles[cause];
    largest = charges[cause] > charges[largest] ? cause : largest;
  }
  stats->cycles[largest] += cycles - sum;
}
