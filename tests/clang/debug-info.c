// -g gives DWARF 4 that LLVM's tools, and so the emulator's users, can read: lines, types, variables, frames. (In an object file
// they cannot: they do not know the relocations.)
// RUN: %clang -g -O0 -nostdlib -Wl,-e,length2 %s -o %t
// RUN: llvm-dwarfdump --verify %t
// RUN: llvm-dwarfdump --debug-info %t | FileCheck %s
// CHECK: version = 0x0004, {{.*}} addr_size = 0x04
// CHECK: DW_TAG_compile_unit
// CHECK: DW_AT_name ("{{.*}}debug-info.c")
// CHECK: DW_TAG_subprogram
// CHECK: DW_AT_name ("length2")
// CHECK: DW_TAG_formal_parameter
// CHECK: DW_AT_name ("v")
// CHECK: DW_TAG_structure_type
// CHECK: DW_AT_byte_size (0x0c)
// CHECK: DW_AT_name ("x")

// RUN: llvm-dwarfdump --debug-line %t | FileCheck %s --check-prefix=LINES
// LINES: 0x{{[0-9a-f]+}} [[@LINE+14]] {{.*}} is_stmt
// RUN: llvm-symbolizer --obj=%t 0x1000 | FileCheck %s --check-prefix=SYMBOL
// SYMBOL: length2
// SYMBOL: debug-info.c:[[@LINE+11]]

// The frame of an optimized leaf: nothing saved, the stack pointer where it was.
// RUN: %clang -g -O2 -nostdlib -Wl,-e,length2 %s -o %t.O2
// RUN: llvm-readelf -S %t.O2 | FileCheck %s --check-prefix=SECTIONS
// SECTIONS: .debug_frame
// RUN: llvm-dwarfdump --verify %t.O2

// RUN: %clang -O2 -c %s -o %t.none.o && llvm-readelf -S %t.none.o | FileCheck %s --check-prefix=NONE --implicit-check-not=.debug
// NONE: .text
typedef struct { float x, y, z; } vec3;
float length2(vec3 v) { return v.x * v.x + v.y * v.y + v.z * v.z; }
