// RUN: %run_c %s %t --turns -O0,-O2 --fault "stack overflow" --fault fault_stack_array.c:9 --fault "sum+"
// An array on the stack, larger than the rest of the stack.
static volatile int size = 130;

__attribute__((noinline)) static int sum(int n) {
  int total = 0;
  volatile int v[n];
  for (int i = 0; i < n; i++)
    v[i] = i;
  for (int i = 0; i < n; i++)
    total += v[i];
  return total;
}

int main(void) {
  int small = sum(10);
  return small == 45 ? sum(size) : 0;
}
