/* Properties of a run that made it slow on the host, as its engine reports them. No result depends on them. */
#ifndef TRAX_MACHINE_SLOW_PATHS_H
#define TRAX_MACHINE_SLOW_PATHS_H

#include <stdbool.h>
#include <stdint.h>

enum trax_slow_path_of { TRAX_OF_CYCLES, TRAX_OF_FETCHES, TRAX_OF_HITS, TRAX_OF_INSTRUCTIONS };

/* identifier, name, and what a part of it left the fast path. Reasons are in report/slow_paths.c. */
#define TRAX_SLOW_PATHS(X)                                                                                             \
  X(OBSERVED, "observed", CYCLES)                                                                                      \
  X(SINGLE_CYCLES, "TMs cycle by cycle", CYCLES)                                                                       \
  X(FETCHES, "fetches bank by bank", CYCLES)                                                                           \
  X(ADDERS, "adders group by group", CYCLES)                                                                           \
  X(DATA_BANKS, "data banks one by one", CYCLES)                                                                       \
  X(LINES, "lines looked up", FETCHES)                                                                                 \
  X(HITS, "hits one by one", HITS)                                                                                     \
  X(AT_ISSUE, "executed at issue", INSTRUCTIONS)

enum trax_slow_path {
#define TRAX_SLOW_PATH(ID, NAME, OF) TRAX_SLOW_##ID,
  TRAX_SLOW_PATHS(TRAX_SLOW_PATH)
#undef TRAX_SLOW_PATH
      TRAX_SLOW_COUNT
};

struct trax_slow_paths {
  bool known;                                   /* the engine reports them */
  uint64_t part[TRAX_SLOW_COUNT];               /* how many left the fast path */
  bool has_epochs, is_observed, has_many_lines; /* is_observed: by an observer that cannot go back */
  uint64_t conflicts, short_epochs;             /* epochs given up, and cycles before a stop */
};

#endif
