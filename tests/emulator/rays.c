/* A program for rays_test.py: items with rays of several kinds, which take loops of different lengths. */
#include <trax.h>
#include <trax/abi.h>

#define SAME(X, ID, NAME, NUMBER, MEANING) _Static_assert(TRAX_RAY_##ID == NUMBER, "a kind's number");
TRAX_RAY_KINDS(SAME, )
_Static_assert(TRAX_RAYS(1, 1) == 1 << TRAX_KIND_BITS, "a kind's bits");

struct trax_buffer results;
unsigned next;
unsigned table[1024];

static unsigned follow(unsigned x, unsigned steps) {
  float sum = 0;
  for (; steps > 0; steps--) {
    x = x * 1664525u + 1013904223u;
    sum += (float)(int)table[x >> 22];
    if (x >> 31)
      sum = sum * 0.5f + 1;
  }
  return x + (unsigned)(int)sum;
}

int main(void) {
  unsigned *out = results.data, slot;
  while ((slot = trax_atomic_inc(&next)) < results.size / 4) {
    unsigned x = slot * 2654435761u;
    trax_count_kinds(TRAX_RAYS(TRAX_RAY_PRIMARY, 1));
    x = follow(x, 8 + slot % 3);
    for (unsigned i = slot % 4; i > 0; i--) {
      trax_count_kinds(TRAX_RAYS(TRAX_RAY_SHADOW, 1));
      x = follow(x, 4 + (x & 3));
      trax_count_kinds(TRAX_RAYS(TRAX_RAY_DIFFUSE, 2));
      x = follow(x, 4 + (x & 15));
    }
    if (slot % 5 == 0)
      trax_count_rays(3);
    x = follow(x, 3);
    trax_count_kinds(TRAX_RAYS(TRAX_RAY_OCCLUSION, 15) + TRAX_RAYS(TRAX_RAY_OTHER, 9)); /* of no one kind */
    trax_count_kinds(0);
    table[slot & 1023] = x;
    trax_store_nt(&out[slot], x);
    trax_count_items(1);
  }
  return 0;
}
