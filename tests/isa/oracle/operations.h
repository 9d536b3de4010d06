/* The operations that isa-exhaustive compares with the oracle. */
#ifndef TRAX_ISA_ORACLE_OPERATIONS_H
#define TRAX_ISA_ORACLE_OPERATIONS_H

#include <stdint.h>

#define MOST_KEPT 5

/* A case whose results differ. Operations of one operand have b = 0. */
struct difference {
  uint64_t number; /* of the case */
  uint32_t a, b, result, oracle;
};

/* Differences in some cases: how many, and those with the lowest numbers, in that order. */
struct differences {
  uint64_t count;
  struct difference kept[MOST_KEPT];
};

void add_difference(struct differences *differences, struct difference one);

/* An operation, and its operands by number. A case follows from its number alone. */
struct operation {
  const char *name;     /* the instruction's, or the library function's */
  unsigned arity;       /* 1 or 2 */
  const char *operands; /* the operands of the numbers below `all` */
  uint64_t all;         /* where the numbers end, if they do; else 0 */
  void (*compare)(uint64_t first, uint64_t count, struct differences *found);
};

extern const struct operation operations[];
extern const unsigned operation_count;

#endif
