// RUN: %run_c %s %t --turns -O0,-O2,-Os --cflags "-Wno-atomic-alignment" --simflags "--config 1x32"
// Operations of every kind on one object at once: nothing is lost, whichever of them the machine does by itself.
// (Expected output by hand.)
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <trax.h>

enum { ROUNDS = 4 };

static atomic_uint arrived;
static atomic_int counted; /* incremented alone */
static atomic_int up_and_down;
static _Atomic uint8_t bytes[4];
static _Atomic uint16_t halves[2];
static _Atomic uint64_t wide;
static _Atomic float sum;
static _Atomic double wide_sum;
static struct triple { int a, b, c; } const start = {1, 2, 3};
static _Atomic struct triple shared;
static atomic_int published;
static int swaps_lost;

static void meet(unsigned round) {
  atomic_fetch_add(&arrived, 1);
  while (atomic_load(&arrived) < round * trax_threads())
    ;
}

__attribute__((noinline)) static void change(atomic_int *p, int by) {
  *p += 1; /* of an object that it does not know */
  *p += by;
}

/* All threads begin together: if one ends before the next one begins, changes that are not atomic lose nothing. */
#define TOGETHER(...)                                                                                                  \
  do {                                                                                                                 \
    meet(++meetings);                                                                                                  \
    for (int i = 0; i < ROUNDS; i++) {                                                                                 \
      __VA_ARGS__;                                                                                                     \
    }                                                                                                                  \
  } while (0)

static void next_triple(void) {
  struct triple old = atomic_load(&shared), fresh;
  if (old.a + 1 != old.b || old.b + 1 != old.c)
    __sync_fetch_and_add(&swaps_lost, 1);
  do
    fresh = (struct triple){old.a + 1, old.b + 1, old.c + 1};
  while (!atomic_compare_exchange_weak(&shared, &old, fresh));
}

int main(void) {
  const int thread = (int)trax_thread();
  unsigned meetings = 0;
  if (thread == 0)
    atomic_store(&shared, start);
  TOGETHER(counted++);
  TOGETHER(up_and_down++, up_and_down--, change(&up_and_down, 1));
  TOGETHER(bytes[thread % 4]++);
  TOGETHER(halves[thread % 2] += 3);
  TOGETHER(wide += 1ull << 31);
  TOGETHER(sum += 0.5f);
  TOGETHER(wide_sum += 0.25);
  TOGETHER(next_triple());
  /* A store between the halves of a read-modify-write would be undone by it. */
  if (thread == 7)
    atomic_store(&published, 1 << 20);
  else
    for (int i = 0; i < ROUNDS; i++)
      atomic_fetch_or(&published, 1 << thread % 20);
  meet(++meetings);
  if (thread)
    return 0;
  struct triple end = shared;
  printf("%d %d\n", counted, up_and_down);
  printf("%d %d %d %d %d %d\n", bytes[0], bytes[1], bytes[2], bytes[3], halves[0], halves[1]);
  printf("%llx %d %d\n", (unsigned long long)wide, (int)sum, (int)wide_sum);
  printf("%d %d %d %d %d\n", end.a, end.b, end.c, swaps_lost, published >= 1 << 20);
  printf("%d %d\n", atomic_is_lock_free(&counted), atomic_is_lock_free(&shared));
  return 0;
}
