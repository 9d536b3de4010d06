/* docs/timing.md once more, written for nothing but closeness to the page: every cycle looks at every TP, nobody
   sleeps, no cycle is skipped, no masks. It knows no values: each thread's instructions and addresses are given, as a
   trace of the engine shows them, and it says when they are issued and what every other cycle is charged to. */
#ifndef TRAX_TIMING_NAIVE_H
#define TRAX_TIMING_NAIVE_H

#include "core/machine.h"

struct naive_step {
  uint32_t pc, word, address;
};

struct naive_thread {
  struct naive_step *steps; /* up to and including the halt or exit */
  size_t count;
  uint64_t *issued;                   /* [count], out: cycles */
  uint64_t charged[TRAX_CAUSE_COUNT]; /* out */
};

/* threads: [tms * tps_per_tm]. Returns the length of the run; the bytes moved go to *bytes. */
uint64_t naive_run(const struct trax_config *config, struct naive_thread *threads, uint64_t *bytes);

#endif
