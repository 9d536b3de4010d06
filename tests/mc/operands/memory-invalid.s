# Operand kind memory: addresses of loads, stores and jalr, imm(ra): the register and the parentheses (simm16 is the immediate).
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: expected a register
lw r4, 4(5)
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: expected a register
lw r4, 4(symbol)
# CHECK: {{.*}}.s:[[#@LINE+1]]:12: error: expected a register
ainc r4, 4(r32)
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: expected ',' or the end of the line
lw r4, r5(4)
# CHECK: {{.*}}.s:[[#@LINE+1]]:4: error: operand must be a register
lw 4(r5), r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:4: error: operand must be a register
sw 4(r5), r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: expected ',' or the end of the line
lw r4, 4[r5]

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
lw r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
lw r4, 4
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: unknown token in expression
lw r4, ()
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: expected a register
lw r4, 4()
# CHECK: {{.*}}.s:[[#@LINE+1]]:12: error: expected ')'
lw r4, 4(r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: expected ',' or the end of the line
lw r4, 4 r5)
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: unknown token in expression
sw r4,

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:15: error: invalid operand for instruction
lw r4, 4(r5), 1
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: expected ',' or the end of the line
lw r4, 4(r5)(r6)
# CHECK: {{.*}}.s:[[#@LINE+1]]:15: error: invalid operand for instruction
sw r4, 4(r5), r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:12: error: expected ')'
lw r4, 4(r5, r6)
# CHECK: {{.*}}.s:[[#@LINE+1]]:17: error: invalid operand for instruction
jalr r1, 4(r5), 4

# misspelled
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: expected a register
lw r4, 4(spp)

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: expected a register
lw r4, 4(%lo(r5))
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: expected hi, lo or abs after '%'
lw r4, %foo(symbol)(r5)
