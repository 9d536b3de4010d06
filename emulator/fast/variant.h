/* The parts of the fast engine that work on masks and vectors of TPs. They are compiled several times, for different
   instruction sets of the host. */
#ifndef TRAX_FAST_VARIANT_H
#define TRAX_FAST_VARIANT_H

#include "trax/emulator.h"

#include <stdint.h>

struct trax_chip;
struct trax_fast;

enum { TRAX_FAST_INTERLEAVED = 2 }; /* the most TMs that run_epoch interleaves */

struct trax_fast_variant {
  /* Creates chip->fast. */
  trax_status (*create)(struct trax_chip *chip, trax_error *error);
  void (*destroy)(struct trax_fast *fast); /* fast may be NULL */
  /* Simulates a cycle of a TM, arrivals included, and sets its next_cycle. */
  void (*cycle)(struct trax_fast *fast, uint32_t tm, uint64_t t);
  /* Simulates an epoch (epochs.h): all cycles before `end` of the `count` TMs from `first` on, at most
     TRAX_FAST_INTERLEAVED. A TM that stops or faults is left at that cycle. */
  void (*run_epoch)(struct trax_fast *fast, uint32_t first, uint32_t count, uint64_t end);
  /* Adds the instructions executed since the latest call to the TMs' statistics, with those that have not been issued.
   */
  void (*collect)(struct trax_fast *fast);
  /* Completes statistics and charges for the cycles that are over. */
  void (*settle)(struct trax_fast *fast);
  /* Between cycles: rolls every TP back to what it has issued, so that the structures of tm.h and tp.h hold all that
     the run depends on. The run can be continued. */
  void (*export_state)(struct trax_fast *fast);
  /* Continues the run before cycle t with the state in those structures. */
  void (*import_state)(struct trax_fast *fast, uint64_t t);
};

extern const struct trax_fast_variant trax_fast_variant;
#ifdef TRAX_FAST_HAVE_V3
extern const struct trax_fast_variant trax_fast_variant_v3; /* for x86-64-v3: AVX2, BMI2 */
#endif
#ifdef TRAX_FAST_HAVE_V4
extern const struct trax_fast_variant trax_fast_variant_v4; /* for x86-64-v4: AVX-512 */
#endif

#endif
