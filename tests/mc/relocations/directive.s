// .reloc takes the relocations' names; one that marks a place has no field.
// RUN: split-file %s %t
// RUN: %trax_mc -filetype=obj %t/good.s -o %t.o && llvm-readobj -r %t.o | FileCheck %s
// CHECK:      Section ({{[0-9]+}}) .rela.text {
// CHECK-NEXT:   0x0 Unknown - 0x0
// CHECK-NEXT:   0x4 Unknown f 0x8
// CHECK-NEXT: }
// RUN: llvm-readelf -r %t.o | FileCheck %s --check-prefix=TYPES
// TYPES:      {{0+}}0 {{0+}}0a Unknown
// TYPES-NEXT: {{0+}}4 {{[0-9a-f]+}}01 Unknown {{.*}} f + 8
// RUN: not %trax_mc -filetype=obj %t/bad.s -o %t.bad.o 2>&1 | FileCheck %s --check-prefix=BAD
// BAD: bad.s:1:11: error: unknown relocation name
//--- good.s
  .reloc ., R_TRAX_JUMP
  jr r4
  .reloc 4, R_TRAX_32, f + 8
  .word 0
//--- bad.s
.reloc ., R_TRAX_NOTHING
