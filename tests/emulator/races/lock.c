/* For races_test.py: threads count under a lock of their own making. RELEASE, ACQUIRE: the orders of its atomics. */
#include <stdatomic.h>
#include <trax.h>

static _Atomic unsigned taken, serving;
static volatile unsigned count;

static unsigned lock(void) {
  const unsigned ticket = atomic_fetch_add_explicit(&taken, 1, memory_order_relaxed);
  while (atomic_load_explicit(&serving, ACQUIRE) != ticket)
    ;
  return ticket;
}

static void unlock(unsigned ticket) {
  atomic_store_explicit(&serving, ticket + 1, RELEASE);
}

int main(void) {
  unsigned last = 0;
  for (unsigned i = 0; i < 4; i++) {
    const unsigned ticket = lock();
    last = ++count; /* loads */
    unlock(ticket);
  }
  return last > 4 * trax_threads();
}
