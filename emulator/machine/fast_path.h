/* What of a run of the fast engine took one of its slow ways. Results do not depend on it, but how long they take. */
#ifndef TRAX_MACHINE_FAST_PATH_H
#define TRAX_MACHINE_FAST_PATH_H

#include <stdbool.h>
#include <stdint.h>

enum { TRAX_KNOWN_LINES = 1023 }; /* of the program, of which the engine knows whether they are in a cache */

struct trax_fast_path {
  bool known; /* the fast engine has run */

  /* What holds of the whole run. */
  bool observed;        /* each instruction executes by itself, and TMs go from cycle to cycle together */
  bool no_epochs;      /* TMs go from cycle to cycle together, since memory answers too soon */
  bool general_fetch;   /* the banks of the instruction caches are not served all at once */
  bool uneven_units;    /* nor are the groups of adders and multipliers */
  bool many_data_banks; /* nor the banks of the data cache */
  bool hits_in_turn;    /* its hits are served one by one */
  uint32_t text_lines;  /* lines of instructions of the program; TRAX_KNOWN_LINES + 1: or more */

  uint64_t looked_up;     /* fetches whose line had to be looked up, and was there */
  uint64_t single_hits;   /* of the data cache, served one by one */
  uint64_t at_issue;      /* instructions that executed when they were issued, not ahead of time */
  uint64_t single_cycles; /* through which several TMs went together, not each by itself for many cycles */
  uint64_t conflicts;     /* of TMs that ran ahead of each other and had to go back */
  uint64_t short_epochs; /* cycles in which TMs could not run ahead, since the run stops soon, as for a checkpoint */
};

#endif
