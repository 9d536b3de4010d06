/* How often a run of the fast engine left its fast path, and why. This affects the run's time on the host, not its
   results. */
#ifndef TRAX_MACHINE_FAST_PATH_H
#define TRAX_MACHINE_FAST_PATH_H

#include <stdbool.h>
#include <stdint.h>

enum {
  TRAX_KNOWN_LINES = 1023
}; /* the engine tracks which of the program's first lines each instruction cache holds */

struct trax_fast_path {
  bool known; /* the fast engine has run */

  /* Properties of the whole run. */
  bool observed;        /* every instruction is a burst of its own, and all TMs simulate the same cycle */
  bool no_epochs; /* all TMs simulate the same cycle, since the latency of memory, or of the second-level cache, is too
                     short for an epoch */
  bool general_fetch;   /* the banks of the instruction caches are arbitrated one cache after the other */
  bool uneven_units;    /* adders and multipliers are arbitrated one group after the other */
  bool many_data_banks; /* the banks of the data cache are arbitrated four at a time */
  bool serial_hits;     /* hits of the data cache are served one by one */
  uint32_t text_lines;  /* lines of instructions of the program; TRAX_KNOWN_LINES + 1: or more */

  uint64_t looked_up;     /* fetches that hit and whose line had to be looked up */
  uint64_t single_hits;   /* hits of the data cache that were served one by one */
  uint64_t at_issue;      /* instructions that executed at issue, not ahead of time */
  uint64_t single_cycles; /* cycles outside epochs, if there are several TMs */
  uint64_t conflicts;     /* epochs that ended in a conflict, after which the chip rolled back */
  uint64_t short_epochs;  /* cycles without an epoch because the run stops soon, as for a checkpoint */
};

#endif
