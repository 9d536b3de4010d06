# Operand kind trapcode: codes and names of traps.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# too small
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts, kinds, host or a number in the range [0, 7]
trap r4, -1

# too large
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts, kinds, host or a number in the range [0, 7]
trap r4, 8
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts, kinds, host or a number in the range [0, 7]
trap r4, 65536
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts, kinds, host or a number in the range [0, 7]
trap r4, 0x100000000

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts, kinds, host or a number in the range [0, 7]
trap r4, r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts, kinds, host or a number in the range [0, 7]
trap r4, thread
# CHECK: {{.*}}.s:[[#@LINE+1]]:6: error: operand must be a register
trap 4, 0

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
trap r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: unknown token in expression
trap r4,
# CHECK: {{.*}}.s:[[#@LINE+1]]:6: error: operand must be a register
trap exit

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:16: error: invalid operand for instruction
trap r4, exit, 0
# CHECK: {{.*}}.s:[[#@LINE+1]]:11: error: invalid operand for instruction
trap r4, 1(r5)

# misspelled
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts, kinds, host or a number in the range [0, 7]
trap r4, quit
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts, kinds, host or a number in the range [0, 7]
trap r4, Exit

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts, kinds, host or a number in the range [0, 7]
trap r4, %lo(exit)

# symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: trap code must be exit, putc, abort, rays, items, puts, kinds, host or a number in the range [0, 7]
trap r4, symbol
