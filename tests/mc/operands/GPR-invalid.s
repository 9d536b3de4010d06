# Operand kind GPR: registers, by number or by name.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# too large
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, r32
# CHECK: {{.*}}.s:[[#@LINE+1]]:5: error: operand must be a register
add r32, r5, r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: operand must be a register
fadd r4, r100, r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:4: error: operand must be a register
sw a8, 4(r5)

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, 7
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:5: error: operand must be a register
add 4, r5, r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: operand must be a register
add r4, -r5, r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: operand must be a register
fadd r4, r5, 1.0
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, "r6"
# CHECK: {{.*}}.s:[[#@LINE+1]]:12: error: operand must be a register
frsqrt r4, 4
# CHECK: {{.*}}.s:[[#@LINE+1]]:16: error: operand must be a register
cmovnz r4, r5, 1
# CHECK: {{.*}}.s:[[#@LINE+1]]:6: error: operand must be a register
trap exit, r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:4: error: operand must be a register
jr 4
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: operand must be a register
mv r4, 5
# CHECK: {{.*}}.s:[[#@LINE+1]]:17: error: invalid operand for instruction
add r4, r5, 4(r6)

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
add r4, r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
add r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
add
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
frsqrt r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
sw r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:12: error: unknown token in expression
add r4, r5,
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: unknown token in expression
add r4,, r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: expected ',' or the end of the line
add r4 r5, r6

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:17: error: invalid operand for instruction
add r4, r5, r6, r7
# CHECK: {{.*}}.s:[[#@LINE+1]]:16: error: invalid operand for instruction
frsqrt r4, r5, r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:6: error: invalid operand for instruction
halt r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:5: error: invalid operand for instruction
ret r1

# misspelled
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, R6x
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, s12
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, r05
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, x6
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, $6

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, %lo(r6)
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, %lo(symbol)
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: expected hi, lo or abs after '%'
add r4, r5, %r6
