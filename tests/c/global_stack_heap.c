// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-mstack=global -mstack-size=1M" \
// RUN:   --simflags "--set chip.tps_per_tm=2 --set memory.size_mib=4"
// RUN: %clang %s -mstack=global -mstack-size=2M -o %t.large
// RUN: not %trax_sim --set chip.tps_per_tm=2 --set memory.size_mib=4 %t.large 2>&1 | FileCheck %s --check-prefix=LARGE
// LARGE: the threads' stacks take 4198400 bytes, 2097152 each, but only {{[0-9]+}} are free after the program: raise
// RUN: %clang %s -mstack=global -o %t.stripped && llvm-strip %t.stripped
// RUN: not %trax_sim %t.stripped 2>&1 | FileCheck %s --check-prefix=STRIPPED
// STRIPPED: is for stacks in global memory, but has no symbol __trax_stack_size: was the symbol table removed?
// The heap ends below the stacks: a program that takes all of it still has its stack. (Expected output by hand.)
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <trax.h>

__attribute__((noinline)) static unsigned deep(unsigned n) {
  volatile unsigned char a[1000];
  a[n % 1000] = (unsigned char)n;
  return n ? deep(n - 1) + (a[n % 1000] == (unsigned char)n) : 0;
}

int main(void) {
  if (trax_thread())
    return deep(1000) == 1000 ? 0 : 1;
  unsigned blocks = 0;
  for (void *volatile p; (p = malloc(4000)) != NULL; blocks++)
    memset(p, 0xa5, 4000);
  printf("%d %u\n", blocks > 400 && blocks < 530, deep(1000));
  return 0;
}
