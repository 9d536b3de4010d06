# Each thread has local memory of its own at the same addresses.
# threads: 2 3
# results: 768
# case: words of each thread 768
  .globl _start
_start:
  rdsr r4, thread
  addi r5, r0, -512
  slli r6, r4, 24
  addi r7, r6, 0
1:
  sw r7, 0(r5)
  addi r7, r7, 7
  addi r5, r5, 4
  bne r5, r0, 1b
  la r28, arrived
  barrier 6
  own_part r8, 9
  addi r5, r0, -512
2:
  lw r7, 0(r5)
  sw r7, 0(r8)
  addi r8, r8, 4
  addi r5, r5, 4
  bne r5, r0, 2b
  barrier 6
  beq r4, r0, check
  halt
  .data
  .p2align 6
arrived: .word 0
