# Errors of syntax, and words that are no name of their operand's kind. Inputs/operands.py has the wrong operands of each
# kind. Nothing is written.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: unknown instruction 'frobnicate'
frobnicate r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: unknown instruction 'fad', did you mean: add, and, fadd?
fad r4, r5, r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:3: error: unknown token in expression
r4, r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: unexpected token at start of statement
%hi(x)
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: unexpected token at start of statement
(r4)
# CHECK: {{.*}}.s:[[#@LINE+1]]:11: error: expected ',' or the end of the line
mv r4, r5 r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: unknown token in expression
add r4,, r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: operand must be a register
add r4, r5, $6
# CHECK: {{.*}}.s:[[#@LINE+1]]:17: error: invalid operand for instruction
add r4, r5, 4(r6)
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: unknown directive
.frobnicate

# Addresses.
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
lw r4, symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:4: error: operand must be a register
lw 4(r5), r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: expected ',' or the end of the line
lw r4, r5(4)
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: expected ',' or the end of the line
lw r4, 4[r5]
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: unknown token in expression
lw r4, ()
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: expected a register
lw r4, 4()
# CHECK: {{.*}}.s:[[#@LINE+1]]:12: error: expected ')'
lw r4, 4(r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: expected ',' or the end of the line
lw r4, 4(r5)(r6)

# Modifiers.
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: expected hi, lo or abs after '%'
add r4, r5, %r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:15: error: expected hi, lo or abs after '%'
addi r4, r5, %Lo(symbol)
# CHECK: {{.*}}.s:[[#@LINE+1]]:18: error: expected '('
addi r4, r5, %lo symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:24: error: expected ')'
addi r4, r5, %lo(symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:18: error: unknown token in expression
addi r4, r5, %lo()
# CHECK: {{.*}}.s:[[#@LINE+1]]:16: error: expected ',' or the end of the line
addi r4, r5, 12z

# Names of special registers, traps and fences; each kind has its own.
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, {{.*}}
rdsr r4, exit
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, {{.*}}
rdsr r4, Thread
# CHECK: {{.*}}.s:[[#@LINE+1]]:16: error: expected ',' or the end of the line
rdsr r4, thread+1
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: trap code must be exit, {{.*}}
trap r4, thread
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw {{.*}}
fence wr
