/* The engines by name, and a machine's run by one of them. */
#define _POSIX_C_SOURCE 200809L /* clock_gettime */
#include "host/engines.h"
#include "engine/run.h"
#include "fast/chip.h"
#include "functional/functional.h"
#include "reference/run.h"
#include "sampling/slots.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* The first is the default. Behind the first three, variants of the first. */
static const struct trax_engine *const engines[] = {
    &trax_fast_engine,        &trax_reference_engine, &trax_functional_engine, &trax_fast_any_engine,
#ifdef TRAX_FAST_HAVE_V3
    &trax_fast_avx2_engine,
#endif
#ifdef TRAX_FAST_HAVE_V4
    &trax_fast_avx512_engine,
#endif
};
enum { ENGINES = sizeof engines / sizeof *engines, MAIN_ENGINES = 3 };

static bool every_engine(const struct trax_engine *engine) {
  (void)engine;
  return true;
}

void trax_engine_names(bool (*can)(const struct trax_engine *engine), char *names, size_t size) {
  unsigned left = 0;
  size_t length = 0;
  for (unsigned i = 0; i < MAIN_ENGINES; i++)
    left += can(engines[i]);
  *names = '\0';
  for (unsigned i = 0; i < MAIN_ENGINES && length < size; i++)
    if (can(engines[i]))
      length += (size_t)snprintf(names + length, size - length, "%s%s", engines[i]->name,
                                 --left > 1 ? ", "
                                 : left     ? " or "
                                            : "");
}

trax_status trax_engine_find(const char *name, const struct trax_engine **engine, trax_error *error) {
  char names[128];
  *engine = engines[0];
  if (!name)
    return TRAX_OK;
  for (unsigned i = 0; i < ENGINES; i++)
    if (strcmp(engines[i]->name, name) == 0) {
      *engine = engines[i];
      return !engines[i]->is_possible || engines[i]->is_possible() ? TRAX_OK
                                                                   : trax_fail(error, "cannot run on this host");
    }
  trax_engine_names(every_engine, names, sizeof names);
  return trax_fail(error, "is not %s", names);
}

/* --- the run --- */

static trax_status report_outcome(const struct trax_machine *machine, const struct trax_run *run, trax_error *error) {
  const bool timed = run->engine->is_timed;
  switch (machine->status) {
  case TRAX_FAULT:
    trax_fail(error, "%s at pc 0x%08x, thread %u, cycle %" PRIu64, trax_fault_text(machine->fault.kind),
              machine->fault.pc, machine->fault.thread, machine->fault.cycle);
    break;
  case TRAX_STUCK:
    if (timed)
      trax_fail(error, "the program has not ended after %" PRIu64 " cycles", machine->stats.cycles);
    else
      trax_fail(error, "the program has not ended after %" PRIu64 " instructions of a thread",
                run->options->max_cycles);
    break;
  case TRAX_INTERRUPTED:
    trax_fail(error, "interrupted in %s %" PRIu64, timed ? "cycle" : "instruction",
              timed ? machine->stats.cycles : machine->stats.instructions);
    break;
  default:
    break;
  }
  return machine->status;
}

static trax_status go(struct trax_run *run, trax_error *error) {
  struct trax_machine *machine = run->machine;
  const trax_run_options *options = run->options;
  struct trax_slots *slots = NULL;
  trax_status status = TRAX_OK;
  if (machine->prepare)
    status = machine->prepare(machine->prepare_context, run, error);
  if (status == TRAX_OK && options->slots && !(slots = trax_slots_create(run, options->slots, error)))
    status = TRAX_ERROR;
  if (status == TRAX_OK)
    status = trax_run_go(run, &machine->stats.cycles);
  if (status == TRAX_OK && slots)
    status = trax_slots_finish(slots, machine->stats.cycles, error);
  trax_slots_destroy(slots);
  return status;
}

trax_status trax_machine_run(trax_machine *machine, const trax_run_options *options, trax_error *error) {
  static const trax_run_options no_options = {0};
  const struct trax_engine *engine;
  if (!machine->has_program)
    return trax_fail(error, "no program is loaded");
  if (machine->has_run)
    return trax_fail(error, "a machine runs once; create another");
  if (!options)
    options = &no_options;
  trax_error reason;
  if (trax_engine_find(options->engine, &engine, &reason) != TRAX_OK)
    return trax_fail(error, "the engine %s %s", options->engine, reason.message);
  if (options->slots && !engine->is_timed)
    return trax_fail(error, "the engine %s has no time: slots cannot be sampled", engine->name);
  machine->has_run = true;

  struct timespec begin, end;
  clock_gettime(CLOCK_MONOTONIC, &begin);
  struct trax_run run;
  machine->run = &run;
  machine->status = trax_run_create(&run, machine, engine, options, error);
  if (machine->status == TRAX_OK)
    machine->status = go(&run, error);
  trax_run_destroy(&run);
  machine->run = NULL;
  clock_gettime(CLOCK_MONOTONIC, &end);
  machine->stats.host_seconds = (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
  if (machine->status == TRAX_ERROR)
    return TRAX_ERROR;
  machine->at_limit = machine->status == TRAX_STUCK && options->max_cycles &&
                      (!engine->is_timed || machine->stats.cycles >= options->max_cycles);
  if (trax_stats_collect(machine, engine->is_timed && !options->slots, error) != TRAX_OK)
    return machine->status = TRAX_ERROR;
  return report_outcome(machine, &run, error);
}
