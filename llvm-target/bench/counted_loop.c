/* Tests the counters: a loop whose instructions were counted by hand. A repetition executes
   3 * ITERATIONS more than one with ITERATIONS = 0. */
#include "bench.h"

void kernel_setup(void) {}

struct result kernel_run(void) {
  uint32_t left = ITERATIONS + 1, sum = 0;
#if defined __trax__
  __asm__ volatile("1: addi %0, %0, -1\n addi %1, %1, 2\n bne %0, r0, 1b" : "+r"(left), "+r"(sum));
#elif defined __riscv
  __asm__ volatile(".option push\n.option norvc\n1: addi %0, %0, -1\n addi %1, %1, 2\n bne %0, zero, 1b\n.option pop"
                   : "+r"(left), "+r"(sum));
#else
  for (; left != 0; left--)
    sum += 2;
#endif
  return (struct result){sum, 0};
}
