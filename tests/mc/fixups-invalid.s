# Mistakes that show only when the layout is known.
# RUN: not %trax_mc -filetype=obj -o %t.o %s 2>&1 | FileCheck %s
# RUN: not test -e %t.o

# CHECK: [[#@LINE+1]]:1: error: branch target is out of range
beq r4, r5, far
# CHECK: [[#@LINE+1]]:1: error: branch target is not a multiple of 4
bne r4, r5, odd
# CHECK: [[#@LINE+1]]:1: error: branch target is not a multiple of 4
j odd
# CHECK: [[#@LINE+1]]:1: error: value does not fit a signed 16-bit immediate
addi r4, r0, %abs(far - near)
near:
.zero 131072
# The last that just fits gives no error.
# CHECK-NOT: :[[#@LINE+2]]:
far:
beq r4, r5, far - 131072
.byte 0
odd:
.zero 3
# CHECK: [[#@LINE+1]]:8: error: no relocation exists for this kind of expression
.dword undefined
