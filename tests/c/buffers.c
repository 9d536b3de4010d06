// RUN: %clang -O2 -g %s -o %t
// RUN: printf 'abcdefgh' > %t.in
// RUN: %trax_sim %t --bind input=%t.in --alloc output=16 --dump output=%t.out | FileCheck %s
// RUN: FileCheck --check-prefix=DUMP --input-file=%t.out %s
// Buffers that the host fills and reads.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <trax.h>

struct trax_buffer input, output;

int main(void) {
  const char *from = input.data;
  char *to = output.data;
  int zeros = 1;
  for (unsigned i = 0; i < output.size; i++)
    zeros &= to[i] == 0;
  // CHECK: 8 16 1 1
  printf("%u %u %d %d\n", input.size, output.size, zeros, ((uintptr_t)from & 63) == 0 && ((uintptr_t)to & 63) == 0);
  for (unsigned i = 0; i < input.size; i++)
    to[input.size - 1 - i] = from[i];
  for (unsigned i = input.size; i < output.size; i++)
    to[i] = '.';
  // The heap lies behind the buffers.
  // CHECK-NEXT: 1
  printf("%d\n", (char *)malloc(4) >= to + output.size);
  // DUMP: hgfedcba........
  return 0;
}
