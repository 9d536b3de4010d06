/* The chip of the fast engine: TMs, the memory controller, and the variant and epochs that simulate them. */
#ifndef TRAX_FAST_CHIP_H
#define TRAX_FAST_CHIP_H

#include "engine/run.h"
#include "fast/memory.h"
#include "fast/tm.h"

struct trax_chip {
  struct trax_machine *machine;
  const struct trax_text *text; /* the run's */
  struct trax_tm *tm;           /* [tms] */
  uint32_t tms;
  struct trax_memory memory;
  struct trax_transfer_log transfers; /* no roll back changes it */
  const struct trax_fast_variant *variant;
  struct trax_fast *fast;     /* the variant's data */
  struct trax_epochs *epochs; /* if its TMs run ahead of each other; else NULL */
  uint64_t end;                 /* when all threads have ended: the cycle in which the last transfer is over; else 0 */
};

/* Returns the number of threads that have not ended. */
static inline uint32_t trax_chip_running(const struct trax_chip *chip) {
  uint32_t running = 0;
  for (uint32_t i = 0; i < chip->tms; i++)
    running += chip->tm[i].running;
  return running;
}

void trax_chip_export(struct trax_chip *chip);
void trax_chip_import(struct trax_chip *chip, uint64_t t);

/* The engine with the best variant that the host can run, and the engines of single variants. */
extern const struct trax_engine trax_fast_engine, trax_fast_any_engine;
#ifdef TRAX_FAST_HAVE_V3
extern const struct trax_engine trax_fast_avx2_engine;
#endif
#ifdef TRAX_FAST_HAVE_V4
extern const struct trax_engine trax_fast_avx512_engine;
#endif

#endif
