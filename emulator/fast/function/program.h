/* The program in the form in which bursts execute it and heads find what their timing needs. */
#ifndef TRAX_FAST_PROGRAM_H
#define TRAX_FAST_PROGRAM_H

#include "machine/text.h"
#include "machine/units.h"
#include "translate/burst.h"

enum { TRAX_FAST_LINES = 1024 /* entries of `resident`; the last one stands for all further lines */ };

/* The first kind of shared units that TRAX_STEP_FURTHER encodes. */
#define TRAX_FAST_FURTHER ((unsigned)TRAX_SHARED_SPECIAL + 1)

/* The execution's form of an instruction: four to a line of the host's cache. */
struct trax_fast_inst {
  const void *operation; /* the label in burst_steps.h that executes it; of a chunk's first, the one that records it */
  int32_t imm;
  uint8_t op; /* trax_op; TRAX_OP_ILLEGAL if a burst must end before it: then only `decoded` has the operation */
  uint8_t rd, ra, rb;
};

/* The timing's form of an instruction. */
struct trax_fast_timing {
  const struct trax_decoded *decoded;
  uint32_t waits; /* mask of registers that must be usable */
  uint32_t pc;
};

struct trax_fast_section {
  uint32_t begin, bytes;
  uint32_t first_line;         /* the number of its first line in the cache */
  uint32_t last_line;          /* that of the address after it */
  uint16_t line;               /* the index of the first line in `resident` */
  struct trax_fast_inst *inst; /* [bytes / 4 + 1]; the last one is no text */
};

struct trax_fast_program {
  struct trax_fast_section *sections; /* [count]; their instructions are in one array */
  size_t count, inst_count;
  uint32_t lines;                  /* lines of instructions; TRAX_FAST_LINES: or more */
  struct trax_fast_inst *inst;     /* [inst_count] */
  struct trax_fast_timing *timing; /* [inst_count] */
  uint16_t *line;                  /* [inst_count]: the index of its line in `resident` */
  uint16_t *step;                  /* [inst_count + TRAX_CHUNK]: its step, unless an address decides it */
  uint16_t *number;                /* [inst_count + TRAX_CHUNK]: the low bits of its index */
  uint64_t *chunk_lines;           /* [inst_count]: bit line % 64 of the lines up to a jump or the chunk's end */
  struct trax_fast_inst *no_text;  /* the last instruction, for every pc that is no text */
};

/* calls: bursts end before calls, returns, and instructions that write the stack pointer. */
trax_status trax_fast_program_create(struct trax_fast_program *program, const struct trax_text *text,
                                     const struct trax_config *config, bool calls, trax_error *error);
void trax_fast_program_destroy(struct trax_fast_program *program);

static inline const struct trax_fast_inst *trax_fast_inst_at(const struct trax_fast_program *program, uint32_t pc) {
  for (size_t i = 0; i < program->count && pc % 4 == 0; i++)
    if (pc - program->sections[i].begin < program->sections[i].bytes)
      return program->sections[i].inst + (pc - program->sections[i].begin) / 4;
  return program->no_text;
}

#endif
