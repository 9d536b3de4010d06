/* Definitions for the mutants of statements.py in emulator/reference/issue.c; included before all else. */
#include <stdint.h>

extern unsigned trax_mutant;

/* r0 of these registers keeps the value until it is written again (machine.c). */
void trax_keep_r0(const uint32_t *registers, uint32_t value);
