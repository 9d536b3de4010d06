# What the assembler knows needs no relocation.
# RUN: %trax_mc -filetype=obj -o %t.o %s
# RUN: %trax_objdump -d -r %t.o | FileCheck %s

.equ value, 0x12348765
# CHECK-NOT: R_TRAX
# CHECK: 0: 44801235 lui r4, 4661
lui r4, %hi(value)
# CHECK-NEXT: 4: 20848765 addi r4, r4, -30875
addi r4, r4, %lo(value)
# CHECK-NEXT: 8: 2080fe00 li r4, -512
addi r4, r0, %abs(0xFFFFFE00)
loop:
# CHECK: c: 84800000 bnez r4, 0xc <loop>
bnez r4, loop
# CHECK-NEXT: 10: 981fffff j 0xc <loop>
j loop
# CHECK-NEXT: 14: 80850002 beq r4, r5, 0x1c <forward>
beq r4, r5, forward
# CHECK-NEXT: 18: 981ffff8 j 0xfffffff8
j loop - 20
forward:
# CHECK: 1c: 20800010 li r4, 16
addi r4, r0, %abs(forward - loop)
# CHECK-NOT: R_TRAX
