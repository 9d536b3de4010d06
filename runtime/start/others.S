// The start of threads other than 0 with --main-on 0, in programs that have trax_start_threads: crt0 without main.
#include <trax/abi.h>

  .weak __trax_stack_size, __trax_stack_top, __trax_end_thread, __trax_end_program

  .cfi_sections .debug_frame
  .section .text.__trax_others, "ax", @progbits
  .globl __trax_others
  .type __trax_others, @function
__trax_others:
  .cfi_startproc
  .cfi_undefined r1
  lui r13, %hi(__trax_stack_size)
  addi r13, r13, %lo(__trax_stack_size)
  beq r13, r0, .Lready // the stack is in local memory
  lui r12, %hi(__trax_stack_top)
  lw r2, %lo(__trax_stack_top)(r12)
  addi r13, r13, TRAX_STACK_GUARD
  rdsr r12, TRAX_SR_THREAD
  mul r12, r12, r13
  sub r2, r2, r12
.Lready:
  jal r1, __trax_prepare
  jal r1, __trax_wait
  jal r1, __trax_end_thread
  jal r1, __trax_end_program
  trap r0, TRAX_TRAP_EXIT
  .cfi_endproc
  .size __trax_others, . - __trax_others
  .section .stack_sizes, "o", @progbits, .text.__trax_others
  .long __trax_others
  .uleb128 0
