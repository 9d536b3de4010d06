/* A case for which engines differ, made smaller. */
#ifndef TRAX_TIMING_MINIMISE_H
#define TRAX_TIMING_MINIMISE_H

#include "cases.h"

/* Takes away instructions, threads and values of keys as long as anything still differs, for at most a minute. */
void minimise(struct random_case *random_case);

/* Keys that have not their defaults, as options of trax-sim, and the program in assembly. */
void print_case(const struct random_case *random_case, FILE *out);

/* Writes the words without [begin, end) to result and returns how many are left; branches go where they went, or behind
   what is gone. */
size_t without_words(const uint32_t *words, size_t count, size_t begin, size_t end, uint32_t *result);

#endif
