// The link job: our linker, the start file, the inputs in the order given, the library.
// RUN: touch %t.o %t.a
// RUN: %clang -### %t.o -lfirst -Wl,-u,symbol %t.a -Xlinker --verbose -lsecond -o %t.elf 2>&1 | FileCheck %s
// CHECK: "{{[^"]*}}bin/trax-ld" "-o" "{{[^"]+}}.elf" "--gc-sections" "{{[^"]+}}lib/trax/crt0.o" "-L{{[^"]+}}lib/trax"
// CHECK-SAME: "{{[^"]+}}.tmp.o" "-lfirst" "-u" "symbol" "{{[^"]+}}.tmp.a" "--verbose" "-lsecond" "-lc"

// RUN: %clang -### %s -L/first -L /second -e begin -u needed -s -Ttext=0x2000 -z now 2>&1 | FileCheck %s --check-prefix=OPTIONS
// OPTIONS: "-cc1"
// OPTIONS: trax-ld" "-o" "a.out"
// OPTIONS-SAME: "-L/first" "-L/second" "-u" "needed" "-s" "-Ttext=0x2000"
// OPTIONS-SAME: "{{[^"]+}}.o" "-e" "begin" "-z" "now" "-lc"

// The functions of <math.h> are in libc.a.
// RUN: %clang -### %t.o -lm 2>&1 | FileCheck %s --check-prefix=MATH
// RUN: %clangxx -### %t.o -lstdc++ -lc++ -lm 2>&1 | FileCheck %s --check-prefix=MATH --implicit-check-not=c++\"
// MATH: trax-ld"
// MATH-NOT: "-lm"
// MATH-SAME: "-lc"

// RUN: %clang -### %t.o -nostdlib 2>&1 | FileCheck %s --check-prefix=NOSTDLIB --implicit-check-not=crt0 --implicit-check-not=-lc
// RUN: %clang -### %t.o -nostartfiles 2>&1 | FileCheck %s --check-prefix=NOSTART --implicit-check-not=crt0
// RUN: %clang -### %t.o -nodefaultlibs 2>&1 | FileCheck %s --check-prefix=NODEFAULT --implicit-check-not=-lc
// NOSTDLIB: trax-ld"
// NOSTART: trax-ld"
// NOSTART-SAME: "-lc"
// NODEFAULT: trax-ld"
// NODEFAULT-SAME: crt0.o"

// RUN: %clang -### %t.o --ld-path=/other/linker 2>&1 | FileCheck %s --check-prefix=LDPATH
// LDPATH: "/other/linker" "-o" "a.out"

// A start file in a -B directory goes before ours.
// RUN: rm -rf %t.dir && mkdir %t.dir && touch %t.dir/crt0.o
// RUN: %clang -### %t.o -B %t.dir 2>&1 | FileCheck %s --check-prefix=PREFIX
// PREFIX: "{{[^"]+}}.dir/crt0.o"

// Compiled, assembled and preprocessed inputs together, each one where it stood.
// RUN: %clang -### %t.o %s %S/Inputs/function.s %S/Inputs/function.S -lx 2>&1 | FileCheck %s --check-prefix=MIXED
// MIXED: "-cc1" {{.*}} "-o" "[[C:[^"]+]]" "-x" "c"
// MIXED: "-cc1as" {{.*}} "-o" "[[S:[^"]+]]" "{{[^"]+}}function.s"
// MIXED: "-cc1" {{.*}} "-E" {{.*}} "-x" "assembler-with-cpp"
// MIXED: "-cc1as" {{.*}} "-o" "[[CPP:[^"]+]]"
// MIXED: trax-ld" {{.*}} "{{[^"]+}}.tmp.o" "[[C]]" "[[S]]" "[[CPP]]" "-lx" "-lc"

int main(void) { return 0; }
