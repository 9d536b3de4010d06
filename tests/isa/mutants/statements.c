/* The list of the mutants that statements.py has made. */
#include "mutants.h"

#include <stdio.h>

static const struct trax_mutant_text texts[] = {
#define STATEMENT_MUTANT(MNEMONIC, WHAT) {MNEMONIC, WHAT, ""},
#include "statements.inc"
#undef STATEMENT_MUTANT
};

unsigned trax_statement_mutants(void) {
  return sizeof texts / sizeof *texts;
}

void trax_statement_mutant(unsigned index, struct trax_mutant_text *text) {
  *text = texts[index];
}
