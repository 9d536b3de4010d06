/* The part of the fast engine that works on vectors of TPs, cycle.c. It is compiled for every host and for
   x86-64-v3. AVX-512 would gain nothing (docs/results/performance.md). */
#ifndef TRAX_FAST_VARIANT_H
#define TRAX_FAST_VARIANT_H

#include <stdbool.h>
#include <stdint.h>

struct trax_tm;

struct trax_fast_variant {
  /* Simulates a cycle of a TM, arrivals included, and sets its next_cycle. */
  void (*cycle)(struct trax_tm *tm, uint64_t t);
  /* Simulates a quantum of a TM (epochs.h): all cycles before `end`, or up to one in which it stops or faults. */
  void (*run_quantum)(struct trax_tm *tm, uint64_t end);
};

extern const struct trax_fast_variant trax_fast_variant;
extern const struct trax_fast_variant trax_fast_variant_v3; /* for x86-64-v3: AVX2, BMI2; if TRAX_FAST_HAVE_AVX2 */

#endif
