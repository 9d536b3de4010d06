# Operand kind simm16: signed immediates, of arithmetic and of addresses.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# too small
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, -32769
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, -0x80000000
# CHECK: {{.*}}.s:[[#@LINE+1]]:15: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
sltiu r4, r5, 0xFFFF7FFF
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, -0x100000000
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
lw r4, -32769(r5)
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
jalr r1, -32769(r4)

# too large
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, 32768
# CHECK: {{.*}}.s:[[#@LINE+1]]:15: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
sltiu r4, r5, 65535
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, 0x100000000
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
ori r4, r5, 0x80000000
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
sb r4, 32768(r5)
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
jalr r1, 32768(r4)
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, %abs(0x8000)

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, r6
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, 1.5
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, "1"
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
lw r4, r5

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
addi r4, r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:13: error: unknown token in expression
addi r4, r5,

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:17: error: invalid operand for instruction
addi r4, r5, 1, 2
# CHECK: {{.*}}.s:[[#@LINE+1]]:18: error: invalid operand for instruction
addi r4, r5, 4(r6)

# misspelled
# CHECK: {{.*}}.s:[[#@LINE+1]]:16: error: expected ',' or the end of the line
addi r4, r5, 12z
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: unknown token in expression
addi r4, r5, #4

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, %hi(symbol)
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
lbu r4, %hi(symbol)(r5)
# CHECK: {{.*}}.s:[[#@LINE+1]]:15: error: expected hi, lo or abs after '%'
addi r4, r5, %foo(symbol)
# CHECK: {{.*}}.s:[[#@LINE+1]]:15: error: expected hi, lo or abs after '%'
addi r4, r5, %Lo(symbol)
# CHECK: {{.*}}.s:[[#@LINE+1]]:18: error: expected '('
addi r4, r5, %lo symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:24: error: expected ')'
addi r4, r5, %lo(symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:18: error: unknown token in expression
addi r4, r5, %lo()

# symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, symbol+4
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, one-other
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
lw r4, symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
lw r4, symbol(r5)
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
jalr r1, symbol(r4)
