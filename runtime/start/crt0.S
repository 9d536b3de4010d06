// Program start: every TP begins here at cycle 0 with all registers 0, so the stack pointer already stands at the end of local
// memory (docs/abi.md, "Program start").
#include <trax/abi.h>

  .section .text._start, "ax", @progbits
  .globl _start
  .type _start, @function
_start:
  lui r12, %hi(__init_array_start)
  addi r12, r12, %lo(__init_array_start)
  lui r13, %hi(__init_array_end)
  addi r13, r13, %lo(__init_array_end)
  bne r12, r13, .Lconstructors
.Lmain:
  addi r4, r0, 0 // argc
  addi r5, r0, 0 // argv
  jal r1, main
  trap r4, TRAX_TRAP_EXIT
.Lconstructors:
  jal r1, __trax_run_constructors
  jal r0, .Lmain
  .size _start, . - _start
