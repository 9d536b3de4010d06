/* Calls of the host (docs/abi.md, "Traps to the host"). */
#ifndef TRAX_CORE_TRAPS_H
#define TRAX_CORE_TRAPS_H

#include <stdbool.h>
#include <stdint.h>

struct trax_tm;

/* Performs `trap value, code` of TP `tp` in cycle t. False if it faulted. */
bool trax_trap(struct trax_tm *tm, unsigned tp, uint32_t value, int32_t code, uint64_t t);

#endif
