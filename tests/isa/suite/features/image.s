# The contents of memory at the start, and its parts that can be read and written.
# threads: 1 1
# results: 20
# link: -Ttext=0x2000 -Tdata=0x40000
# case: data of the image 4
# case: its zeros, up to the end of a segment 3
# case: text and constants can be read 3
# case: memory that no segment has 10
  .globl _start
_start:
  la r31, begin_signature
  la r4, words
  lw r5, 0(r4)
  sw r5, 0(r31)
  lhu r5, 4(r4)
  sw r5, 4(r31)
  lbu r5, 6(r4)
  sw r5, 8(r31)
  lb r5, 7(r4)
  sw r5, 12(r31)
  la r4, zeros
  lw r5, 0(r4)
  sw r5, 16(r31)
  lw r5, 60(r4)
  sw r5, 20(r31)
  la r4, zeros_end
  lbu r5, -1(r4)
  sw r5, 24(r31)
  la r4, _start
  lw r5, 0(r4)                  # an instruction
  sw r5, 28(r31)
  la r4, constants
  lw r5, 0(r4)
  sw r5, 32(r31)
  lw r5, 4(r4)
  sw r5, 36(r31)
  addi r31, r31, 40
  la r6, free
  addi r7, r0, 5
1:
  lw r4, 0(r6)
  addi r6, r6, 4
  lw r5, 0(r4)                  # 0 at the start
  sw r5, 0(r31)
  sw r6, 0(r4)
  lw r5, 0(r4)
  sw r5, 4(r31)
  addi r31, r31, 8
  addi r7, r7, -1
  bne r7, r0, 1b
  jal r0, check
  .section .rodata, "a"
constants: .word 0x13579bdf, 0xfdb97531
free: .word 0x1000, 0x1ffc, 0x800000, 0x900004, 0xfffffc
  .data
  .p2align 2
words: .word 0x01234567
  .half 0xfedc
  .byte 0x7f, 0x80
  .bss
  .p2align 2
zeros: .zero 101
zeros_end:
