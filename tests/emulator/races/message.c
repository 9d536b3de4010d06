/* For races_test.py: thread 0 tells the last thread that there is something to read. RELEASE, ACQUIRE: the orders of
   the store that says so and of the loads that wait for it; PLAIN: neither is atomic. */
#include <stdatomic.h>
#include <trax.h>

volatile unsigned data[3];
#ifdef PLAIN
static volatile unsigned flag;
#define SAY(VALUE) flag = (VALUE)
#define HEAR() flag
#else
static _Atomic unsigned flag;
#define SAY(VALUE) atomic_store_explicit(&flag, VALUE, RELEASE)
#define HEAR() atomic_load_explicit(&flag, ACQUIRE)
#endif

__attribute__((noinline)) static void tell(unsigned round) {
  data[1] = round; /* stores */
  SAY(round);      /* says so */
}

__attribute__((noinline)) static unsigned listen(unsigned round) {
  while (HEAR() != round) /* waits */
    ;
  return data[1]; /* loads */
}

int main(void) {
  const unsigned last = trax_threads() - 1;
  unsigned wrong = 0;
  if (trax_thread() == 0)
    for (unsigned i = 0; i < 20; i++)
      trax_load_nt((const unsigned *)&data[0]); /* the other one has loaded the line by then */
  if (trax_thread() == last)
    wrong += data[2];
  if (trax_thread() == 0)
    tell(1);
  else if (trax_thread() == last)
    wrong += listen(1) != 1;
  return (int)wrong;
}
