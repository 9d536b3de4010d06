# Operand kind srnum: numbers and names of special registers.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# too small
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, -1

# too large
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, 6
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, 65536
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, 0x100000000

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, exit
# CHECK: {{.*}}.s:[[#@LINE+1]]:6: error: operand must be a register
rdsr thread, r4

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
rdsr r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: unknown token in expression
rdsr r4,
# CHECK: {{.*}}.s:[[#@LINE+1]]:6: error: operand must be a register
rdsr thread

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:18: error: invalid operand for instruction
rdsr r4, thread, tm
# CHECK: {{.*}}.s:[[#@LINE+1]]:16: error: expected ',' or the end of the line
rdsr r4, thread+1
# CHECK: {{.*}}.s:[[#@LINE+1]]:11: error: invalid operand for instruction
rdsr r4, 1(r5)

# misspelled
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, clock
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, Thread
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, cyclel

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, %lo(thread)

# symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: special register must be thread, tm, tp, threads, cycle, cycleh or a number in the range [0, 5]
rdsr r4, symbol
