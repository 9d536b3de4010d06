/* OpenMP's functions, for programs compiled with -fopenmp (docs/parallel.md). */
#ifndef TRAX_OMP_H
#define TRAX_OMP_H

#include <threads.h>

typedef mtx_t omp_lock_t;
typedef mtx_t omp_nest_lock_t;
typedef enum omp_sched_t {
  omp_sched_static = 1,
  omp_sched_dynamic = 2,
  omp_sched_guided = 3,
  omp_sched_auto = 4
} omp_sched_t;
typedef enum omp_sync_hint_t {
  omp_sync_hint_none = 0,
  omp_sync_hint_uncontended = 1,
  omp_sync_hint_contended = 2,
  omp_sync_hint_nonspeculative = 4,
  omp_sync_hint_speculative = 8
} omp_sync_hint_t;

#ifdef __cplusplus
extern "C" {
#endif

int omp_get_thread_num(void);
int omp_get_num_threads(void);
int omp_get_max_threads(void);
int omp_get_num_procs(void); /* the chip's threads; 1 without trax-sim --main-on 0 */
int omp_get_thread_limit(void);
void omp_set_num_threads(int threads);
int omp_in_parallel(void);
int omp_get_level(void);
int omp_get_active_level(void);
int omp_get_ancestor_thread_num(int level);
int omp_get_team_size(int level);
int omp_get_dynamic(void);
void omp_set_dynamic(int dynamic); /* is not obeyed */
int omp_get_nested(void);
void omp_set_nested(int nested); /* is not obeyed: regions in regions have one thread */
int omp_get_max_active_levels(void);
void omp_set_max_active_levels(int levels); /* is not obeyed */
double omp_get_wtime(void);                 /* simulated seconds */
double omp_get_wtick(void);
int omp_is_initial_device(void);
int omp_get_num_devices(void);

void omp_init_lock(omp_lock_t *lock);
void omp_destroy_lock(omp_lock_t *lock);
void omp_set_lock(omp_lock_t *lock);
void omp_unset_lock(omp_lock_t *lock);
int omp_test_lock(omp_lock_t *lock);
void omp_init_nest_lock(omp_nest_lock_t *lock);
void omp_destroy_nest_lock(omp_nest_lock_t *lock);
void omp_set_nest_lock(omp_nest_lock_t *lock);
void omp_unset_nest_lock(omp_nest_lock_t *lock);
int omp_test_nest_lock(omp_nest_lock_t *lock);

#ifdef __cplusplus
}
#endif

#endif
