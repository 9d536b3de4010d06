#define _POSIX_C_SOURCE 200809L /* clock_gettime */
#include "machine/machine.h"

#include "fast/chip.h"
#include "sampling/slots.h"
#include "reference/run.h"

#include <inttypes.h>
#include <string.h>
#include <time.h>

const char *trax_fault_text(trax_fault_kind kind) {
  static const char *const texts[TRAX_FAULT_COUNT] = {
#define TEXT(ID, NAME, WORDS) WORDS,
      TRAX_FAULTS(TEXT)
#undef TEXT
  };
  return texts[kind];
}

const char *trax_fault_name(trax_fault_kind kind) {
  static const char *const names[TRAX_FAULT_COUNT] = {
#define NAME(ID, WORD, WORDS) WORD,
      TRAX_FAULTS(NAME)
#undef NAME
  };
  return names[kind];
}

trax_machine *trax_machine_create(const trax_config *config, trax_error *error) {
  if (trax_config_validate(config, error))
    return NULL;
  struct trax_machine *machine = calloc(1, sizeof *machine);
  const size_t threads = (size_t)config->chip.tms * config->chip.tps_per_tm;
  if (!machine) {
    trax_fail(error, "out of memory");
    return NULL;
  }
  machine->config = *config;
  machine->stats.threads = threads;
  machine->tm_stats = calloc(config->chip.tms, sizeof *machine->tm_stats);
  machine->tp_stats = calloc(threads, sizeof *machine->tp_stats);
  machine->exit_statuses = calloc(threads, sizeof *machine->exit_statuses);
  if (!machine->tm_stats || !machine->tp_stats || !machine->exit_statuses) {
    trax_fail(error, "out of memory for %zu threads", threads);
    trax_machine_destroy(machine);
    return NULL;
  }
  if (trax_space_create(&machine->space, (uint64_t)config->memory.size_mib << 20, error)) {
    trax_machine_destroy(machine);
    return NULL;
  }
  return machine;
}

void trax_machine_destroy(trax_machine *machine) {
  if (!machine)
    return;
  if (machine->host_destroy)
    machine->host_destroy(machine->host);
  trax_space_destroy(&machine->space);
  free(machine->tm_stats);
  free(machine->tp_stats);
  free(machine->exit_statuses);
  free(machine);
}

trax_status trax_machine_map(struct trax_machine *machine, uint32_t address, uint32_t bytes, unsigned permissions,
                             uint8_t **host, trax_error *error) {
  if (machine->has_run)
    return trax_fail(error, "the machine has run: nothing can be loaded into it any more");
  return trax_space_map(&machine->space, address, bytes, permissions, host, error);
}

trax_status trax_machine_set_entry(struct trax_machine *machine, uint32_t entry, trax_error *error) {
  bool executable = false;
  for (size_t i = 0; i < machine->space.segment_count; i++) {
    const struct trax_segment *segment = &machine->space.segments[i];
    executable |= (segment->permissions & TRAX_PERMIT_EXECUTE) && entry >= segment->address &&
                  (uint64_t)entry - segment->address + 4 <= segment->bytes;
  }
  if (!executable || entry % 4)
    return trax_fail(error, "entry point 0x%08x is not an instruction in an executable segment", entry);
  machine->entry = entry;
  machine->has_program = true;
  return TRAX_OK;
}

const struct trax_fault *trax_machine_fault(const struct trax_machine *machine) {
  return &machine->fault;
}

int trax_machine_exit_status(const trax_machine *machine) {
  if (machine->fault.kind)
    return machine->fault.kind == TRAX_FAULT_ABORT ? 134 : 1;
  for (uint64_t thread = 0; thread < machine->stats.threads; thread++)
    if (machine->exit_statuses[thread])
      return machine->exit_statuses[thread];
  return 0;
}

/* --- the run --- */

/* What is known from the operations issued need not be counted while they are. */
static void count_by_operation(struct trax_tm_stats *stats) {
  stats->fences += stats->instructions[TRAX_OP_FENCE];
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++) {
    const trax_op_info *info = &trax_op_table[op];
    const uint64_t count = stats->instructions[op];
    if (info->flags & TRAX_IS_FLOP)
      stats->flops += count;
    if (info->flags & TRAX_IS_ATOMIC)
      stats->atomics += count;
    if (info->unit == TRAX_UNIT_FP_MUL)
      stats->fp_mul_ops += count;
    else if (info->unit == TRAX_UNIT_INT_MUL)
      stats->int_mul_ops += count;
    else if (info->unit == TRAX_UNIT_SPECIAL)
      stats->special_ops += count;
  }
}

static void count_adder_operations(struct trax_tm_stats *stats, const struct trax_config *config) {
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
    if (trax_op_table[op].unit == TRAX_UNIT_FP_ADD &&
        ((trax_op_table[op].flags & TRAX_IS_FLOP) || !config->fpu.compare_units))
      stats->fp_add_ops += stats->instructions[op];
}

void trax_stats_derive(struct trax_tm_stats *stats, const struct trax_config *config) {
  count_by_operation(stats);
  count_adder_operations(stats, config);
}

static void add_stats(struct trax_tm_stats *sum, const struct trax_tm_stats *term) {
  for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++)
    sum->cycles[cause] += term->cycles[cause];
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
    sum->instructions[op] += term->instructions[op];
