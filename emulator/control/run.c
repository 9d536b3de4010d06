/* The run of a machine by one of the engines: beginning, advancing, end, and the calls between cycles. */
#define _POSIX_C_SOURCE 200809L /* clock_gettime */
#include "engine/run.h"
#include "calls/calls.h"
#include "control/engines.h"
#include "machine/ray_cycles.h"
#include "sampling/slots.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

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

/* A machine's run with its options and its sampling. */
struct run {
  struct trax_run run;
  trax_run_options options;
  struct trax_slots *slots;
};

static void destroy_run(struct trax_machine *machine) {
  struct run *run = (struct run *)machine->run;
  if (!run)
    return;
  trax_slots_destroy(run->slots);
  trax_run_destroy(&run->run);
  free(run);
  machine->run = NULL;
}

static double host_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static trax_status create_run(struct run *run, struct trax_machine *machine, const struct trax_engine *engine,
                              trax_error *error) {
  const trax_run_options *options = &run->options;
  const struct trax_calls_streams streams = {options->input, options->output,
                                             options->errors ? options->errors : options->output, options->interrupt};
  if (options->ray_cycles && trax_ray_cycles_create(machine, error) != TRAX_OK)
    return TRAX_ERROR;
  if (trax_calls_begin(machine, &streams, error) != TRAX_OK ||
      trax_run_create(&run->run, machine, engine, &run->options, error) != TRAX_OK)
    return TRAX_ERROR;
  if (machine->prepare && machine->prepare(machine->prepare_context, &run->run, error) != TRAX_OK)
    return TRAX_ERROR;
  if (run->options.slots && !(run->slots = trax_slots_create(&run->run, run->options.slots, error)))
    return TRAX_ERROR;
  return TRAX_OK;
}

trax_status trax_machine_begin(trax_machine *machine, const trax_run_options *options, trax_error *error) {
  static const trax_run_options no_options = {0};
  const struct trax_engine *engine = trax_engine_for(&machine->config);
  trax_error reason;
  if (!machine->has_program)
    return trax_fail(error, "no program is loaded");
  if (machine->has_run)
    return trax_fail(error, "a machine runs once; create another");
  if (!options)
    options = &no_options;
  if (options->engine && trax_engine_find(options->engine, &engine, &reason) != TRAX_OK)
    return trax_fail(error, "the engine %s %s", options->engine, reason.message);
  if (trax_engine_check(engine, &machine->config, error) != TRAX_OK)
    return TRAX_ERROR;
  if (options->slots && !engine->is_timed)
    return trax_fail(error, "the engine %s has no time: slots cannot be sampled", engine->name);
  if (options->ray_cycles && !engine->counts_rays)
    return trax_fail(error, "the engine %s does not count the cycles of rays", engine->name);
  const double begun = host_seconds();
  struct run *run = calloc(1, sizeof *run);
  if (!run)
    return trax_fail(error, "out of memory");
  machine->has_run = true;
  run->options = *options;
  machine->run = &run->run;
  machine->run_destroy = destroy_run;
  machine->status = create_run(run, machine, engine, error);
  if (machine->status != TRAX_OK)
    destroy_run(machine);
  machine->stats.host_seconds += host_seconds() - begun;
  return machine->status;
}

/* Completes the statistics of a run that has ended with machine->status. */
static trax_status complete(struct trax_machine *machine, trax_error *error) {
  struct run *run = (struct run *)machine->run;
  const struct trax_engine *engine = run->run.engine;
  const trax_run_options *options = &run->options;
  machine->stats.cycles = engine->is_timed ? run->run.t : 0;
  if ((machine->status == TRAX_OK || machine->status == TRAX_ERROR) && run->slots)
    machine->status = trax_slots_finish(run->slots, machine->stats.cycles, error);
  if (machine->status == TRAX_ERROR)
    return TRAX_ERROR;
  machine->at_limit = machine->status == TRAX_STUCK && options->max_cycles &&
                      (!engine->is_timed || machine->stats.cycles >= options->max_cycles);
  if (trax_stats_collect(machine, engine->is_timed && !options->slots, error) != TRAX_OK ||
      trax_calls_end(machine, machine->status == TRAX_OK, error) != TRAX_OK)
    return machine->status = TRAX_ERROR;
  return report_outcome(machine, &run->run, error);
}

trax_status trax_machine_advance(trax_machine *machine, uint64_t cycle, bool *ended, trax_error *error) {
  *ended = true;
  if (!machine->run)
    return trax_fail(error, machine->has_run ? "the run has ended" : "the run has not begun");
  const double begun = host_seconds();
  machine->status = trax_run_advance(machine->run, cycle);
  machine->stats.cycles = machine->run->t;
  *ended = machine->run->ended;
  trax_status status = TRAX_OK;
  if (*ended) {
    status = complete(machine, error);
    destroy_run(machine);
  }
  machine->stats.host_seconds += host_seconds() - begun;
  return status;
}

trax_status trax_machine_run(trax_machine *machine, const trax_run_options *options, trax_error *error) {
  bool ended;
  const trax_status status = trax_machine_begin(machine, options, error);
  return status == TRAX_OK ? trax_machine_advance(machine, UINT64_MAX, &ended, error) : status;
}

/* --- between cycles --- */

/* A watch that calls a trax_look. */
struct callback {
  struct trax_watch watch;
  trax_look *function;
  void *context;
};

static trax_status call_back(struct trax_watch *watch, struct trax_run *run, uint64_t t) {
  struct callback *callback = watch->context;
  uint64_t next = TRAX_NEVER;
  run->machine->stats.cycles = t;
  const bool goes_on = callback->function(callback->context, run->machine, t, &next);
  watch->next = next > t ? next : t + 1;
  return goes_on ? TRAX_OK : TRAX_INTERRUPTED;
}

trax_status trax_machine_look(trax_machine *machine, uint64_t cycle, trax_look *function, void *context,
                              trax_error *error) {
  struct callback *callback = calloc(1, sizeof *callback);
  if (!callback)
    return trax_fail(error, "out of memory");
  *callback = (struct callback){.function = function, .context = context};
  callback->watch = (struct trax_watch){.next = cycle, .inspect = call_back, .context = callback, .release = free};
  trax_machine_watch(machine, &callback->watch);
  return TRAX_OK;
}

uint64_t trax_machine_cycle(const trax_machine *machine) {
  return machine->stats.cycles;
}

trax_status trax_machine_read_registers(const trax_machine *machine, uint32_t thread, uint32_t registers[32],
                                        uint32_t *pc, trax_error *error) {
  if (!machine->run)
    return trax_fail(error, "no run is under way");
  if (thread >= machine->stats.threads)
    return trax_fail(error, "there is no thread %u, but only %u", thread, (unsigned)machine->stats.threads);
  trax_run_export(machine->run);
  const struct trax_thread state = trax_run_thread(machine->run, thread);
  memcpy(registers, state.reg, TRAX_NUM_REGISTERS * sizeof *registers);
  registers[0] = 0;
  *pc = state.pc;
  return TRAX_OK;
}
