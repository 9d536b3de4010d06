# The run's status is that of the lowest-numbered thread that has one; a thread that has ended stays so, the others go on.
# threads: 2 2
# entry: lowest_wins the_lowest_thread_with_a_status status 3
# entry: zero_counts_not the_lowest_thread_with_a_status status 9
# entry: late_wins the_lowest_thread_with_a_status status 1
# entry: all_halt halt status 0
# entry: low_byte low_byte_of_the_status status 0x34
# entry: negative low_byte_of_the_status status 0xff
  .macro begin
  la r31, begin_signature
  li r29, 0x600d
  rdsr r4, thread
  bne r4, r0, 1f
  sw r29, 0(r31)
1:
  .endm
  .macro status a, b, c, d      # of threads 0 to 3
  la r5, 8f
  slli r6, r4, 2
  add r5, r5, r6
  lw r7, 0(r5)
  trap r7, exit
  sw r29, 4(r31)
  .pushsection .rodata, "a"
8: .word \a, \b, \c, \d
  .popsection
  .endm
lowest_wins:
  begin
  status 0, 3, 5, 7
zero_counts_not:
  begin
  status 0, 0, 0, 9
late_wins:
  begin
  bne r4, r0, 2f
  addi r8, r0, 300
3:
  addi r8, r8, -1
  bne r8, r0, 3b
  sw r8, 8(r31)
2:
  status 1, 2, 3, 4
all_halt:
  begin
  halt
  sw r29, 4(r31)
low_byte:
  begin
  status 0x1234, 0, 0, 0
negative:
  begin
  status -1, 1, 1, 1
