#include <trax.h>
unsigned counter;
volatile int shared[64];
_Thread_local int mine;

__attribute__((noinline)) int work(int i) {
  mine += i;
  shared[trax_thread()] = mine;
  return shared[trax_thread()] * 2;
}

int main(void) {
  int sum = 0;
  for (int i = 1; i <= 3; i++) {
    sum += work(i);
    __builtin_trax_ainc(&counter);
  }
  return sum == 20 ? 0 : 1;
}
