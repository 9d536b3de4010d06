# Operand kind uimm5: distances of shifts.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# too small
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
srai r4, r5, -1
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
slli r4, r5, -32

# too large
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
slli r4, r5, 32
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
srli r4, r5, 0xFFFFFFFF
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
srli r4, r5, 0x100000001

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
srli r4, r5, r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
slli r4, r5, 1.0

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
slli r4, r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: unknown token in expression
slli r4, r5,

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:17: error: invalid operand for instruction
slli r4, r5, 1, 2
# CHECK: {{.*}}.s:[[#@LINE+1]]:18: error: invalid operand for instruction
slli r4, r5, 1(r6)

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
slli r4, r5, %lo(symbol)
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
slli r4, r5, %hi(symbol)

# symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
slli r4, r5, symbol
