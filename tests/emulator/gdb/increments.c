/* Increments without a result; one with a result waits until those before it are done. */
unsigned first, second, last;
volatile unsigned sink;

#define INCREMENT(WORD) __asm__ volatile("ainc r0, 0(%0)" ::"r"(&WORD) : "memory")

int main(void) {
  INCREMENT(first);
  INCREMENT(second);
  sink = __builtin_trax_ainc(&last);
  INCREMENT(first);
  sink = __builtin_trax_ainc(&last);
  return 0;
}
