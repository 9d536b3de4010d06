// argc and argv. The linker takes this file for programs whose main uses them: the compiler refers to __trax_argv there.
// crt0 sets each of them to 0 by one instruction; the __trax_start here returns to the place after both.
#include <trax/abi.h>

  .globl __trax_argv
  .set __trax_argv, 0

  .cfi_sections .debug_frame
  .section .text.__trax_start, "ax", @progbits
  .globl __trax_start
  .type __trax_start, @function
__trax_start:
  .cfi_startproc
  addi r2, r2, -4
  .cfi_def_cfa_offset 4
  sw r1, 0(r2)
  .cfi_offset r1, -4
  jal r1, __trax_prepare
  lui r5, %hi(__trax_arguments)
  lw r4, %lo(__trax_arguments)(r5)
  lw r5, %lo(__trax_arguments + 4)(r5)
  lw r1, 0(r2)
  addi r2, r2, 4
  .cfi_def_cfa_offset 0
  jalr r0, 8(r1)
  .cfi_endproc
  .size __trax_start, . - __trax_start
  .section .stack_sizes, "o", @progbits, .text.__trax_start
  .long __trax_start
  .uleb128 4

  // The loader stores argc and argv here, and the arguments after the program.
  .section .bss.__trax_arguments, "aw", @nobits
  .globl __trax_arguments
  .type __trax_arguments, @object
  .p2align 3
__trax_arguments:
  .zero 8
  .size __trax_arguments, 8
