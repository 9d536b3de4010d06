// The whole way from C to the TP's output: compile, link against the library, run.
// RUN: %clang -O2 %s -o %t && %trax_sim %t | FileCheck %s
// RUN: %clang -O0 -g %s -lm -o %t && %trax_sim %t | FileCheck %s
// RUN: %clang -O2 -c %s -o %t.o && %clang %t.o -Wl,-Map=%t.map -o %t && %trax_sim %t | FileCheck %s
// RUN: FileCheck %s --check-prefix=MAP < %t.map
// MAP: main

#include <stdio.h>
int main(void) {
  // CHECK: hello from the TP
  puts("hello from the TP");
  return 0;
}
