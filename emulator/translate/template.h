/* The templates that extract-templates takes from the object file of templates.c. */
#ifndef TRAX_TRANSLATE_TEMPLATE_H
#define TRAX_TRANSLATE_TEMPLATE_H

#include "trax/isa.h"

/* The kinds of holes that are filled in: targets of jumps, and constants. */
enum trax_hole_kind {
  TRAX_HOLE_GOES_ON, /* behind the hot part, its result in the register of the first operand */
  TRAX_HOLE_JUMPS,   /* to the taken jump */
  TRAX_HOLE_SLOW,    /* to the exit after which the instruction is interpreted */
  TRAX_HOLE_HOT,     /* to a place of the hot part */
  TRAX_HOLE_COLD,    /* to a place of the cold part */
  TRAX_HOLE_POOL,    /* to a constant of trax_template_pool */
  TRAX_HOLE_IMM,
  TRAX_HOLE_PC,
  TRAX_HOLE_PRECISION,
  TRAX_HOLE_MINUS_INPUT, /* -trax_space.input */
  TRAX_HOLE_INPUT_BYTES, /* trax_space.input_bytes */
  TRAX_HOLE_STEP_AT,     /* of bursts: the place of the step, for r14 + 2 * r15 */
  TRAX_HOLE_STEP,        /* the step of a load of global memory, without its bank */
  TRAX_HOLE_BANK_MASK,
  TRAX_HOLE_LOCAL_STEP, /* the step of a load of local memory */
  TRAX_HOLES
};

struct trax_template_hole {
  uint16_t offset; /* of 4 bytes; before TRAX_HOLE_IMM they are relative to their own place */
  uint8_t kind;    /* trax_hole_kind */
  int32_t addend;
};

struct trax_template_part {
  const uint8_t *code;
  const struct trax_template_hole *holes;
  uint16_t bytes, hole_count;
};

struct trax_template {
  struct trax_template_part hot, cold; /* the cold part is rarely executed, or empty */
  bool goes_on;                        /* in some case, to the next instruction */
};

/* The variants of a template, by the registers of a, b and the result: the sum of those that are floating-point ones.
 */
enum { TRAX_FLOAT_A = 1, TRAX_FLOAT_B = 2, TRAX_FLOAT_D = 4, TRAX_VARIANTS = 8 };

/* No template has more, its cold part included: bytes of code, and jumps to exits. */
enum { TRAX_MOST_BYTES = 16000, TRAX_MOST_STUBS = 8 };

enum { TRAX_OP_LOOKUP = TRAX_OP_COUNT };
extern const struct trax_template trax_templates[TRAX_OP_COUNT + 1][TRAX_VARIANTS];
/* Templates of loads and stores for bursts. The other operations have no code here. */
extern const struct trax_template trax_burst_templates[TRAX_OP_COUNT + 1][TRAX_VARIANTS];
extern const uint8_t trax_template_pool[];
extern const unsigned trax_template_pool_bytes;

#endif
