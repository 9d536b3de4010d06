// Program start: every TP begins here at cycle 0 with all registers 0 (docs/abi.md, "Program start"). A stack pointer of 0
// is the end of local memory. Assembled with TRAX_GLOBAL_STACK, for -mstack=global, this sets it to the top of the
// thread's stack in global memory.
//
// A call of an undefined weak function continues after the call. So parts that the program lacks are skipped.
#include <trax/abi.h>

#ifdef TRAX_GLOBAL_STACK
  .stack global
#else
  .stack local
#endif
  .weak __trax_start, __trax_argv, __trax_end_thread, __trax_end_program

  .cfi_sections .debug_frame
  .section .text._start, "ax", @progbits
  .globl _start
  .type _start, @function
_start:
  .cfi_startproc
  .cfi_undefined r1 // there is no caller: debuggers stop here
#ifdef TRAX_GLOBAL_STACK
  lui r12, %hi(__trax_stack_top)
  lw r2, %lo(__trax_stack_top)(r12)
  beq r2, r0, .Lno_stack
  lui r13, %hi(__trax_stack_size + TRAX_STACK_GUARD)
  addi r13, r13, %lo(__trax_stack_size + TRAX_STACK_GUARD)
  rdsr r12, TRAX_SR_THREAD
  mul r12, r12, r13
  sub r2, r2, r12
#endif
  jal r1, __trax_start
  addi r4, r0, 0 // argc
  addi r5, r0, %abs(__trax_argv)
  jal r1, main
  addi r20, r4, 0
  jal r1, __trax_end_thread
  jal r1, __trax_end_program
  trap r20, TRAX_TRAP_EXIT
#ifdef TRAX_GLOBAL_STACK
.Lno_stack:
  lui r4, %hi(.Lmessage)
  addi r4, r4, %lo(.Lmessage)
  trap r4, TRAX_TRAP_ABORT
#endif
  .cfi_endproc
  .size _start, . - _start
  .section .stack_sizes, "o", @progbits, .text._start
  .long _start
  .uleb128 0

#ifdef TRAX_GLOBAL_STACK
  .section .rodata.str, "aMS", @progbits, 1
.Lmessage:
  .asciz "the loader gave no stack in global memory: was the symbol table removed?"

  // The loader stores the end of memory here.
  .section .bss.__trax_stack_top, "aw", @nobits
  .globl __trax_stack_top
  .type __trax_stack_top, @object
  .p2align 2
__trax_stack_top:
  .zero 4
  .size __trax_stack_top, 4
#endif
