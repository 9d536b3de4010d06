/* Mutants of the machine: ways to implement it wrong, all compiled into one program and chosen by number (mutant
   schemata). The conformance suite must catch every one (tests/isa/mutants/check.py).

   A mutant belongs to an instruction, whose tests are tried first, and has a text that describes the fault. Numbers run
   from 1: statements of the semantics (statements.py), arithmetic (arithmetic.inc), decoding (decode.c), the rest of
   the machine (machine.c). Number 0 is the machine as it is. */
#ifndef TRAX_TESTS_ISA_MUTANTS_H
#define TRAX_TESTS_ISA_MUTANTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

extern unsigned trax_mutant; /* the one in force */

struct trax_mutant_text {
  char mnemonic[16]; /* "" if no single instruction's */
  char what[96];
  char image[48]; /* the name of one that is likely to notice; "" if none in particular */
};

/* The number of mutants of each sort, and the texts of one. `index` counts from 0 within the sort. */
unsigned trax_statement_mutants(void);
void trax_statement_mutant(unsigned index, struct trax_mutant_text *text);
unsigned trax_arithmetic_mutants(void);
void trax_arithmetic_mutant(unsigned index, struct trax_mutant_text *text);
unsigned trax_decoding_mutants(void);
void trax_decoding_mutant(unsigned index, struct trax_mutant_text *text);
unsigned trax_machine_mutants(void);
void trax_machine_mutant(unsigned index, struct trax_mutant_text *text);
unsigned trax_order_mutants(void);
void trax_order_mutant(unsigned index, struct trax_mutant_text *text);

/* The index in force within a sort that begins behind `before` mutants; -1: another sort's, or none. */
static inline int trax_mutant_index(unsigned before, unsigned count) {
  return trax_mutant > before && trax_mutant <= before + count ? (int)(trax_mutant - before - 1) : -1;
}

#endif
