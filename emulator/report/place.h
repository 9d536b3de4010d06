/* Places of a program and of its source, as reports for people show them. */
#ifndef TRAX_REPORT_PLACE_H
#define TRAX_REPORT_PLACE_H

#include <stdint.h>
#include <stdio.h>

struct trax_loaded;
struct trax_symbol;

enum { TRAX_LABEL = 12 }; /* width of the labels of fault reports */

/* Prints "symbol" or "symbol+0x10". */
void trax_print_symbol(const struct trax_symbol *symbol, uint32_t address, FILE *out);
/* Prints the word of an instruction and its disassembly, without tabs. */
void trax_print_instruction(uint32_t word, uint32_t pc, FILE *out);
/* Prints a row with symbol and source lines of a place in the text; nothing if neither is known. */
void trax_print_place(const struct trax_loaded *loaded, const char *label, uint32_t pc, FILE *out);

#endif
