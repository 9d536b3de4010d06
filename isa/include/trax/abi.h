/* Numbers shared by compiler, linker, runtime, emulator and host; docs/abi.md says what they mean.
   Plain macros: included by C, C++ and assembly. */
#ifndef TRAX_ABI_H
#define TRAX_ABI_H

#include "trax/numbers.h" /* special registers, traps, fences, registers: generated from the description of the ISA */
#include "trax/ray_kinds.h"

#define TRAX_EM 0x7472 /* e_machine; unofficial: 't' 'r' */

/* e_flags: where the code expects the stack; none for code that works with both. */
#define TRAX_EF_STACK_LOCAL 1
#define TRAX_EF_STACK_GLOBAL 2

/* Sizes and alignments, in LLVM's notation. */
#define TRAX_DATA_LAYOUT "e-m:e-p:32:32-i64:32-f64:32-a:0:32-n32-S32"

/* Relocations: name, number. */
#define TRAX_RELOCATIONS(X)                                                                                            \
  X(R_TRAX_NONE, 0)                                                                                                    \
  X(R_TRAX_32, 1)                                                                                                      \
  X(R_TRAX_16, 2)                                                                                                      \
  X(R_TRAX_8, 3)                                                                                                       \
  X(R_TRAX_PC32, 4)                                                                                                    \
  X(R_TRAX_HI16, 5)                                                                                                    \
  X(R_TRAX_LO16, 6)                                                                                                    \
  X(R_TRAX_IMM16, 7)                                                                                                   \
  X(R_TRAX_BR16, 8)                                                                                                    \
  X(R_TRAX_JAL21, 9)                                                                                                   \
  X(R_TRAX_JUMP, 10)

#define TRAX_NULL_END 0x00001000u   /* first valid global address */
#define TRAX_LOCAL_BASE 0xFFFFFE00u /* first byte of local memory */
#define TRAX_LOCAL_SIZE 512u        /* bytes */
#define TRAX_STACK_GUARD 2048u      /* between two stacks in global memory; also keeps them off the same cache lines */

#endif
