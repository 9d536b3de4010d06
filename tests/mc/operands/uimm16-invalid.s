# Operand kind uimm16: upper halves.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# too small
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, -1
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, -0x80000000

# too large
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, 65536
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, 0xFFFF0000
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, 0x100000000

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, 1.5

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
lui r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: unknown token in expression
lui r4,

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:12: error: invalid operand for instruction
lui r4, 1, 2
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: invalid operand for instruction
lui r4, 4(r5)

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, %lo(symbol)
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, %abs(symbol)
# CHECK: {{.*}}.s:[[#@LINE+1]]:10: error: expected hi, lo or abs after '%'
lui r4, %high(symbol)

# symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, symbol
# CHECK: {{.*}}.s:[[#@LINE+1]]:9: error: immediate must be an integer in the range [0, 65535] or %hi(symbol)
lui r4, one-other
