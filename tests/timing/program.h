/* A program under construction, instruction by instruction. */
#ifndef TRAX_TIMING_PROGRAM_H
#define TRAX_TIMING_PROGRAM_H

#include "bench.h"

struct program {
  uint32_t words[1024];
  size_t count;
};

static inline void emit(struct program *program, uint32_t word) {
  assert_true(program->count < sizeof program->words / sizeof *program->words);
  program->words[program->count++] = word;
}

/* A loop of two instructions, or of three with a body other than 0. r3 counts its turns. */
static inline void emit_loop(struct program *program, unsigned turns, uint32_t body) {
  emit(program, I(ADDI, 3, 0, (int32_t)turns));
  const size_t loop = program->count;
  if (body)
    emit(program, body);
  emit(program, I(ADDI, 3, 3, -1));
  emit(program, B(BNE, 3, 0, ((int32_t)loop - (int32_t)program->count) * 4));
}

#endif
