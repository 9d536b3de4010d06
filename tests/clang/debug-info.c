// -g gives DWARF 4 that LLVM's tools and so the emulator can read: lines, types, variables, frames.
// RUN: %clang -g -O0 -c %s -o %t.o && llvm-dwarfdump --verify %t.o
// RUN: llvm-dwarfdump --debug-info %t.o | FileCheck %s
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

// RUN: llvm-dwarfdump --debug-line %t.o | FileCheck %s --check-prefix=LINES
// LINES: 0x{{[0-9a-f]+}} [[@LINE+11]] {{.*}} is_stmt

// RUN: llvm-dwarfdump --debug-frame %t.o | FileCheck %s --check-prefix=FRAME
// FRAME: CIE
// FRAME: Return address column: 1
// FRAME: FDE

// RUN: %clang -O2 -c %s -o %t.none.o && llvm-readelf -S %t.none.o | FileCheck %s --check-prefix=NONE --implicit-check-not=.debug
// NONE: .text
typedef struct { float x, y, z; } vec3;
float length2(vec3 v) { return v.x * v.x + v.y * v.y + v.z * v.z; }
