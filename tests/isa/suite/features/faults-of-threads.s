# A fault of one thread ends the machine, whatever the others do: each of them, for ever.
# threads: 2 2
# entry: thread_0 others_go_on null
# entry: thread_1 others_go_on misaligned
# entry: thread_2 others_go_on illegal
# entry: thread_3 others_go_on abort
# entry: all_but_one_ended others_have_ended fetch
  .macro begin
  la r31, begin_signature
  li r25, 0x600d
  rdsr r4, thread
  la r28, arrived
  bne r4, r0, 1f
  sw r25, 0(r31)
1:
  slli r5, r4, 2
  add r5, r5, r31
  sw r4, 8(r5)                  # each stores before any goes on
  barrier 4
  .endm
  .macro only number            # the others go round for ever, one of them storing
  addi r6, r0, \number
  beq r4, r6, 2f
  la r7, scratch
3:
  sw r6, 0(r7)
  jal r0, 3b
2:
  .endm
thread_0:
  begin
  only 0
  lw r6, 0(r0)
  sw r25, 4(r31)
thread_1:
  begin
  only 1
  lw r6, 1(r31)
  sw r25, 4(r31)
thread_2:
  begin
  only 2
  .word 0
  sw r25, 4(r31)
thread_3:
  begin
  only 3
  trap r0, abort
  sw r25, 4(r31)
all_but_one_ended:
  begin
  addi r6, r0, 2
  beq r4, r6, 4f
  halt
4:
  jalr r1, 0(r0)
  sw r25, 4(r31)
  .data
arrived: .word 0
  .p2align 6
scratch: .word 0
