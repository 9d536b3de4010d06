#include "engine/run.h"
#include "trax/pool.h"

#include <assert.h>
#include <string.h>

trax_status trax_run_create(struct trax_run *run, struct trax_machine *machine, const struct trax_engine *engine,
                            const struct trax_run_options *options, trax_error *error) {
  *run = (struct trax_run){.machine = machine, .engine = engine, .options = options};
  if (trax_text_create(&run->text, &machine->space, &machine->config, error) != TRAX_OK)
    return TRAX_ERROR;
  return engine->create(run, error);
}

void trax_run_destroy(struct trax_run *run) {
  run->engine->destroy(run->chip);
  trax_pool_destroy(run->pool);
  trax_text_destroy(&run->text);
}

struct trax_pool *trax_run_pool(struct trax_run *run, trax_error *error) {
  const unsigned tms = run->machine->config.chip.tms, most = tms > 1 ? tms : TRAX_RUN_THREADS;
  const unsigned threads = run->options->host_threads ? run->options->host_threads : trax_host_processors();
  if (!run->pool)
    run->pool = trax_pool_create(threads < most ? threads : most, error);
  return run->pool;
}

void trax_run_settle(struct trax_run *run, uint64_t t) {
  if (run->engine->settle)
    run->engine->settle(run->chip, t);
}

void trax_run_export(struct trax_run *run) {
  if (run->engine->export_state)
    run->engine->export_state(run->chip);
}

void trax_run_import(struct trax_run *run, uint64_t t) {
  if (run->engine->import_state)
    run->engine->import_state(run->chip, t);
}

struct trax_thread trax_run_thread(const struct trax_run *run, uint32_t thread) {
  return run->engine->thread(run->chip, thread);
}

uint64_t trax_run_progressed(const struct trax_run *run) {
  return run->engine->progressed ? run->engine->progressed(run->chip) : 0;
}

uint32_t trax_run_queued(const struct trax_run *run, uint32_t tm, uint64_t t) {
  return run->engine->queued(run->chip, tm, t);
}

/* --- the loop --- */

static void collect(void *run) {
  const struct trax_run *it = run;
  if (it->engine->collect)
    it->engine->collect(it->chip);
}

/* Calls the watches that are due before cycle t. *next receives the next cycle in which one is due. */
static trax_status call_watches(struct trax_run *run, uint64_t t, uint64_t *next) {
  trax_status status = TRAX_OK;
  *next = TRAX_NEVER;
  for (struct trax_watch *watch = run->machine->watches; watch && !status; watch = watch->others) {
    if (watch->next <= t) {
      status = watch->inspect(watch, run, t);
      assert(status || watch->next > t);
    }
    if (watch->next < *next)
      *next = watch->next;
  }
  if (run->engine->commit)
    run->engine->commit(run->chip);
  return status;
}

static void begin(struct trax_run *run) {
  const bool timed = run->engine->is_timed;
  const uint64_t asked = run->options->max_cycles && timed ? run->options->max_cycles : TRAX_NEVER;
  run->begun = true;
  run->t = run->begin;
  run->limit = asked > run->begin ? asked : run->begin; /* a resumed run may begin beyond the limit */
  run->next_watch = TRAX_NEVER;
  trax_poll_begin(&run->poll, run->machine, run->options);
  run->poll.collect = collect;
  run->poll.context = run;
  const struct trax_observer *observer = run->machine->observer;
  trax_error error; /* without a pool, an observer uses one thread */
  if (observer && observer->begin)
    observer->begin(observer->context, trax_run_pool(run, &error));
}

static uint64_t earliest(const struct trax_run *run, uint64_t until) {
  const uint64_t stop = run->limit < run->next_watch ? run->limit : run->next_watch;
  return stop < until ? stop : until;
}

static trax_status run_until(struct trax_run *run, uint64_t until) {
  const struct trax_engine *engine = run->engine;
  run->ended = true; /* unless `until` is reached */
  while (!run->complete) {
    if (run->t >= until) {
      run->ended = false;
      return TRAX_OK;
    }
    if (run->t >= run->next_watch) {
      const trax_status status = call_watches(run, run->t, &run->next_watch);
      if (status)
        return status;
    }
    if (run->t >= run->limit)
      return TRAX_STUCK;
    if (trax_poll(&run->poll, run->t))
      return TRAX_INTERRUPTED;
    const uint64_t before = run->t;
    switch (engine->advance(run->chip, &run->t, earliest(run, until))) {
    case TRAX_GOES_ON:
      break;
    case TRAX_HAS_ENDED:
      return TRAX_OK;
    case TRAX_HAS_FAULTED:
      return TRAX_FAULT;
    case TRAX_AT_LIMIT:
      return TRAX_STUCK;
    }
    trax_poll_pass(&run->poll, run->t > before ? run->t - before : TRAX_POLL_INTERVAL);
  }
  return TRAX_OK;
}

static trax_status advance(struct trax_run *run, uint64_t until) {
  if (!run->begun)
    begin(run);
  if (run->engine->is_timed)
    run->next_watch = run->t; /* a watch may have been added since */
  const trax_status status = run_until(run, until);
  if (run->engine->commit)
    run->engine->commit(run->chip);
  if (!run->ended)
    return status;
  trax_run_settle(run, run->t); /* records the fault, which the watches may read */
  if (run->machine->observer && run->engine->tell)
    run->engine->tell(run->chip);
  for (struct trax_watch *watch = run->machine->watches; watch; watch = watch->others)
    if (watch->end)
      watch->end(watch, run, status, run->t);
  return status;
}

trax_status trax_run_advance(struct trax_run *run, uint64_t until) {
  const trax_status status = advance(run, until);
  const struct trax_observer *observer = run->machine->observer;
  if (observer && observer->end)
    observer->end(observer->context);
  return status;
}
