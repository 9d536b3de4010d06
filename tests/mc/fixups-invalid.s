# Mistakes that show only when the layout is known, and expressions that no relocation can hold.
# RUN: not %trax_mc -filetype=obj -o %t.o %s 2>&1 | FileCheck %s --match-full-lines --implicit-check-not=error:
# RUN: not test -e %t.o

# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: branch target is out of range
beq r4, r5, far
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: branch target is not a multiple of 4
bne r4, r5, odd
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: branch target is not a multiple of 4
j odd
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: branch target is out of range
call farther
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: value does not fit a signed 16-bit immediate
addi r4, r0, %abs(far - near)

# brtarget
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: symbol 'b' can not be undefined in a subtraction expression
beq r4, r5, a - b
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: expected relocatable expression
beq r4, r5, -a
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: expected relocatable expression
beq r4, r5, a * 2
# jaltarget
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: symbol 'b' can not be undefined in a subtraction expression
jal r4, a - b
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: expected relocatable expression
j a + b
# uimm16
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: symbol 'b' can not be undefined in a subtraction expression
lui r4, %hi(a - b)
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: expected relocatable expression
lui r4, %hi(a * 2)
# simm16
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: expected relocatable expression
addi r4, r5, %lo(-a)
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: symbol 'b' can not be undefined in a subtraction expression
addi r4, r5, %abs(a - b)
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: expected relocatable expression
lw r4, %lo(a + b)(r5)
# symbol, for each of its two instructions
# CHECK: {{.*}}.s:[[#@LINE+2]]:1: error: symbol 'b' can not be undefined in a subtraction expression
# CHECK: {{.*}}.s:[[#@LINE+1]]:1: error: symbol 'b' can not be undefined in a subtraction expression
la r4, a - b
near:
.zero 131072
# The last that just fits gives no error.
far:
beq r4, r5, far - 131072
.byte 0
odd:
.zero 4194307
farther:

# data
# CHECK: {{.*}}.s:[[#@LINE+1]]:8: error: no relocation exists for this kind of expression
.dword undefined
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: no relocation exists for this kind of expression
.half undefined - near
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: symbol 'undefined' can not be undefined in a subtraction expression
.word near - undefined
# CHECK: {{.*}}.s:[[#@LINE+1]]:7: error: expected relocatable expression
.word undefined * 2
