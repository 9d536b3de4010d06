/* The state that translated code works on. */
#ifndef TRAX_TRANSLATE_STATE_H
#define TRAX_TRANSLATE_STATE_H

#include <stddef.h>
#include <stdint.h>

/* Places in `reg` of the groups of registers that an instruction reads. */
enum { TRAX_GROUP_A_AT = 32, TRAX_GROUP_B_AT = 48, TRAX_TRANSLATED_REGISTERS = 64 };

struct trax_translated {
  uint32_t reg[TRAX_TRANSLATED_REGISTERS]; /* the thread's, unless they are in registers of the host; and groups */
  uint8_t *global, *local;
  const uint8_t *restrictions;
  uint64_t accessible;
  uint32_t begin, bytes; /* the program's first segment */
  uint32_t pc;           /* the target of the latest jump to a register's value */
  int64_t left;          /* instructions; of a burst: its steps so far */
  /* Only bursts have these. */
  uint8_t *blocks;
  int64_t *deltas;
  uint32_t input_bytes;
  uint64_t executions[]; /* [exit] */
};

#endif
