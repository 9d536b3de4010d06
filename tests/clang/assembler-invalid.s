// An error names its place, gives status 1, and leaves an older output as it was, with the driver and without.
// RUN: rm -rf %t && mkdir %t
// RUN: echo old > %t/x.o && not %clang -c %s -o %t/x.o 2>&1 | FileCheck %s
// RUN: FileCheck %s --check-prefix=OLD < %t/x.o
// RUN: ls %t | count 1
// RUN: echo old > %t/x.o && not %host_clang -cc1as -triple trax -filetype obj %s -o %t/x.o 2>&1 | FileCheck %s
// RUN: FileCheck %s --check-prefix=OLD < %t/x.o
// OLD: {{^}}old{{$}}
// RUN: ls %t | count 1

// CHECK: assembler-invalid.s:[[@LINE+1]]:{{[0-9]+}}: error:
	frobnicate r1, r2
// CHECK: assembler-invalid.s:[[@LINE+1]]:{{[0-9]+}}: error:
	add r1, r2, r32
// CHECK: assembler-invalid.s:[[@LINE+1]]:{{[0-9]+}}: error: immediate must be an integer in the range [-32768, 32767]
	addi r1, r2, 32768
// CHECK: assembler-invalid.s:[[@LINE+1]]:{{[0-9]+}}: error: Could not find include file
	.include "no-such-file.inc"
