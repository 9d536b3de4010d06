# Each thread has local memory of its own at the same addresses, for loads and stores of every size.
# threads: 2 3
# results: 774
# case: words of each thread 768
# case: bytes and half words of each thread 3072
  .globl _start
_start:
  rdsr r4, thread
  addi r5, r0, -512
  slli r6, r4, 24
  addi r7, r6, 0
1:
  sw r7, 0(r5)
  addi r7, r7, 7
  add r9, r7, r4
  sb r9, 1(r5)
  sub r9, r9, r6
  slli r10, r4, 12
  add r9, r9, r10
  sh r9, 2(r5)
  addi r5, r5, 4
  bne r5, r0, 1b
  la r28, arrived
  barrier 6
  own_part r8, 9
  addi r5, r0, -512
  addi r9, r0, 0                # sum of what the shorter loads give
2:
  lb r7, 3(r5)
  add r9, r9, r7
  lbu r7, 1(r5)
  slli r7, r7, 4
  add r9, r9, r7
  lh r7, 2(r5)
  slli r7, r7, 1
  add r9, r9, r7
  lhu r7, 0(r5)
  slli r7, r7, 3
  add r9, r9, r7
  lw r7, 0(r5)
  sw r7, 0(r8)
  addi r8, r8, 4
  addi r5, r5, 4
  bne r5, r0, 2b
  slli r5, r4, 2
  la r8, begin_signature+3072
  add r8, r8, r5
  sw r9, 0(r8)
  barrier 6
  beq r4, r0, check
  halt
  .data
  .p2align 6
arrived: .word 0
