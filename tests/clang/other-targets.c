// Every other target is clang's own.
// RUN: %host_clang -S -emit-llvm %s -o - | FileCheck %s --check-prefix=HOST
// HOST: target triple = "{{[^"]*}}linux
// RUN: %host_clang --target=riscv32-unknown-elf -march=rv32i -c %s -o %t.o && llvm-readelf -h %t.o | FileCheck %s --check-prefix=RISCV
// RISCV: Machine: RISC-V
// RUN: %host_clang --target=x86_64-linux-gnu -O1 -S %s -o - | FileCheck %s --check-prefix=X86
// X86: addss
// RUN: %host_clang --target=wasm32 -c %s -o %t.wasm
// RUN: %host_clang --target=aarch64-none-elf -c %S/Inputs/aarch64.s -o %t.o && llvm-readelf -h %t.o | FileCheck %s --check-prefix=AARCH64
// AARCH64: Machine: AArch64
// RUN: not %host_clang --target=riscv32-unknown-elf -DBUILTIN -fsyntax-only %s 2>&1 | FileCheck %s --check-prefix=BUILTIN
// BUILTIN: error: use of unknown builtin '__builtin_trax_rsqrt'

// Structs by value follow the other target's rules, not ours.
// RUN: %host_clang --target=lanai -S -emit-llvm %s -o - | FileCheck %s --check-prefix=LANAI
// LANAI: define{{.*}} @lengths(i32 inreg %0, i32 inreg %1, i32 inreg %2)
// RUN: %host_clang --target=msp430 -S -emit-llvm %s -o - | FileCheck %s --check-prefix=MSP430
// MSP430: define{{.*}} @lengths(ptr {{.*}}byval
struct vec3 { float x, y, z; };
float lengths(struct vec3 v) { return v.x + v.y; }
#ifdef BUILTIN
float builtin(float x) { return __builtin_trax_rsqrt(x); }
#endif