#define ADD(ID, NAME, UNIT, MEANING) sum->ID += term->ID;
  TRAX_TM_COUNTERS(ADD)
#undef ADD
}

/* Sums up, and checks the rule of accounting: every thread is charged every cycle once. */
static trax_status collect(struct trax_machine *machine, bool exact, trax_error *error) {
  const uint32_t tps = machine->config.chip.tps_per_tm;
  for (uint32_t i = 0; i < machine->config.chip.tms; i++) {
    struct trax_tm_stats *stats = &machine->tm_stats[i];
    trax_stats_derive(stats, &machine->config);
    for (uint32_t tp = 0; tp < tps; tp++) {
      const struct trax_tp_stats *charges = &machine->tp_stats[(size_t)i * tps + tp];
      uint64_t charged = 0;
      for (unsigned cause = 0; cause < TRAX_CAUSE_COUNT; cause++) {
        stats->cycles[cause] += charges->cycles[cause];
        charged += charges->cycles[cause];
      }
      if (charged != machine->stats.cycles)
        return trax_fail(error, "internal error: TM %u, TP %u is charged for %" PRIu64 " of %" PRIu64 " cycles", i, tp,
                         charged, machine->stats.cycles);
    }
    add_stats(&machine->stats.total, stats);
  }
  if (exact)
    machine->stats.instructions = machine->stats.total.cycles[TRAX_CAUSE_ISSUED];
  else /* charges are estimates, or there are none */
    for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
      machine->stats.instructions += machine->stats.total.instructions[op];
  return TRAX_OK;
}

static trax_status report_outcome(const struct trax_machine *machine, const trax_run_options *options,
                                  trax_error *error) {
  switch (machine->status) {
  case TRAX_FAULT:
    trax_fail(error, "%s at pc 0x%08x, thread %u, cycle %" PRIu64, trax_fault_text(machine->fault.kind),
              machine->fault.pc, machine->fault.thread, machine->fault.cycle);
    break;
  case TRAX_STUCK:
    if (options->engine == TRAX_ENGINE_FUNCTIONAL)
      trax_fail(error, "the program has not ended after %" PRIu64 " instructions of a thread", options->max_cycles);
    else
      trax_fail(error, "the program has not ended after %" PRIu64 " cycles", machine->stats.cycles);
    break;
  case TRAX_INTERRUPTED:
    if (options->engine == TRAX_ENGINE_FUNCTIONAL) /* it has no cycles */
      trax_fail(error, "interrupted in instruction %" PRIu64, machine->stats.instructions);
    else
      trax_fail(error, "interrupted in cycle %" PRIu64, machine->stats.cycles);
    break;
  default:
    break;
  }
  return machine->status;
}

void trax_machine_watch(struct trax_machine *machine, struct trax_watch *watch) {
  watch->others = machine->watches;
  machine->watches = watch;
}

void trax_machine_unwatch(struct trax_machine *machine, const struct trax_watch *watch) {
  struct trax_watch **link = &machine->watches;
  while (*link && *link != watch)
    link = &(*link)->others;
  if (*link)
    *link = watch->others;
}

static trax_status run_chip(struct trax_machine *machine, const trax_run_options *options, trax_error *error) {
  struct trax_chip chip;
  machine->chip = &chip;
  trax_status status = trax_chip_create(&chip, machine, options, error);
  if (status == TRAX_OK && machine->prepare)
    status = machine->prepare(machine->prepare_context, &chip, error);
  if (status == TRAX_OK) {
    status = trax_chip_run(&chip, options, &machine->stats.cycles);
    for (struct trax_watch *watch = machine->watches; watch; watch = watch->others)
      if (watch->end)
        watch->end(watch, &chip, status, machine->stats.cycles);
    trax_chip_settle(&chip, machine->stats.cycles);
    if (chip.slots && status == TRAX_OK)
      status = trax_slots_finish(chip.slots, machine->stats.cycles, error);
  }
  trax_chip_destroy(&chip);
  machine->chip = NULL;
  return status;
}

trax_status trax_machine_run(trax_machine *machine, const trax_run_options *options, trax_error *error) {
  static const trax_run_options no_options = {0};
  if (!machine->has_program)
    return trax_fail(error, "no program is loaded");
  if (machine->has_run)
    return trax_fail(error, "a machine runs once; create another");
  machine->has_run = true;
  if (!options)
    options = &no_options;
  if (options->slots && options->engine != TRAX_ENGINE_FAST)
    return trax_fail(error, "slots are sampled by the fast engine only");

  struct timespec begin, end;
  clock_gettime(CLOCK_MONOTONIC, &begin);
  machine->status = options->engine == TRAX_ENGINE_REFERENCE
                        ? trax_reference_run(machine, options, &machine->stats.cycles, error)
                        : run_chip(machine, options, error);
  clock_gettime(CLOCK_MONOTONIC, &end);
  machine->stats.host_seconds = (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
  if (machine->status == TRAX_ERROR)
    return TRAX_ERROR;
  machine->at_limit = machine->status == TRAX_STUCK && options->max_cycles &&
                      (options->engine == TRAX_ENGINE_FUNCTIONAL || machine->stats.cycles >= options->max_cycles);
  const bool exact = options->engine != TRAX_ENGINE_FUNCTIONAL && !options->slots;
  if (collect(machine, exact, error))
    return machine->status = TRAX_ERROR;
  return report_outcome(machine, options, error);
}
