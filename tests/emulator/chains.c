/* Faults at the end of a chain of calls (endings_test.py): WHERE is 8 for a load, 0 for an abort, 4 for a jump to
   nowhere, 1 for a recursion that never ends, 2 for a wait that never ends. */
#include <stdlib.h>
#include <trax.h>

__attribute__((noinline)) static int bottom(volatile int *p) {
  return *p;
}

static inline __attribute__((always_inline)) int middle(int *p) {
  return bottom(p) + 1;
}

volatile int depth;
__attribute__((noinline)) int top(int *p, int n) {
  if (n) {
    depth = top(p, n - 1);
    return depth + 1;
  }
  if (!p)
    abort();
  return middle(p) + 2;
}

int (*volatile nowhere)(void) = (int (*)(void))0x20000;
__attribute__((noinline)) int jump(void) {
  return nowhere() + 1;
}

__attribute__((noinline)) int recurse(int n) {
  volatile int kept = n;
  if (depth < 0)
    return 0;
  return recurse(n + 1) + kept;
}

volatile int open;
__attribute__((noinline)) void wait_at_gate(void) {
  while (!open)
    ;
}
__attribute__((noinline)) int one_of_three(void) {
  while (!open)
    depth++;
  return depth;
}

int main(void) {
  int *volatile p = (int *)WHERE;
  if (WHERE == 4)
    return jump() + 1;
  if (WHERE == 1)
    return recurse(0) + 1;
  if (WHERE == 2 && trax_thread() % 3 == 0 && trax_thread() < 20)
    return one_of_three() + 1;
  if (WHERE == 2 && trax_thread() != 25)
    wait_at_gate();
  return WHERE == 2 ? 0 : top(p, 3) + 1;
}
