// Options of the assembler.
// RUN: %clang -c %s -o %t.o && llvm-readelf -sS %t.o | FileCheck %s
// CHECK: .text
// CHECK: FUNC GLOBAL DEFAULT {{[0-9]+}} f

// RUN: %clang -c -Wa,--defsym,N=7 -Wa,-I%S/Inputs %s -o %t.o && llvm-objdump -s -j .text %t.o | FileCheck %s --check-prefix=DEFSYM
// DEFSYM: 0000 07008020
// RUN: %clang -c -g %s -o %t.o && llvm-dwarfdump --debug-line %t.o | FileCheck %s --check-prefix=LINE
// LINE: version: 4
// LINE: name: "assembler.s"
// LINE: 0x0000000000000000 [[#]] 0 1 0 0 0 is_stmt

// RUN: %host_clang -cc1as -triple trax -filetype asm %s -o - | FileCheck %s --check-prefix=ASM
// ASM: addi r4, r0, 42
// RUN: %host_clang -cc1as -triple trax -filetype null %s
// RUN: %host_clang -cc1as -triple trax -filetype obj %s -o - | llvm-readelf -h - | FileCheck %s --check-prefix=PIPE
// PIPE: Machine: 7472
// RUN: %clang -c %s -o /dev/null
// RUN: not %clang -c -Wa,--fatal-warnings %S/Inputs/warning.s -o %t.fatal.o 2>&1 | FileCheck %s --check-prefix=FATAL
// FATAL: warning.s:1:{{[0-9]+}}: error: careful

.ifndef N
.set N, 42
.endif
	.text
	.globl	f
	.type	f, @function
f:
	addi	r4, r0, N
	jalr	r0, 0(r1)
