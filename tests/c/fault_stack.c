// RUN: %run_c %s %t --turns -O0,-O2 --fault "stack overflow" --fault "fault_stack.c:8" --fault "deep"
// More recursion than 512 bytes hold.
static volatile int limit = 1000;

__attribute__((noinline)) static int deep(int n) {
  volatile int kept[4] = {n};
  return n >= limit ? 0
                    : deep(n + 1) + kept[0];
}

int main(void) { return deep(0); }
