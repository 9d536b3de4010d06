// RUN: %run_c %s %t
// setjmp and longjmp out of nested calls; saved registers come back.
#include <setjmp.h>
#include <stdio.h>

static jmp_buf target;

__attribute__((noinline)) static void leave(int depth, int value) {
  if (depth == 0)
    longjmp(target, value);
  leave(depth - 1, value);
  printf("not reached\n");
}

__attribute__((noinline)) static int attempt(int value, int kept) {
  volatile int before = kept * 3;
  int caught = setjmp(target);
  if (caught == 0) {
    leave(4, value);
    return -1;
  }
  return caught * 1000 + before + kept;
}

int main(void) {
  printf("%d %d %d\n", attempt(1, 5), attempt(42, 6), attempt(0, 7));
  return 0;
}
