# .stack says where the file's code expects the stack; e_flags have it. Without it the code works with both.
# RUN: rm -rf %t && split-file %s %t && cd %t
# RUN: %trax_mc local.s | FileCheck local.s
# RUN: %trax_mc -filetype=obj -o local.o local.s && llvm-readelf -h local.o | FileCheck local.s --check-prefix=FLAGS
# RUN: %trax_objdump -f local.o | FileCheck local.s --check-prefix=DUMP
# RUN: %trax_mc global.s | %trax_mc -filetype=obj -o global.o && llvm-readelf -h global.o | FileCheck global.s --check-prefix=FLAGS
# RUN: %clang -mstack=local -c global.s -o global.o && llvm-readelf -h global.o | FileCheck global.s --check-prefix=FLAGS
# RUN: %clang -mstack=global -c either.s -o either.o && llvm-readelf -h either.o | FileCheck either.s --check-prefix=FLAGS
# RUN: not %trax_mc wrong.s 2>&1 | FileCheck wrong.s --implicit-check-not=error:

#--- local.s
  .stack local
  .stack local
  nop
# CHECK: .stack local
# CHECK-NOT: .stack
# FLAGS: Flags: 0x1
# DUMP: flags 0x00000001: stack in local memory
#--- global.s
  nop
  .stack global # anywhere in the file
# FLAGS: Flags: 0x2
#--- either.s
  nop
# FLAGS: Flags: 0x0
#--- wrong.s
# CHECK: wrong.s:[[#@LINE+1]]:10: error: expected local or global
  .stack elsewhere
# CHECK: wrong.s:[[#@LINE+1]]:9: error: expected local or global
  .stack
# CHECK: wrong.s:[[#@LINE+1]]:16: error: expected newline
  .stack local local
  .stack local
# CHECK: wrong.s:[[#@LINE+1]]:10: error: the stack is already in local memory
  .stack global
