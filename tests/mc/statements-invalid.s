# Statements that are no instruction; mistakes in operands are in operands/. Nothing is written.
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
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: unknown directive
.frobnicate
