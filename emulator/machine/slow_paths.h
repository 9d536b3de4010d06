/* Properties of a run that made it slow on the host, as its engine reports them. No result depends on them. */
#ifndef TRAX_MACHINE_SLOW_PATHS_H
#define TRAX_MACHINE_SLOW_PATHS_H

#include <stdbool.h>
#include <stdint.h>

enum trax_slow_path_of { TRAX_OF_CYCLES, TRAX_OF_FETCHES, TRAX_OF_HITS, TRAX_OF_INSTRUCTIONS };

struct trax_slow_path {
  const char *name;
  uint64_t part; /* how many of them left the fast path; 0: none */
  enum trax_slow_path_of of;
  char reason[160];
};

enum { TRAX_SLOW_PATHS = 8 };

struct trax_slow_paths {
  bool known; /* the engine reports them */
  struct trax_slow_path path[TRAX_SLOW_PATHS];
};

#endif
