# Operand kind fencekind: numbers and names of fences.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# too small
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw or a number in the range [1, 3]
fence 0
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw or a number in the range [1, 3]
fence -1

# too large
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw or a number in the range [1, 3]
fence 4
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw or a number in the range [1, 3]
fence 65537
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw or a number in the range [1, 3]
fence 0x100000001

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw or a number in the range [1, 3]
fence r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw or a number in the range [1, 3]
fence exit

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
fence

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: invalid operand for instruction
fence r, w
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: invalid operand for instruction
fence 1(r5)

# misspelled
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw or a number in the range [1, 3]
fence wr
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw or a number in the range [1, 3]
fence R

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw or a number in the range [1, 3]
fence %lo(r)

# symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: fence must be r, w, rw or a number in the range [1, 3]
fence symbol
