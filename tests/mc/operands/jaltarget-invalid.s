# Operand kind jaltarget: targets of jumps and calls.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# too small
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
jal r1, -4194308
# CHECK: {{.*}}.s:[[#@LINE+1]]:3: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
j -4194308

# too large
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
jal r1, 4194304
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
jal r1, 0x100000000

# misaligned
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
jal r1, 2
# CHECK: {{.*}}.s:[[#@LINE+1]]:3: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
j 6
# CHECK: {{.*}}.s:[[#@LINE+1]]:6: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
call -3

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:6: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
call r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
jal r4, r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:3: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
j 4.0

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
jal r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
j
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: unknown token in expression
jal r4,

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:16: error: invalid operand for instruction
jal r4, label, 1
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: invalid operand for instruction
jal r4, 4(r5)
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: invalid operand for instruction
j label, label

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
jal r4, %hi(label)
# CHECK: {{.*}}.s:[[#@LINE+1]]:3: error: jump target must be a symbol or a multiple of 4 in the range [-4194304, 4194300]
j %lo(label)

# symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:3: error: directional label undefined
j 1b
