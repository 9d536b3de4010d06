# Data of every size, symbols' addresses among them.
# RUN: %trax_mc -filetype=obj -o %t.o %s
# RUN: llvm-readelf -x .data %t.o | FileCheck %s --check-prefix=DATA
# RUN: %trax_objdump -t -d %t.o | FileCheck %s --check-prefix=SYMBOLS

.data
.byte 1, 0xFF
.half 0x1234
.word 0x89ABCDEF
.dword 0x0123456789ABCDEF
.long -1
.asciz "abc"
.p2align 4
.word end - start
start:
.zero 8
end:
# DATA: 01ff3412 efcdab89 efcdab89 67452301
# DATA-NEXT: ffffffff 61626300 00000000 00000000
# DATA-NEXT: 08000000 00000000 00000000

.text
# Code is padded with nop.
addi r4, r0, 1
.p2align 4
.globl after
after:
halt
# SYMBOLS: 00000010 g .text 0 after
# SYMBOLS: 0: 20800001 li r4, 1
# SYMBOLS-NEXT: 4: 20000000 nop
# SYMBOLS-NEXT: 8: 20000000 nop
# SYMBOLS-NEXT: c: 20000000 nop
# SYMBOLS: 00000010 <after>:
# SYMBOLS-NEXT: 10: a8000000 halt
