/* Tasks in a ring, under one lock. */
#include "team.h"

#ifdef __trax__

enum { CAPACITY = 256 };

static struct {
  trax_task *function;
  void *context;
} ring[CAPACITY];
static unsigned first, last, unfinished; /* unfinished: in the ring, or running */
static struct ticket_lock ring_lock;

void trax_add_task(trax_task *task, void *context) {
  lock(&ring_lock);
  const int room = last - first < CAPACITY && unfinished;
  if (room) {
    ring[last % CAPACITY].function = task;
    ring[last % CAPACITY].context = context;
    last++;
    unfinished++;
  }
  unlock(&ring_lock);
  if (!room)
    task(context);
}

static void work(void *nothing) {
  (void)nothing;
  for (unsigned mine = 0; mine || load_shared(&unfinished);) {
    if (!mine && load_shared(&first) == load_shared(&last))
      continue;
    trax_task *task = NULL;
    void *context = NULL;
    lock(&ring_lock);
    unfinished -= mine;
    mine = first != last;
    if (mine) {
      task = ring[first % CAPACITY].function;
      context = ring[first % CAPACITY].context;
      first++;
    }
    unlock(&ring_lock);
    if (mine)
      task(context);
  }
}

void trax_run_tasks(trax_task *task, void *context) {
  if (trax_team_size() > 1 || trax_thread() || load_shared(&unfinished)) { /* within other work: all of it at once */
    task(context);
    return;
  }
  ring[first % CAPACITY].function = task;
  ring[first % CAPACITY].context = context;
  last++;
  unfinished = 1;
  trax_parallel(work, NULL);
}

#endif
