// RUN: %clang -O2 -DPRINT=iprintf %s -o %t.small && %trax_sim %t.small | FileCheck %s
// RUN: %clang -O2 -DPRINT=printf %s -o %t.large && %trax_sim %t.large | FileCheck %s
// RUN: llvm-nm %t.small | FileCheck --check-prefix=SMALL %s
// RUN: llvm-nm %t.large | FileCheck --check-prefix=LARGE %s
// iprintf brings no formatting of doubles, and neither brings binary64 arithmetic.
#include <stdio.h>

int main(void) {
  // CHECK: 42 text ff
  PRINT("%d %s %x\n", 42, "text", 255);
  return 0;
}
// SMALL-NOT: trax_format_double
// SMALL-NOT: __{{(add|sub|mul|div)}}df3
// LARGE-NOT: __{{(add|sub|mul|div)}}df3
// LARGE: trax_format_double
