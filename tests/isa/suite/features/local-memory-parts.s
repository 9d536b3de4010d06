# Bytes and half words of local memory are each thread's own too.
# threads: 2 3
# results: 48
# case: bytes of each thread 24
# case: half words of each thread 24
  .globl _start
_start:
  rdsr r4, thread
  addi r5, r0, -512
  addi r6, r4, 0x91
  slli r7, r4, 8
  addi r7, r7, 0x7ff
  sub r9, r0, r7
  sw r0, 0(r5)
  sw r0, 4(r5)
  sb r6, 0(r5)
  sb r4, 3(r5)
  sh r7, 4(r5)
  sh r9, 6(r5)
  la r28, arrived
  barrier 6
  own_part r8, 5
  lb r10, 0(r5)
  sw r10, 0(r8)
  lbu r10, 0(r5)
  sw r10, 4(r8)
  lb r10, 3(r5)
  sw r10, 8(r8)
  lw r10, 0(r5)
  sw r10, 12(r8)
  lh r10, 6(r5)
  sw r10, 16(r8)
  lhu r10, 6(r5)
  sw r10, 20(r8)
  lh r10, 4(r5)
  sw r10, 24(r8)
  lw r10, 4(r5)
  sw r10, 28(r8)
  barrier 6
  beq r4, r0, check
  halt
  .data
  .p2align 6
arrived: .word 0
