/* Calls of the host (docs/isa.md, "Traps"), and special registers ("Special registers"). */
#ifndef TRAX_MACHINE_TRAPS_H
#define TRAX_MACHINE_TRAPS_H

#include "machine/address_space.h"
#include "machine/config.h"
#include "machine/stats.h"

#include <stdio.h>

/* Performs `trap value, code` of a thread with that local memory; TRAX_TRAP_EXIT is the engine's. Output goes to
   `output` unless that is NULL. Gives the fault of the trap, which then had no effect. */
trax_fault_kind trax_trap(const struct trax_space *space, const uint8_t *local, struct trax_tm_stats *stats,
                          FILE *output, uint32_t value, int32_t code);

/* What rdsr of special register `number`, which exists, gives a thread in cycle t. */
uint32_t trax_special_register(const struct trax_config *config, uint32_t thread, uint32_t number, uint64_t t);

#endif
