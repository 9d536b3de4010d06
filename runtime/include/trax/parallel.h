/* Work for all threads of the chip, from a main that only thread 0 calls (trax-sim --main-on 0). The other threads wait
   from the first call on and are called again as often as wanted. Without --main-on 0, on one TP, and within such work,
   a call does the whole work on its thread. docs/parallel.md has an example and the costs. */
#ifndef TRAX_PARALLEL_H
#define TRAX_PARALLEL_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Calls the function once on each thread, and returns their number when all have returned. Earlier writes are visible
   to the threads, and the threads' writes are visible afterwards. */
unsigned trax_parallel(void (*function)(void *context), void *context);
/* Within such work the number of threads and this thread's rank, from 0. Elsewhere 1 and 0. */
unsigned trax_team_size(void);
unsigned trax_team_rank(void);

/* Calls the function for parts of the range, each of `grain` numbers but for the last. Threads draw their parts from a
   counter. A grain of 0 makes eight parts for each thread. */
typedef void trax_range(unsigned begin, unsigned end, void *context);
void trax_parallel_for(unsigned begin, unsigned end, unsigned grain, trax_range *function, void *context);
/* The parts go to the threads in turn. A grain of 0 makes one part for each thread. */
void trax_parallel_for_static(unsigned begin, unsigned end, unsigned grain, trax_range *function, void *context);

/* Reduces a range. *result is the neutral element before, and the result after the call. Each thread adds one part of
   the range to its own copy; the copies are combined in the order of the range. Returns 0, or -1 without memory. */
typedef void trax_reduce_range(unsigned begin, unsigned end, void *context, void *result);
int trax_parallel_reduce(unsigned begin, unsigned end, trax_reduce_range *function, void *context, void *result,
                         size_t size, void (*combine)(void *result, const void *part));

/* Tasks: functions that may make further ones. trax_run_tasks calls the first, and all that follow from it, on all
   threads, and returns when none is left. A task that finds the queue full is called at once. */
typedef void trax_task(void *context);
void trax_run_tasks(trax_task *first, void *context);
void trax_add_task(trax_task *task, void *context);

/* Waits until all threads of the barrier have arrived. Their earlier writes are visible then. It can be used again. */
struct trax_barrier {
  unsigned count, arrived, released;
};
#define TRAX_BARRIER(COUNT) {(COUNT), 0, 0}
void trax_barrier_wait(struct trax_barrier *barrier);
void trax_team_barrier(void); /* of all threads in trax_parallel */

/* Memory of this thread, the same for every call with the same size or a smaller one; NULL without memory. */
void *trax_scratch(size_t size);

#ifdef __cplusplus
}
#endif

#endif
