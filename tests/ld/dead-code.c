// clang-format off
/* A program as the compiler makes it, with dead code of more than 4 kB. Its debug information must stay consistent and must not
   claim the text for what was dropped.

   RUN: %clang -g -O1 %s -o %t -Wl,--print-gc-sections > %t.out
   RUN: FileCheck %s --check-prefix=REMOVED < %t.out
   REMOVED: removing unused section {{.*}}:(.text.dead)

   RUN: llvm-dwarfdump --verify %t
   RUN: llvm-nm %t | %python -c "import sys; print(*['0x' + line.split()[0] for line in sys.stdin if line.endswith(' main\n')])" > %t.main
   RUN: llvm-symbolizer -e %t < %t.main | FileCheck %s --check-prefix=MAIN
   MAIN: main
   MAIN-NEXT: dead-code.c:[[# @LINE + 11]]:

   RUN: %trax_sim %t | FileCheck %s --check-prefix=OUTPUT
   OUTPUT: {{^}}42{{$}}
*/
#include <stdio.h>

volatile int counter;

#define EIGHT(x) x; x; x; x; x; x; x; x

int main(void) {
  counter = 42;
  printf("%d\n", counter);
  return 0;
}

void dead(void) { EIGHT(EIGHT(EIGHT(counter++))); }
