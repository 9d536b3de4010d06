/* Shared by the parts of the OpenMP runtime. The names and arguments of the entries are those of LLVM's kmp interface,
   as clang 19 calls them; entries that are not here are undefined at link. */
#ifndef TRAX_RUNTIME_KMP_H
#define TRAX_RUNTIME_KMP_H

#include "../parallel/team.h"

#ifdef __trax__

/* A loop whose schedule is decided while it runs. Numbers count from 0 to trips. */
struct dispatch {
  unsigned number; /* of such loops in the region */
  unsigned kind;
  unsigned long long chunk, trips, lower, stride;
  unsigned part;                    /* the next one, if the region has one thread; else whether it has had one */
  unsigned round;                   /* guided: as many parts as threads have the same length */
  unsigned long long start, length; /* of this round's parts */
};

/* A thread's view of its region. A nested region has one thread. */
struct region {
  unsigned size, rank, level;
  struct dispatch dispatch;
  struct region *outer; /* of __kmpc_serialized_parallel */
};
extern _Thread_local struct region __kmp_region;
extern unsigned __kmp_threads; /* set by omp_set_num_threads; 0: all */

enum { COUNTERS = 4 };
extern struct counter {
  unsigned next, left, rounds; /* parts given, threads that are done, loops in the region that have used it */
} __kmp_counters[COUNTERS];

INLINE unsigned team_size(void) {
  return __kmp_region.size ? __kmp_region.size : 1;
}

INLINE void team_barrier(void) {
  if (__kmp_region.size > 1)
    trax_team_barrier();
}

#endif
#endif
