// An error names its place, gives status 1, and leaves an older output as it was.
// RUN: echo untouched > %t.o
// RUN: not %clang -c %s -o %t.o 2>&1 | FileCheck %s
// RUN: FileCheck %s --check-prefix=OLD < %t.o
// OLD: untouched
// RUN: rm -f %t.new.o && not %clang -c %s -o %t.new.o 2> /dev/null && not ls %t.new.o

// CHECK: assembler-invalid.s:[[@LINE+1]]:{{[0-9]+}}: error:
	frobnicate r1, r2
// CHECK: assembler-invalid.s:[[@LINE+1]]:{{[0-9]+}}: error:
	add r1, r2, r32
// CHECK: assembler-invalid.s:[[@LINE+1]]:{{[0-9]+}}: error: immediate must be an integer in the range [-32768, 32767]
	addi r1, r2, 32768
// CHECK: assembler-invalid.s:[[@LINE+1]]:{{[0-9]+}}: error: Could not find include file
	.include "no-such-file.inc"
