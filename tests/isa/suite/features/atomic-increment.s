# Six threads increment words that share a line: each number is given once, and the numbers of a thread ascend.
# threads: 2 3
# results: 776
# case: each number once 384
# case: words beside each other 384
# case: ascending in a thread 378
  .globl _start
_start:
  la r4, shared
  addi r5, r0, -1               # the thread's latest number
  addi r6, r0, 64
  addi r7, r0, 0                # numbers out of order
  la r8, begin_signature+32     # a word for each number
  rdsr r9, thread
  slli r10, r9, 2
  la r11, others
  add r11, r11, r10             # a word of the thread's own, and its right neighbour's
1:
  ainc r12, 0(r4)
  slt r13, r5, r12
  xori r13, r13, 1
  add r7, r7, r13
  addi r5, r12, 0
  slli r14, r12, 2
  add r14, r14, r8
  lwnt r15, 0(r14)              # 0xdeadbeef the first time
  addi r15, r15, 1
  sw r15, 0(r14)
  ainc r16, 0(r11)
  ainc r17, 4(r11)
  sub r16, r16, r17
  slli r14, r12, 2
  la r18, begin_signature+1568
  add r14, r14, r18
  sw r12, 0(r14)
  addi r6, r6, -1
  bne r6, r0, 1b
  slli r14, r9, 2
  la r8, begin_signature
  add r14, r14, r8
  sw r7, 0(r14)
  la r28, arrived
  barrier 6
  bne r9, r0, 4f
  lwnt r12, 0(r4)               # 384
  sw r12, 24(r8)
  addi r5, r0, 0                # the neighbours: 64, five times 128, 64
  la r11, others
  addi r6, r0, 7
2:
  lwnt r12, 0(r11)
  slli r5, r5, 2
  add r5, r5, r12
  addi r11, r11, 4
  addi r6, r6, -1
  bne r6, r0, 2b
  sw r5, 28(r8)
  jal r0, check
4:
  halt

  .data
  .p2align 6
shared: .word 0
others: .word 0, 0, 0, 0, 0, 0, 0
  .p2align 6
arrived: .word 0
