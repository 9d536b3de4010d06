# A program that asks for stacks in global memory (docs/abi.md): the 2 kB below each cannot be stored to.
# threads: 2 1
# link: --defsym=__trax_stack_size=4096
# entry: below stack stack
# entry: lowest stack stack
# entry: second_thread stack stack
# entry: second_lowest stack stack
# entry: increment stack stack
# entry: around writable status 0
  .set end, 0x01000000
  .macro begin
  la r31, begin_signature
  li r29, 0x600d
  rdsr r4, thread
  beq r4, r0, 1f
  halt
1:
  sw r29, 0(r31)
  .endm
below:
  begin
  li r5, end-4096
  sw r5, 0(r5)
  lb r6, -1(r5)
  sw r6, 8(r31)
  sb r0, -1(r5)
  sw r29, 4(r31)
lowest:
  begin
  li r5, end-4096-2048
  sw r5, -4(r5)
  sw r5, 0(r5)
  sw r29, 4(r31)
second_thread:
  begin
  li r5, end-2*4096-2048-4
  swnt r5, 4(r5)
  sh r5, 2(r5)
  sw r29, 4(r31)
second_lowest:
  begin
  li r5, end-2*4096-2*2048
  sw r5, -4(r5)
  sb r5, 0(r5)
  sw r29, 4(r31)
increment:
  begin
  li r5, end-4096-1024
  ainc r6, 0(r5)
  addi r6, r6, 0
  sw r29, 4(r31)
around:
  begin
  li r5, end-4
  sw r5, 0(r5)
  lw r6, 0(r5)
  sw r6, 8(r31)
  li r5, end-4096-1024
  lw r6, 0(r5)
  sw r6, 12(r31)
  li r5, end-4096-2048-4
  sw r5, 0(r5)
  lw r6, 0(r5)
  sw r6, 16(r31)
  trap r0, exit
