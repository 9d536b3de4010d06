/* For explain_test.py: calls deeper than a profile keeps, and what comes after them. */
volatile int x = 3;

__attribute__((noinline)) int recursive(int depth) {
  return depth ? recursive(depth - 1) * x + depth : x;
}

__attribute__((noinline)) int after(int count) {
  int sum = 0;
  for (int i = 0; i < count; i++)
    sum += x;
  return sum;
}

int main(void) {
  return (recursive(1500) + after(1000)) & 0;
}
