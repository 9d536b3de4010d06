/* The functions of <omp.h>. */
#include "kmp.h"

#ifdef __trax__

#include <omp.h>
#include <time.h>

int omp_get_thread_num(void) {
  return (int)__kmp_region.rank;
}

int omp_get_num_threads(void) {
  return (int)team_size();
}

int omp_get_num_procs(void) {
  return (int)(__kmp_region.size > 1 || __trax_team_open() ? trax_threads() : 1);
}

int omp_get_thread_limit(void) {
  return omp_get_num_procs();
}

int omp_get_max_threads(void) {
  const int threads = __kmp_region.level ? 1 : omp_get_num_procs();
  return __kmp_threads && (int)__kmp_threads < threads ? (int)__kmp_threads : threads;
}

void omp_set_num_threads(int threads) {
  if (threads > 0)
    __kmp_threads = (unsigned)threads;
}

int omp_in_parallel(void) {
  return omp_get_active_level();
}

int omp_get_level(void) {
  return (int)__kmp_region.level;
}

/* Only the outermost region has several threads. */
int omp_get_active_level(void) {
  return trax_team_size() > 1;
}

int omp_get_ancestor_thread_num(int level) {
  return level < 0 || level > omp_get_level() ? -1 : level == 1 ? (int)trax_team_rank() : 0;
}

int omp_get_team_size(int level) {
  return level < 0 || level > omp_get_level() ? -1 : level == 1 ? (int)trax_team_size() : 1;
}

int omp_get_dynamic(void) {
  return 0;
}
void omp_set_dynamic(int dynamic) {
  (void)dynamic;
}
int omp_get_nested(void) {
  return 0;
}
void omp_set_nested(int nested) {
  (void)nested;
}
int omp_get_max_active_levels(void) {
  return 1;
}
void omp_set_max_active_levels(int levels) {
  (void)levels;
}
int omp_is_initial_device(void) {
  return 1;
}
int omp_get_num_devices(void) {
  return 0;
}

double omp_get_wtime(void) {
  return (double)clock() / CLOCKS_PER_SEC;
}
double omp_get_wtick(void) {
  return 1.0 / CLOCKS_PER_SEC;
}

#define LOCK(NAME, KIND)                                                                                               \
  void omp_init_##NAME(mtx_t *lock) {                                                                                  \
    mtx_init(lock, KIND);                                                                                              \
  }                                                                                                                    \
  void omp_destroy_##NAME(mtx_t *lock) {                                                                               \
    (void)lock;                                                                                                        \
  }                                                                                                                    \
  void omp_set_##NAME(mtx_t *lock) {                                                                                   \
    mtx_lock(lock);                                                                                                    \
  }                                                                                                                    \
  void omp_unset_##NAME(mtx_t *lock) {                                                                                 \
    mtx_unlock(lock);                                                                                                  \
  }
LOCK(lock, mtx_plain)
LOCK(nest_lock, mtx_recursive)

int omp_test_lock(omp_lock_t *lock) {
  return mtx_trylock(lock) == thrd_success;
}

int omp_test_nest_lock(omp_nest_lock_t *lock) {
  return mtx_trylock(lock) == thrd_success ? (int)lock->depth : 0;
}

#endif
