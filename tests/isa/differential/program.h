/* Random programs from the description of the ISA: every instruction, operands dense in corner values. */
#ifndef TRAX_ISA_DIFFERENTIAL_PROGRAM_H
#define TRAX_ISA_DIFFERENTIAL_PROGRAM_H

#include "generate.h" /* tests/timing: a source of numbers, a bench's memory */

enum { MOST_WORDS = 2048, MOST_PROGRAM_THREADS = 24 };

/* Actions that depend on the order of threads, or end the machine. */
enum program_kind {
  PROGRAM_ALONE,    /* one thread, any output, faults */
  PROGRAM_TOGETHER, /* threads that touch only their own words, and common ones by ainc without a result */
  PROGRAM_WORDS,    /* one thread: words of any bits */
  PROGRAM_KINDS
};
extern const char *const program_kind_names[PROGRAM_KINDS];

/* Writes a program that runs at TEXT on DATA as program_data leaves it; at most MOST_WORDS words. The first *prologue
   words set up the threads. memory_end: where global memory ends. Numbers come from random_state. */
size_t any_differential_program(enum program_kind kind, uint32_t memory_end, uint32_t *words, size_t *prologue);

/* The initial bytes of DATA: corner values, from random_state. */
void program_data(uint8_t *bytes);

#endif
