/* C11's threads: a thread of the machine that waits for work takes a function, and waits again after it. */
#include "team.h"

#ifdef __trax__

#include <setjmp.h>
#include <threads.h>

enum state { WAITING, GIVEN, DONE };
struct errand {
  unsigned state, detached; /* a waiting thread polls the state */
  thrd_start_t function;
  void *argument;
  int result;
};
static struct errand *errands; /* one for each thread */
static unsigned given;         /* those that are not WAITING */
static struct ticket_lock errands_lock;
static _Thread_local jmp_buf *end_of_errand;

__attribute__((weak)) void __trax_tss_end(void); /* runs the destructors of tss_create */

unsigned __trax_errands(void) {
  return load_shared(&given);
}

static void over(struct errand *errand) {
  store_shared(&errand->state, WAITING);
  given--;
}

void __trax_errand(void) {
  struct errand *errand = __atomic_load_n(&errands, __ATOMIC_RELAXED);
  if (!errand || load_shared(&(errand += trax_thread())->state) != GIVEN)
    return;
  acquire_fence();
  jmp_buf here;
  end_of_errand = &here;
  if (!setjmp(here))
    errand->result = errand->function(errand->argument);
  end_of_errand = NULL;
  if (__trax_tss_end)
    __trax_tss_end();
  lock(&errands_lock);
  if (errand->detached)
    over(errand);
  else
    store_shared(&errand->state, DONE);
  unlock(&errands_lock);
}

int thrd_create(thrd_t *thread, thrd_start_t function, void *argument) {
  if (trax_team_size() > 1 || (!errands && (trax_thread() || !__trax_team_open())))
    return thrd_error;
  lock(&errands_lock);
  if (!errands) {
    struct errand *const made = calloc(trax_threads(), sizeof *made);
    release_fence(); /* before a waiting thread finds them */
    errands = made;
  }
  unsigned i = 1;
  while (errands && i < trax_threads() && load_shared(&errands[i].state) != WAITING)
    i++;
  const int result = !errands ? thrd_nomem : i == trax_threads() ? thrd_error : thrd_success;
  if (result == thrd_success) {
    errands[i].detached = 0;
    errands[i].function = function;
    errands[i].argument = argument;
    given++;
    *thread = i;
    release_fence();
    store_shared(&errands[i].state, GIVEN);
  }
  unlock(&errands_lock);
  return result;
}

int thrd_join(thrd_t thread, int *result) {
  while (load_shared(&errands[thread].state) != DONE)
    ;
  lock(&errands_lock);
  if (result)
    *result = errands[thread].result;
  over(&errands[thread]);
  unlock(&errands_lock);
  return thrd_success;
}

int thrd_detach(thrd_t thread) {
  lock(&errands_lock);
  errands[thread].detached = 1;
  if (load_shared(&errands[thread].state) == DONE)
    over(&errands[thread]);
  unlock(&errands_lock);
  return thrd_success;
}

void thrd_exit(int status) {
  if (!end_of_errand)
    exit(status);
  errands[trax_thread()].result = status;
  longjmp(*end_of_errand, 1);
}

#endif
