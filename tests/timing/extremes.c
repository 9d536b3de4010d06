/* What extreme machines are tried with (extremes.py): a bit of everything, all threads on one address, all on one
   atomic counter, and stores that stream. Ends with the bytes of `result` a function of nothing but the machine. */
#include <trax.h>

struct trax_buffer result; /* [threads] words, and the counter */

#define TABLE 256
static float table[TABLE];
static unsigned counter;

static unsigned bits(float x) {
  unsigned word;
  __builtin_memcpy(&word, &x, sizeof word);
  return word;
}

__attribute__((noinline)) static unsigned everything(unsigned thread, unsigned *own) {
  volatile unsigned stack[16];
  float sum = 1.5f;
  unsigned seed = thread * 2654435761u + 1;
  for (unsigned i = 0; i < ROUNDS; i++) {
    seed = seed * 1664525u + 1013904223u;
    stack[seed >> 28] = seed;
    const float x = table[seed >> 24] + (float)(seed >> 16 & 255);
    sum = sum * 0.75f + 1.0f / (x + 1.0f) + trax_rsqrt(x + 2.0f);
    sum = sum < 1000.0f ? sum : 0.5f;
    own[i & 3] = stack[seed >> 28] ^ bits(sum);
    if ((seed >> 20 & 7) == 0)
      seed ^= trax_atomic_inc(&counter);
  }
  return bits(sum) ^ seed;
}

int main(void) {
  const unsigned thread = trax_thread();
  unsigned *const words = result.data;
  unsigned value = 0;
#if defined(EVERYTHING)
  table[thread % TABLE] = (float)(thread % TABLE);
  value = everything(thread, words + 4 * thread);
#elif defined(ONE_ADDRESS)
  volatile float *const address = table;
  for (unsigned i = 0; i < ROUNDS; i++)
    value += bits(*address);
#elif defined(ONE_ATOMIC)
  for (unsigned i = 0; i < ROUNDS; i++)
    value = value * 31 + trax_atomic_inc(&counter);
#elif defined(STREAM)
  volatile unsigned *const own = words + 4 * thread;
  for (unsigned i = 0; i < ROUNDS; i++)
    own[i & 3] = value += own[i + 1 & 3] + i;
#endif
  words[4 * thread] = value;
  return 0;
}
