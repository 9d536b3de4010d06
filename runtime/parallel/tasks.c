/* Tasks in a ring without a lock. A thread that adds or wants a task draws a number; the n-th task is for the n-th
   thread that wants one, which polls the task's place. */
#include "team.h"

#ifdef __trax__

enum { PLACES = 1024, ROOM = PLACES / 2 /* for threads that add at the same moment */ };

static struct place {
  unsigned turn; /* number of the task that may be written here; 1 more if it is here */
  trax_task *function;
  void *context;
} places[PLACES];
static unsigned added, wanted, ended;
static _Thread_local int serves; /* this thread takes tasks from the ring */

void trax_add_task(trax_task *task, void *context) {
  if (!serves || (int)(load_shared(&added) - load_shared(&wanted)) > ROOM) {
    task(context);
    return;
  }
  release_fence();
  const unsigned number = trax_atomic_inc(&added);
  struct place *place = &places[number % PLACES];
  while (load_shared(&place->turn) != number)
    ;
  place->function = task;
  place->context = context;
  release_fence();
  store_shared(&place->turn, number + 1);
}

/* Whether all tasks have ended. Only a running task, which has not ended, adds others. */
static int all_ended(void) {
  const unsigned number = load_shared(&ended);
  if (number != load_shared(&added))
    return 0;
  acquire_fence(); /* `ended` before `added` */
  const unsigned before = load_shared(&ended);
  acquire_fence();
  return before == load_shared(&added);
}

static void work(void *nothing) {
  (void)nothing;
  serves = 1;
  for (;;) {
    const unsigned number = trax_atomic_inc(&wanted);
    struct place *place = &places[number % PLACES];
    while (load_shared(&place->turn) != number + 1)
      if (all_ended()) {
        serves = 0;
        return;
      }
    acquire_fence();
    trax_task *task = place->function;
    void *context = place->context;
    store_shared(&place->turn, number + PLACES);
    task(context);
    release_fence();
    trax_atomic_inc(&ended);
  }
}

void trax_run_tasks(trax_task *task, void *context) {
  if (__trax_team_members || trax_thread()) { /* all of them at once on this thread */
    const int before = serves;
    serves = 0;
    task(context);
    serves = before;
    return;
  }
  for (unsigned i = 0; i < PLACES; i++)
    places[i].turn = i;
  added = wanted = ended = 0;
  serves = 1;
  trax_add_task(task, context);
  trax_parallel(work, NULL);
}

#endif
