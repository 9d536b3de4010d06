/* The machine's registers in the debugger's numbering. Stock GDB does not know the TP. The nearest machine that it
   knows is 32-bit RISC-V: return address in x1, stack pointer in x2, arguments in registers, results in the first of
   these. Each TRaX register has the RISC-V number of its role (docs/abi.md, "Registers"), so that GDB finds frames,
   results and arguments. After pc, all registers follow once more by their TRaX numbers.

   A target description alone does not suffice: it names and numbers the registers of the protocol, and GDB takes the
   numbers in debug information, arguments and results from its own tables of RISC-V. With x_i = r_i and debug
   information as it is, frames and variables are right, but `finish` shows another register, and a call of a function
   by `print` faults. */
#ifndef TRAX_GDB_REGISTERS_H
#define TRAX_GDB_REGISTERS_H

#include "trax/abi.h"

enum {
  TRAX_GDB_PC = 32,
  TRAX_GDB_OWN = 33, /* r0 */
  TRAX_GDB_REGISTERS = TRAX_GDB_OWN + TRAX_NUM_REGISTERS
};

/* Row i: the TRaX register that is shown as x_i, and its RISC-V name. */
#define TRAX_GDB_ROLES(X)                                                                                              \
  X(0, "zero")                                                                                                         \
  X(1, "ra")                                                                                                           \
  X(2, "sp")                                                                                                           \
  X(19, "gp") /* t7 */                                                                                                 \
  X(31, "tp") /* s11 */                                                                                                \
  X(12, "t0")                                                                                                          \
  X(13, "t1")                                                                                                          \
  X(14, "t2")                                                                                                          \
  X(3, "fp")                                                                                                           \
  X(20, "s1")                                                                                                          \
  X(4, "a0")                                                                                                           \
  X(5, "a1")                                                                                                           \
  X(6, "a2")                                                                                                           \
  X(7, "a3")                                                                                                           \
  X(8, "a4")                                                                                                           \
  X(9, "a5")                                                                                                           \
  X(10, "a6")                                                                                                          \
  X(11, "a7")                                                                                                          \
  X(21, "s2")                                                                                                          \
  X(22, "s3")                                                                                                          \
  X(23, "s4")                                                                                                          \
  X(24, "s5")                                                                                                          \
  X(25, "s6")                                                                                                          \
  X(26, "s7")                                                                                                          \
  X(27, "s8")                                                                                                          \
  X(28, "s9")                                                                                                          \
  X(29, "s10")                                                                                                         \
  X(30, "s11")                                                                                                         \
  X(15, "t3")                                                                                                          \
  X(16, "t4")                                                                                                          \
  X(17, "t5")                                                                                                          \
  X(18, "t6")

#endif
