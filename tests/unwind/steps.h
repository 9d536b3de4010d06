/* Runs a program on one TP and hands over its state before every instruction. */
#ifndef TRAX_UNWIND_STEPS_H
#define TRAX_UNWIND_STEPS_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct unwind_state {
  uint32_t pc;
  const uint32_t *registers; /* 32, as they are before the instruction at pc */
  uint32_t previous_pc;      /* the instruction that came before; 0 at first */
  uint32_t previous_word;
  const void *machine;
} unwind_state;

/* False if the program could not be run to its end; the reason is on standard error. */
bool unwind_run(const char *path, void (*step)(void *context, const unwind_state *state), void *context);
/* The word at an address of local or global memory; false if there is none. */
bool unwind_load(const unwind_state *state, uint32_t address, uint32_t *value);

#ifdef __cplusplus
}
#endif
#endif
