/* Traps (docs/isa.md, "Traps") and special registers ("Special registers"). */
#ifndef TRAX_MACHINE_TRAPS_H
#define TRAX_MACHINE_TRAPS_H

#include "machine/machine.h"

#include <stdio.h>

/* Performs `trap value, code`, except for TRAX_TRAP_EXIT, which the engine performs. local: the thread's local memory;
   output: receives the guest's output, NULL discards it. Returns the trap's fault; a trap that faults has no effect. */
trax_fault_kind trax_trap(const struct trax_machine *machine, uint8_t *local, struct trax_tm_stats *stats, FILE *output,
                          uint32_t value, int32_t code);

/* Returns the value of special register `number`, which must exist, for a thread in cycle t. */
uint32_t trax_special_register(const struct trax_config *config, uint32_t thread, uint32_t number, uint64_t t);

#endif
