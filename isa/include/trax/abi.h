/* Numbers shared by compiler, linker, runtime, emulator and host; docs/abi.md says what they mean.
   Plain macros: included by C, C++ and assembly. */
#ifndef TRAX_ABI_H
#define TRAX_ABI_H

#define TRAX_EM 0x7472 /* e_machine; unofficial: 't' 'r' */

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
#define TRAX_NUM_REGISTERS 32

/* Special registers: constant, assembler name, number. */
#define TRAX_SPECIAL_REGISTERS(X)                                                                                      \
  X(TRAX_SR_THREAD, "thread", 0)                                                                                       \
  X(TRAX_SR_TM, "tm", 1)                                                                                               \
  X(TRAX_SR_TP, "tp", 2)                                                                                               \
  X(TRAX_SR_THREADS, "threads", 3)                                                                                     \
  X(TRAX_SR_CYCLE, "cycle", 4)                                                                                         \
  X(TRAX_SR_CYCLEH, "cycleh", 5)

#define TRAX_SR_THREAD 0
#define TRAX_SR_TM 1
#define TRAX_SR_TP 2
#define TRAX_SR_THREADS 3
#define TRAX_SR_CYCLE 4
#define TRAX_SR_CYCLEH 5
#define TRAX_SR_COUNT 6

/* Traps: constant, assembler name, number. */
#define TRAX_TRAPS(X)                                                                                                  \
  X(TRAX_TRAP_EXIT, "exit", 0)                                                                                         \
  X(TRAX_TRAP_PUTC, "putc", 1)                                                                                         \
  X(TRAX_TRAP_ABORT, "abort", 2)                                                                                       \
  X(TRAX_TRAP_RAYS, "rays", 3)                                                                                         \
  X(TRAX_TRAP_ITEMS, "items", 4)                                                                                       \
  X(TRAX_TRAP_PUTS, "puts", 5)                                                                                         \
  X(TRAX_TRAP_KINDS, "kinds", 6)

#define TRAX_TRAP_EXIT 0
#define TRAX_TRAP_PUTC 1
#define TRAX_TRAP_ABORT 2
#define TRAX_TRAP_RAYS 3
#define TRAX_TRAP_ITEMS 4
#define TRAX_TRAP_PUTS 5
#define TRAX_TRAP_KINDS 6
#define TRAX_TRAP_COUNT 7

/* Kinds of rays: Y(X, ID, name, number, meaning). The operand of the trap `kinds` has TRAX_KIND_BITS bits for each,
   kind 0 in the lowest. <trax.h> has the same numbers. */
#define TRAX_RAY_KINDS(Y, X)                                                                                           \
  Y(X, PRIMARY, primary, 0, "from the eye")                                                                            \
  Y(X, SHADOW, shadow, 1, "towards a light")                                                                           \
  Y(X, OCCLUSION, occlusion, 2, "ambient occlusion: is something near the surface?")                                   \
  Y(X, DIFFUSE, diffuse, 3, "scattered by a diffuse surface")                                                          \
  Y(X, GLOSSY, glossy, 4, "scattered by a surface with a rough layer")                                                 \
  Y(X, MIRROR, mirror, 5, "reflected by a mirror or by glass")                                                         \
  Y(X, GLASS, glass, 6, "refracted by glass")                                                                          \
  Y(X, OTHER, other, 7, "of no stated kind, as all that the trap rays counts")

#define TRAX_RAY_KIND_COUNT 8
#define TRAX_KIND_BITS 4

/* Kinds of fences: constant, assembler name, number; RW is both. */
#define TRAX_FENCES(X)                                                                                                 \
  X(TRAX_FENCE_R, "r", 1)                                                                                              \
  X(TRAX_FENCE_W, "w", 2)                                                                                              \
  X(TRAX_FENCE_RW, "rw", 3)

#define TRAX_FENCE_R 1
#define TRAX_FENCE_W 2
#define TRAX_FENCE_RW 3

#endif
