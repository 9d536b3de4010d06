# Operand kind brtarget: targets of conditional branches.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# too small
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
blt r4, r5, -131076
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
beqz r4, -131076

# too large
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
bne r4, r5, 131072
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
bne r4, r5, 0x100000000

# misaligned
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
beq r4, r5, 2
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
beq r4, r5, -1
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
beqz r4, 7

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
bge r4, r5, r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
bge r4, r5, 4.0

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
beq r4, r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
beqz r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:12: error: unknown token in expression
beq r4, r5,

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:20: error: invalid operand for instruction
beq r4, r5, label, 1
# CHECK: {{.*}}.s:[[#@LINE+1]]:17: error: invalid operand for instruction
beq r4, r5, 4(r6)

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
bltu r4, r5, %lo(label)
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: branch target must be a symbol or a multiple of 4 in the range [-131072, 131068]
bltu r4, r5, %hi(label)

# symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: directional label undefined
beq r4, r5, 1b
