// The compiler's output beyond Inputs/rich.yaml: .stack_sizes, a group, a jump table, calls of several kinds.
template <typename T> __attribute__((noinline)) T twice(T x) { return x + x; }
static int (*volatile pointer)(int) = twice<int>;
__attribute__((noinline)) static int recurse(int n) { return n ? recurse(n / 2) * 3 + 1 : 0; }
int main() {
  switch (recurse(twice(5))) {
  case 0: return pointer(7);
  case 1: return recurse(4);
  case 2: return -9;
  case 3: return 17;
  case 4: return 33;
  default: return 5;
  }
}
