# Wrong operands: each mistake is named at its place, and nothing is written.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s
# RUN: not test -e %t.out

# CHECK: [[#@LINE+1]]:1: error: unknown instruction 'frobnicate'
frobnicate r4
# CHECK: [[#@LINE+1]]:1: error: unknown instruction 'fad', did you mean: add, and, fadd?
fad r4, r5, r6
# CHECK: [[#@LINE+1]]:1: error: too few operands for instruction
add r4, r5
# CHECK: [[#@LINE+1]]:17: error: invalid operand for instruction
add r4, r5, r6, r7
# CHECK: [[#@LINE+1]]:13: error: operand must be a register
add r4, r5, 7
# CHECK: [[#@LINE+1]]:13: error: operand must be a register
add r4, r5, r32
# CHECK: [[#@LINE+1]]:8: error: expected ',' or the end of the line
add r4 r5, r6
# CHECK: [[#@LINE+1]]:8: error: unknown token in expression
add r4,, r5
# CHECK: [[#@LINE+1]]:14: error: operand must be a register
fadd r4, r5, 1.0
# CHECK: [[#@LINE+1]]:12: error: operand must be a register
frsqrt r4, 4
# CHECK: [[#@LINE+1]]:16: error: operand must be a register
cmovnz r4, r5, 1
# CHECK: [[#@LINE+1]]:10: error: expected a register
lw r4, 4(5)
# CHECK: [[#@LINE+1]]:12: error: expected ')'
lw r4, 4(r5
# CHECK: [[#@LINE+1]]:8: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
lw r4, r5
# CHECK: [[#@LINE+1]]:13: error: expected ',' or the end of the line
lw r4, 4(r5)(r6)
# CHECK: [[#@LINE+1]]:4: error: operand must be a register
sw 5, 4(r5)
# CHECK: [[#@LINE+1]]:6: error: invalid operand for instruction
halt r4
# CHECK: [[#@LINE+1]]:5: error: invalid operand for instruction
ret r1
# CHECK: [[#@LINE+1]]:4: error: operand must be a register
jr 4
# CHECK: [[#@LINE+1]]:6: error: operand must be a register
trap 4, 0
# CHECK: [[#@LINE+1]]:8: error: operand must be a register
mv r4, 5
# CHECK: [[#@LINE+1]]:1: error: unexpected token at start of statement
%hi(x)
