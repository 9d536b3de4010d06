// Thread-local objects have absolute addresses in local memory.
// RUN: %clang -O1 -S -emit-llvm %s -o - | FileCheck %s
// CHECK: @seed = {{.*}}thread_local(localexec) {{.*}}global i32 0, align 4
// RUN: %clang -O1 -S %s -o - | FileCheck %s --check-prefix=ASM
// ASM: %abs(seed)
// RUN: %clang -O1 -c %s -o %t.o && llvm-readelf -rS %t.o | FileCheck %s --check-prefix=OBJ
// OBJ: .tbss
_Thread_local unsigned seed;
unsigned next(void) { return seed = seed * 1664525u + 1013904223u; }
