/* A program for explain_test.py: calls of every kind, and something for each cause. */
#include <setjmp.h>
#include <trax.h>

struct trax_buffer results;
unsigned next[2]; /* two queues, of the even and of the odd items; a TM begins with its own */
volatile float divisor = 3;
volatile unsigned table[256];
_Alignas(64) volatile unsigned even[64], odd[64];

__attribute__((noinline)) unsigned leaf(unsigned x) {
  return x * 2654435761u ^ x >> 7;
}

static inline __attribute__((always_inline)) unsigned inlined(unsigned x) {
  return table[x & 255] + 1;
}

__attribute__((noinline)) unsigned last(unsigned x) {
  return leaf(x) + inlined(x);
}

__attribute__((noinline)) unsigned tail(unsigned x) {
  __attribute__((musttail)) return last(x + 1);
}

__attribute__((noinline)) unsigned recursive(unsigned depth) {
  return depth ? leaf(recursive(depth - 1)) + depth : 0;
}

/* One load, of two objects by turns. */
__attribute__((noinline)) unsigned alternate(unsigned x) {
  return (x & 1 ? odd : even)[x >> 1 & 63] + 1;
}

__attribute__((noinline)) unsigned divide(unsigned x) {
  return (unsigned)((float)x / divisor);
}

__attribute__((noinline)) unsigned thrower(jmp_buf place, unsigned x) {
  if (leaf(x) != x)
    longjmp(place, 1);
  return x;
}

__attribute__((noinline)) unsigned catcher(unsigned x) {
  jmp_buf place;
  if (!setjmp(place))
    return thrower(place, x);
  return leaf(x);
}

static unsigned (*volatile pointer)(unsigned) = divide;

int main(void) {
  unsigned *out = results.data, slot, queue = trax_tm();
  for (unsigned tried = 0; tried < 2; tried++, queue ^= 1)
    while ((slot = 2 * trax_atomic_inc(&next[queue]) + queue) < results.size / 4) {
      unsigned value = tail(slot) + recursive(slot & 3) + catcher(slot) + pointer(slot);
      value += alternate(value);
      table[slot & 255] = value;
      trax_store_nt(&out[slot], value);
      trax_count_items(1);
    }
  return 0;
}
