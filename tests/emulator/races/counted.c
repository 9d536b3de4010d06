/* For races_test.py: the last thread to count itself reads what the others wrote, past the cache, as the increment's
   value says that it may. PLAIN: through the cache. */
#include <trax.h>

enum { THREADS = 4, WORDS = 6 };

static unsigned parts[THREADS][WORDS], arrived;
unsigned result;

int main(void) {
  const unsigned own = trax_thread();
  for (unsigned i = 0; i < WORDS; i++)
    parts[own][i] = own + i;
  __atomic_thread_fence(__ATOMIC_RELEASE);
  if (trax_atomic_inc(&arrived) != THREADS - 1)
    return 0;
  unsigned sum = 0;
  for (unsigned thread = 0; thread < THREADS; thread++) {
    unsigned copy[WORDS];
    for (unsigned i = 0; i < WORDS; i++)
#ifdef PLAIN
      copy[i] = parts[thread][i];
#else
      copy[i] = trax_load_nt(&parts[thread][i]);
#endif
    for (unsigned i = 0; i < WORDS; i++)
      sum = sum * 3 + copy[i];
  }
  trax_store_nt(&result, sum);
  return 0;
}
