/* Legal words for the way through disassembler and assembler: little endian, one behind the other. */
#ifndef TRAX_ISA_DIFFERENTIAL_WORDS_H
#define TRAX_ISA_DIFFERENTIAL_WORDS_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Those of a program that are legal. */
void write_words(FILE *out, const uint32_t *words, size_t count);
/* Words of every instruction: registers and immediates at both ends, and each bit of them. */
void write_extreme_words(FILE *out);
/* count of every instruction, any fields; those that are legal. From random_state. */
void write_random_words(FILE *out, unsigned count);

#endif
