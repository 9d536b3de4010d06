// RUN: %run_c %s %t --turns -O0,-O2 --cflags -finstrument-functions
// The hooks of -finstrument-functions are the program's own. (Expected output by hand.)
#include <stdio.h>

#define HOOK __attribute__((no_instrument_function))
static volatile int depth, deepest, calls;

HOOK void __cyg_profile_func_enter(void *function, void *caller);
HOOK void __cyg_profile_func_exit(void *function, void *caller);
HOOK void __cyg_profile_func_enter(void *function, void *caller) {
  calls += function != caller;
  depth++;
  if (depth > deepest)
    deepest = depth;
}
HOOK void __cyg_profile_func_exit(void *function, void *caller) {
  (void)function;
  (void)caller;
  depth--;
}

__attribute__((noinline)) static int factorial(int n) {
  return n < 2 ? 1 : n * factorial(n - 1);
}

int main(void) {
  const int result = factorial(5);
  printf("%d calls %d deepest %d depth %d\n", result, calls, deepest, depth);
  return 0;
}
