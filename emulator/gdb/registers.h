/* The machine's registers in the debugger's numbering. Stock GDB does not know the TP. The nearest machine that it
   knows is 32-bit RISC-V: return address in x1, stack pointer in x2, arguments in registers, results in the first of
   these. Each TRaX register has the RISC-V number of its role, here and in debug information (isa/TraxRegisters.td), so
   that GDB finds frames, variables, results and arguments. After pc, all registers follow once more by their TRaX
   numbers. */
#ifndef TRAX_GDB_REGISTERS_H
#define TRAX_GDB_REGISTERS_H

#include "trax/abi.h"

enum {
  TRAX_GDB_PC = 32,
  TRAX_GDB_OWN = 33, /* r0 */
  TRAX_GDB_REGISTERS = TRAX_GDB_OWN + TRAX_NUM_REGISTERS
};

#endif
