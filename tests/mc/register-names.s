# Registers have a number and a name; numbers are printed.
# RUN: %trax_mc %s | FileCheck %s

# CHECK: add r0, r1, r2
add zero, ra, sp
# CHECK: add r3, r4, r5
add fp, a0, a1
# CHECK: add r6, r7, r8
add a2, a3, a4
# CHECK: add r9, r10, r11
add a5, a6, a7
# CHECK: add r12, r13, r14
add t0, t1, t2
# CHECK: add r15, r16, r17
add t3, t4, t5
# CHECK: add r18, r19, r20
add t6, t7, s0
# CHECK: add r21, r22, r23
add s1, s2, s3
# CHECK: add r24, r25, r26
add s4, s5, s6
# CHECK: add r27, r28, r29
add s7, s8, s9
# CHECK: add r30, r31, r31
add s10, s11, r31
# Case does not matter.
# CHECK: add r4, r20, r2
add A0, S0, SP
# CHECK: lw r4, 8(r2)
lw a0, 8(sp)
