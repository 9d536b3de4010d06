# Every relocation of an instruction's field.
# RUN: %trax_mc -show-encoding %s | FileCheck %s --check-prefix=FIXUP
# RUN: %trax_mc -filetype=obj -o %t.o %s
# RUN: %trax_objdump -d -r %t.o | FileCheck %s
# RUN: llvm-readelf -r %t.o | FileCheck %s --check-prefix=NUMBERS

# FIXUP: lui r4, %hi(g) # encoding: [A,A,0x80,0x44]
# FIXUP-NEXT: value: %hi(g), kind: fixup_hi16
# CHECK: 00000000: R_TRAX_HI16 g
# NUMBERS: 00000000 {{[0-9a-f]+}}05
lui r4, %hi(g)
# FIXUP: addi r4, r4, %lo(g+12)
# FIXUP-NEXT: value: %lo(g+12), kind: fixup_lo16
# CHECK: 00000004: R_TRAX_LO16 g+0xc
# NUMBERS: 00000004 {{[0-9a-f]+}}06
addi r4, r4, %lo(g+12)
# CHECK: 00000008: R_TRAX_LO16 g-0x4
lw r4, %lo(g-4)(r4)
# CHECK: 0000000c: R_TRAX_LO16 g
sw r4, %lo(g)(r5)
# FIXUP: value: %abs(x), kind: fixup_imm16
# CHECK: 00000010: R_TRAX_IMM16 x
# NUMBERS: 00000010 {{[0-9a-f]+}}07
addi r4, r0, %abs(x)
# CHECK: 00000014: R_TRAX_IMM16 x+0x8
lw r4, %abs(x+8)(r0)
# FIXUP: kind: fixup_br16
# CHECK: 00000018: R_TRAX_BR16 f
# NUMBERS: 00000018 {{[0-9a-f]+}}08
beq r4, r5, f
# FIXUP: kind: fixup_jal21
# CHECK: 0000001c: R_TRAX_JAL21 f
# NUMBERS: 0000001c {{[0-9a-f]+}}09
call f
# CHECK: 00000020: R_TRAX_JAL21 f+0x10
j f+16
# CHECK: 00000024: R_TRAX_HI16 g
# CHECK: 00000028: R_TRAX_LO16 g
la r4, g
# CHECK-NOT: R_TRAX
