# Registers, local memory and uninitialised data are zero in every thread; the first instruction is the entry's.
# threads: 2 3
# results: 48
# case: registers 186
# case: local memory 768
# case: zeros of the image 96
# case: pc 6
  .globl _start
  jal r0, _start                # not the entry, though it is first
  addi r1, r0, -1
_start:
  or r1, r1, r2                 # what all have in common, without a register for an address
  .irp n, 3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31
  or r1, r1, r\n
  .endr
  addi r2, r0, -512
  addi r3, r0, 0
1:
  lw r4, 0(r2)
  or r3, r3, r4
  addi r2, r2, 4
  bne r2, r0, 1b
  la r2, zeros
  la r5, zeros+64
  addi r4, r0, 0
2:
  lw r6, 0(r2)
  or r4, r4, r6
  addi r2, r2, 4
  bne r2, r5, 2b
  jal r7, 3f
3:
  la r8, 3b
  sub r7, r7, r8                # 0
  own_part r9, 5
  sw r1, 0(r9)
  sw r3, 4(r9)
  sw r4, 8(r9)
  sw r7, 12(r9)
  la r10, words
  lw r11, 0(r10)
  lw r12, 4(r10)
  lw r13, 8(r10)
  sw r11, 16(r9)
  sw r12, 20(r9)
  sw r13, 24(r9)
  rdsr r14, thread
  sw r14, 28(r9)
  la r28, arrived
  barrier 6
  beq r14, r0, check
  halt

  .data
words: .word 0x01234567, 0x89abcdef
  .byte 1, 2, 3, 4
  .p2align 6
arrived: .word 0
  .bss
  .p2align 2
zeros: .zero 64
