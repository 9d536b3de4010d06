# Constants out of range and symbols out of place.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s
# RUN: not test -e %t.out

# CHECK: [[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, r6
# CHECK: [[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, 32768
# CHECK: [[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, -32769
# CHECK: [[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, 0x100000000
# CHECK: [[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, symbol
# CHECK: [[#@LINE+1]]:14: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
addi r4, r5, %hi(symbol)
# CHECK: [[#@LINE+1]]:15: error: expected hi, lo or abs after '%'
addi r4, r5, %foo(symbol)
# CHECK: [[#@LINE+1]]:18: error: expected '('
addi r4, r5, %hi symbol
# CHECK: [[#@LINE+1]]:15: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
sltiu r4, r5, 65535
# CHECK: [[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, 65536
# CHECK: [[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, -1
# CHECK: [[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, r5
# CHECK: [[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, symbol
# CHECK: [[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, %lo(symbol)
# CHECK: [[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, %abs(symbol)
# CHECK: [[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
slli r4, r5, 32
# CHECK: [[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
srai r4, r5, -1
# CHECK: [[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
srli r4, r5, r6
# CHECK: [[#@LINE+1]]:14: error: shift amount must be an integer in the range [0, 31]
slli r4, r5, symbol
# CHECK: [[#@LINE+1]]:8: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
lw r4, 32768(r5)
# CHECK: [[#@LINE+1]]:8: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
sw r4, -32769(r5)
# CHECK: [[#@LINE+1]]:8: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
lw r4, symbol
# CHECK: [[#@LINE+1]]:8: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
lw r4, symbol(r5)
# CHECK: [[#@LINE+1]]:9: error: immediate must be an integer in the range [-32768, 32767], %lo(symbol) or %abs(symbol)
lbu r4, %hi(symbol)(r5)
# CHECK: [[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, 6
# CHECK: [[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, -1
# CHECK: [[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, clock
# CHECK: [[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, r5
# CHECK: [[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts or a number in the range [0, 5]
trap r4, 6
# CHECK: [[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts or a number in the range [0, 5]
trap r4, quit
# CHECK: [[#@LINE+1]]:8: error: immediate must be an integer of 32 bits
li r4, symbol
# CHECK: [[#@LINE+1]]:8: error: immediate must be an integer of 32 bits
li r4, 0x1FFFFFFFF
# CHECK: [[#@LINE+1]]:8: error: operand must be a symbol
la r4, 5
# CHECK: [[#@LINE+1]]:8: error: operand must be a symbol
la r4, r5
