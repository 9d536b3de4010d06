// `clang --target=trax` adds options, and the user's come after them.
// RUN: %clang -### -c %s 2>&1 | FileCheck %s
// CHECK: Target: trax
// CHECK: "-cc1" "-triple" "trax" "-emit-obj"
// CHECK-SAME: "-mrelocation-model" "static" "-mframe-pointer=none" "-ffp-contract=off"
// CHECK-SAME: "-nostdsysteminc" "-ffunction-sections" "-fdata-sections" "-fstack-size-section" "-ftls-model=local-exec"
// CHECK-SAME: "-resource-dir" "{{[^"]+}}clang/19"
// CHECK-SAME: "-internal-externc-isystem" "{{[^"]+}}lib/trax/include"
// CHECK-NOT: warning:

// RUN: %clang -### -c %s 2>&1 | FileCheck %s --check-prefix=ABSENT
// ABSENT-NOT: -fmath-errno
// ABSENT-NOT: -fexceptions
// ABSENT-NOT: -faddrsig
// ABSENT-NOT: -stack-protector
// ABSENT-NOT: "/usr/include"
// ABSENT-NOT: -pic-level
// ABSENT-NOT: -funwind-tables

// RUN: %clang -### -c -g %s 2>&1 | FileCheck %s --check-prefix=DEBUG
// DEBUG: "-debug-info-kind=constructor" "-dwarf-version=4"
// RUN: %clang -### -c -gdwarf-5 %s 2>&1 | FileCheck %s --check-prefix=DWARF5
// DWARF5: "-dwarf-version=5"

// RUN: %clang -### -c -ffp-contract=fast -fno-function-sections -fmath-errno -fno-omit-frame-pointer %s 2>&1 | FileCheck %s --check-prefix=USER
// USER: "-mframe-pointer=all" "-fmath-errno" "-ffp-contract=fast"
// USER-NOT: "-ffunction-sections"

// RUN: %clang -### -c -nostdinc %s 2>&1 | FileCheck %s --check-prefix=NOSTDINC
// NOSTDINC: "-nostdsysteminc" "-nobuiltininc"
// NOSTDINC-NOT: isystem

// RUN: %clangxx -### -c %s 2>&1 | FileCheck %s --check-prefix=CXX
// CXX: "-fno-rtti"
// CXX-NOT: "-fcxx-exceptions"

// The front end's defaults reach every spelling of the target, and a name that begins with it.
// RUN: %host_clang -target trax -### -c %s 2>&1 | FileCheck %s
// RUN: %host_clang --target=trax-none-elf -### -c %s 2>&1 | FileCheck %s --check-prefix=LONG
// RUN: %trax_bin/trax-clang -### -c %s 2>&1 | FileCheck %s
// LONG: "-cc1" "-triple" "trax-none-unknown-elf"
