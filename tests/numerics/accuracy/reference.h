/* The references of the functions: the host's binary64 functions over a chunk, and MPFR's for one result. */
#ifndef TRAX_TEST_ACCURACY_REFERENCE_H
#define TRAX_TEST_ACCURACY_REFERENCE_H

#include "accuracy.h"
#include "functions.h"

#define DECLARE_REFERENCES(name, host, exact, low, high)                                                               \
  void host_##name##_chunk(struct chunk *chunk);                                                                       \
  void exact_##name(mpfr_t result, const mpfr_t *operand);
EXACT_FUNCTIONS(DECLARE_REFERENCES)
ADAPTED_FUNCTIONS(DECLARE_REFERENCES)
TRANSCENDENTAL_FUNCTIONS(DECLARE_REFERENCES)
EXACT_PAIRS(DECLARE_REFERENCES)
ADAPTED_PAIRS(DECLARE_REFERENCES)
TRANSCENDENTAL_PAIRS(DECLARE_REFERENCES)
TRIPLES(DECLARE_REFERENCES)
#undef DECLARE_REFERENCES

#endif
