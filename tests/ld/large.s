// Zeroed data takes no room in the file, unless other sections of its name have contents. Then an executable that would be
// unreasonably large is refused.
// RUN: rm -rf %t && mkdir %t && cd %t && %trax_mc -filetype=obj %s -o zeros.o
// RUN: printf '.globl _start\n_start: halt\n' > start.s && %trax_mc -filetype=obj start.s -o start.o
// RUN: printf '.section same, "aw"\n.byte 1\n' > bytes.s && %trax_mc -filetype=obj bytes.s -o bytes.o
// RUN: %trax_ld start.o zeros.o -o a && llvm-readelf -l a | FileCheck %s
// CHECK: LOAD {{0x[0-9a-f]+}} 0x00001040 0x00001040 0x00000 0x10000001 RW 0x40
// RUN: not %trax_ld start.o zeros.o bytes.o -o b 2>&1 | FileCheck %s --check-prefix=LARGE && not ls b
// LARGE: trax-ld: error: the executable would have {{2684[0-9]+}} bytes, more than the linker's limit, 268435456
  .section same, "aw", @nobits
  .space 0x10000001
