# Operand kind symbol: the symbol of la.
# RUN: not %trax_mc %s -o %t.out 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.out

# wrong kind
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: operand must be a symbol
la r4, 5
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: operand must be a symbol
la r4, r5
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: operand must be a symbol
la r4, 1.5

# missing
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: too few operands for instruction
la r4
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: unknown token in expression
la r4,

# extra
# CHECK: {{.*}}.s:[[#@LINE+1]]:16: error: invalid operand for instruction
la r4, symbol, 2
# CHECK: {{.*}}.s:[[#@LINE+1]]:14: error: invalid operand for instruction
la r4, symbol(r5)

# modifier
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: operand must be a symbol
la r4, %lo(symbol)
