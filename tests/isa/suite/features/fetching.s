# Where text ends: the words before the end are executed, what is behind is not.
# link: -Ttext=0x1000 -Tdata=0x3000 --section-start=.last=0xffffc0 --section-start=.odd=0x2000
# entry: to_the_end fetch fetch
# entry: to_the_end_of_memory fetch fetch
# entry: before_text fetch fetch
# entry: behind_a_branch fetch fetch
  .macro begin
  la r31, begin_signature
  li r29, 0x600d
  sw r29, 0(r31)
  .endm
to_the_end:
  begin
  la r4, odd
  jalr r0, 0(r4)
to_the_end_of_memory:
  begin
  la r4, last
  jalr r0, 0(r4)
before_text:                    # a jump to the last word of a page that no segment has
  begin
  la r4, odd-4
  jalr r1, 0(r4)
behind_a_branch:                # not taken
  begin
  la r4, odd_branch
  jalr r0, 0(r4)
  .section .odd, "ax"           # 3 words: the segment ends within 64 bytes
odd:
  addi r5, r0, 5
  sw r5, 8(r31)
odd_branch:
  bne r0, r0, 4
  .section .last, "ax"
last:
  .rept 15
  nop
  .endr
  sw r4, 12(r31)
