#include "machine/machine.h"

#include "machine/ray_cycles.h"
#include "machine/watch.h"

#include <stdlib.h>

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

const trax_config *trax_machine_config(const trax_machine *machine) {
  return &machine->config;
}

void trax_machine_destroy(trax_machine *machine) {
  if (!machine)
    return;
  if (machine->run_destroy)
    machine->run_destroy(machine);
  while (machine->watches) {
    struct trax_watch *watch = machine->watches;
    machine->watches = watch->others;
    if (watch->release)
      watch->release(watch->context);
  }
  if (machine->calls.destroy)
    machine->calls.destroy(machine->calls.context);
  if (machine->loaded_destroy)
    machine->loaded_destroy(machine->loaded);
  trax_space_destroy(&machine->space);
  free(machine->tm_stats);
  free(machine->tp_stats);
  free(machine->exit_statuses);
  trax_ray_cycles_destroy(machine->ray_cycles);
  free(machine);
}

trax_status trax_machine_map(struct trax_machine *machine, uint32_t address, uint32_t bytes, unsigned permissions,
                             uint8_t **loaded, trax_error *error) {
  if (machine->has_run)
    return trax_fail(error, "the machine has run: nothing can be loaded into it any more");
  return trax_space_map(&machine->space, address, bytes, permissions, loaded, error);
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
  machine->entry = machine->other_entry = entry;
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
