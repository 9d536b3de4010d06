# Operand kind imm32: the constant of li.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# too small
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer of 32 bits
li r4, -0x80000001

# too large
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer of 32 bits
li r4, 0x100000000
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer of 32 bits
li r4, 0x1FFFFFFFF

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer of 32 bits
li r4, r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer of 32 bits
li r4, 1.5

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
li r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: unknown token in expression
li r4,

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:11: error: invalid operand for instruction
li r4, 1, 2

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer of 32 bits
li r4, %hi(symbol)

# symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer of 32 bits
li r4, symbol
