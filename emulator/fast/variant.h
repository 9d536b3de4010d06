/* The parts of the fast engine that work on masks and vectors of TPs. They are compiled several times, for what hosts
   may have beyond the least of their family. */
#ifndef TRAX_FAST_VARIANT_H
#define TRAX_FAST_VARIANT_H

#include "trax/emulator.h"

#include <stdint.h>

struct trax_chip;
struct trax_fast;

enum { TRAX_FAST_ABREAST = 2 };

struct trax_fast_variant {
  /* Into chip->fast. */
  trax_status (*create)(struct trax_chip *chip, trax_error *error);
  void (*destroy)(struct trax_fast *fast); /* which may be NULL */
  /* Arrivals and the five steps of a TM; sets its next_cycle. */
  void (*cycle)(struct trax_fast *fast, uint32_t tm, uint64_t t);
  /* All cycles before `end` of the `count` TMs from `first` on, at most TRAX_FAST_ABREAST, which run ahead (epochs.h);
     less of one that stops or faults. */
  void (*run_ahead)(struct trax_fast *fast, uint32_t first, uint32_t count, uint64_t end);
  /* Adds the instructions executed since the last call to the TMs' statistics; before the run's end, also those that
     ran ahead. */
  void (*collect)(struct trax_fast *fast);
  /* Completes statistics and charges for the cycles that are over. */
  void (*settle)(struct trax_fast *fast);
  /* Between cycles: brings every TP back to what it has issued, so that tm.h's and tp.h's structures hold all that the
     run depends on. The run can go on. */
  void (*export_state)(struct trax_fast *fast);
  /* Takes up the run before cycle t with what those structures hold. */
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
