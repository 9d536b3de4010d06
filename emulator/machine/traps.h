/* Calls of the host (docs/isa.md, "Traps"). */
#ifndef TRAX_MACHINE_TRAPS_H
#define TRAX_MACHINE_TRAPS_H

#include "machine/address_space.h"

#include <stdbool.h>
#include <stdio.h>

struct trax_tm;

/* Performs `trap value, code` of TP `tp` in cycle t. False if it faulted. */
bool trax_trap(struct trax_tm *tm, unsigned tp, uint32_t value, int32_t code, uint64_t t);

/* Writes the string at a global address, or in a TP's local memory, to the guest's output, unless that is NULL. Gives
   the fault if the string leaves memory; then nothing is written. */
trax_fault_kind trax_put_string(const struct trax_space *space, const uint8_t *local, uint32_t address, FILE *output);

#endif
