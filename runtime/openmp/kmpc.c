/* Parallel regions, and the synchronisation of their threads. */
#include "kmp.h"

#ifdef __trax__

#include <stdarg.h>

enum { ARGUMENTS = 30 };
typedef void microtask(int *global, int *bound, ...);
typedef void fixed_microtask(int *, int *, void *, void *, void *, void *, void *, void *, void *, void *, void *,
                             void *, void *, void *, void *, void *, void *, void *, void *, void *, void *, void *,
                             void *, void *, void *, void *, void *, void *, void *, void *, void *, void *);

_Thread_local struct region __kmp_region;
unsigned __kmp_threads;
static _Thread_local unsigned wanted; /* num_threads of the next region */

/* In global memory: other threads cannot read the local memory of the one that sets it. */
static struct {
  microtask *task;
  void *argument[ARGUMENTS];
} job;
struct counter __kmp_counters[COUNTERS];
static struct partial { /* of a reduction, for each thread */
  unsigned is_ready;    /* until another thread has taken it */
  void *data;
} *partials;

int __kmpc_global_thread_num(void *place) {
  (void)place;
  return (int)__kmp_region.rank;
}

void __kmpc_push_num_threads(void *place, int thread, int threads) {
  (void)place;
  (void)thread;
  wanted = (unsigned)threads;
}

/* The callee takes as many of the arguments as it has. */
static void call(microtask *task, void *const *a, unsigned size, unsigned rank) {
  const struct region outer = __kmp_region;
  int global = (int)rank, bound = 0;
  __kmp_region = (struct region){.size = size, .rank = rank, .level = outer.level + 1};
  ((fixed_microtask *)task)(&global, &bound, a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], a[11],
                            a[12], a[13], a[14], a[15], a[16], a[17], a[18], a[19], a[20], a[21], a[22], a[23], a[24],
                            a[25], a[26], a[27], a[28], a[29]);
  __kmp_region = outer;
}

static void begin(void *nothing) {
  (void)nothing;
  call(job.task, job.argument, trax_team_size(), trax_team_rank());
}

void __kmpc_fork_call(void *place, int count, microtask *task, ...) {
  (void)place;
  if (count > ARGUMENTS)
    machine_abort("OpenMP: a region uses more than 30 variables of its function");
  void *argument[ARGUMENTS];
  va_list list;
  va_start(list, task);
  for (int i = 0; i < count; i++)
    argument[i] = va_arg(list, void *);
  va_end(list);
  const unsigned threads = wanted ? wanted : __kmp_threads;
  wanted = 0;
  if (__kmp_region.level || trax_thread()) {
    call(task, argument, 1, 0);
    return;
  }
  if (!partials && !(partials = calloc(trax_threads(), sizeof *partials)))
    machine_abort("OpenMP: no memory for reductions");
  job.task = task;
  memset(__kmp_counters, 0, sizeof __kmp_counters);
  memcpy(job.argument, argument, (unsigned)count * sizeof *argument);
  __trax_team_run(begin, NULL, threads);
}

/* A region whose if clause is false: between these calls this thread is its only one. */
void __kmpc_serialized_parallel(void *place, int thread) {
  (void)place;
  (void)thread;
  struct region *outer = malloc(sizeof *outer);
  if (!outer)
    machine_abort("OpenMP: no memory for a region");
  *outer = __kmp_region;
  __kmp_region = (struct region){.size = 1, .level = outer->level + 1, .outer = outer};
}

void __kmpc_end_serialized_parallel(void *place, int thread) {
  (void)place;
  (void)thread;
  struct region *outer = __kmp_region.outer;
  __kmp_region = *outer;
  free(outer);
}

void __kmpc_barrier(void *place, int thread) {
  (void)place;
  (void)thread;
  team_barrier();
}

void __kmpc_flush(void *place) {
  (void)place;
  __atomic_thread_fence(__ATOMIC_SEQ_CST);
}

/* The name of a critical section is an object of zeros. */
void __kmpc_critical(void *place, int thread, struct ticket_lock *name) {
  (void)place;
  (void)thread;
  lock(name);
}
void __kmpc_critical_with_hint(void *place, int thread, struct ticket_lock *name, unsigned hint) {
  (void)hint;
  __kmpc_critical(place, thread, name);
}
void __kmpc_end_critical(void *place, int thread, struct ticket_lock *name) {
  (void)place;
  (void)thread;
  unlock(name);
}

/* Sections of one thread are thread 0's. */
int __kmpc_masked(void *place, int thread, int filter) {
  (void)place;
  (void)thread;
  return __kmp_region.rank == (unsigned)filter;
}
int __kmpc_master(void *place, int thread) {
  return __kmpc_masked(place, thread, 0);
}
int __kmpc_single(void *place, int thread) {
  return __kmpc_masked(place, thread, 0);
}
void __kmpc_end_masked(void *place, int thread) {
  (void)place;
  (void)thread;
}
void __kmpc_end_master(void *place, int thread) {
  (void)place;
  (void)thread;
}
void __kmpc_end_single(void *place, int thread) {
  (void)place;
  (void)thread;
}

void __kmpc_copyprivate(void *place, int thread, size_t size, void *data, void (*copy)(void *, void *), int is_source) {
  (void)place;
  (void)thread;
  (void)size;
  static void *source;
  if (team_size() == 1) /* perhaps in a region in which others copy */
    return;
  if (is_source)
    source = data;
  team_barrier();
  if (!is_source)
    copy(data, source);
  team_barrier();
}

/* Reductions go up a tree: the same order in every run with the same number of threads. */
static int reduce(void *data, void (*combine)(void *, void *)) {
  const unsigned size = team_size(), rank = __kmp_region.rank;
  if (size == 1)
    return 1;
  for (unsigned step = 1; step < size; step *= 2) {
    struct partial *mine = &partials[rank], *other = &partials[rank + step];
    if (rank & step) {
      mine->data = data;
      release_fence();
      store_shared(&mine->is_ready, 1);
      while (load_shared(&mine->is_ready))
        ;
      acquire_fence();
      return 0;
    }
    if (rank + step < size) {
      while (!load_shared(&other->is_ready))
        ;
      acquire_fence();
      combine(data, other->data);
      release_fence();
      store_shared(&other->is_ready, 0);
    }
  }
  return 1;
}

int __kmpc_reduce_nowait(void *place, int thread, int count, size_t size, void *data, void (*combine)(void *, void *),
                         struct ticket_lock *name) {
  (void)place;
  (void)thread;
  (void)count;
  (void)size;
  (void)name;
  return reduce(data, combine);
}

void __kmpc_end_reduce_nowait(void *place, int thread, struct ticket_lock *name) {
  (void)place;
  (void)thread;
  (void)name;
}

/* The thread that has the result reaches the barrier in __kmpc_end_reduce. */
int __kmpc_reduce(void *place, int thread, int count, size_t size, void *data, void (*combine)(void *, void *),
                  struct ticket_lock *name) {
  const int result = __kmpc_reduce_nowait(place, thread, count, size, data, combine, name);
  if (!result)
    team_barrier();
  return result;
}

void __kmpc_end_reduce(void *place, int thread, struct ticket_lock *name) {
  (void)place;
  (void)thread;
  (void)name;
  team_barrier();
}

#endif
