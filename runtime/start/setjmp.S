// setjmp and longjmp: what a call preserves, ra and sp.

  .section .text.setjmp, "ax", @progbits
  .globl setjmp
  .type setjmp, @function
setjmp:
  sw r1, 0(r4)
  sw r2, 4(r4)
  sw r3, 8(r4)
  sw r20, 12(r4)
  sw r21, 16(r4)
  sw r22, 20(r4)
  sw r23, 24(r4)
  sw r24, 28(r4)
  sw r25, 32(r4)
  sw r26, 36(r4)
  sw r27, 40(r4)
  sw r28, 44(r4)
  sw r29, 48(r4)
  sw r30, 52(r4)
  sw r31, 56(r4)
  addi r4, r0, 0
  jalr r0, 0(r1)
  .size setjmp, . - setjmp
  .section .stack_sizes, "o", @progbits, .text.setjmp
  .long setjmp
  .uleb128 0

  .section .text.longjmp, "ax", @progbits
  .globl longjmp
  .type longjmp, @function
longjmp:
  lw r1, 0(r4)
  lw r2, 4(r4)
  lw r3, 8(r4)
  lw r20, 12(r4)
  lw r21, 16(r4)
  lw r22, 20(r4)
  lw r23, 24(r4)
  lw r24, 28(r4)
  lw r25, 32(r4)
  lw r26, 36(r4)
  lw r27, 40(r4)
  lw r28, 44(r4)
  lw r29, 48(r4)
  lw r30, 52(r4)
  lw r31, 56(r4)
  addi r4, r0, 1
  cmovnz r4, r5, r5 // longjmp(e, 0) returns 1
  jalr r0, 0(r1)
  .size longjmp, . - longjmp
  .section .stack_sizes, "o", @progbits, .text.longjmp
  .long longjmp
  .uleb128 0
