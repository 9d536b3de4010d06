// clang-format off
// RUN: %run_c %s %t --levels -O2 --also -O0 --simflags "--set chip.tms=2 --set chip.tps_per_tm=8 --max-cycles 9000000"
// RUN: %trax_sim --set chip.tms=2 --set chip.tps_per_tm=8 --check-races %t-O2 | diff %S/heap_model.expected -
// RUN: %trax_sim --config 4x32 --set memory.size_mib=24 --engine functional %t-O2 | diff %S/heap_model.expected -
// clang-format on
// Random sequences of the heap's functions on all threads: blocks are aligned, do not overlap and keep their contents.
// Some are freed by another thread. In the end nothing is lost. (Expected output by hand.)
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <trax.h>

enum { SLOTS = 12, STEPS = 100, BOXES = 16 };

struct block {
  unsigned char *memory;
  unsigned size, mark;
};
static _Atomic(struct block *) box[BOXES]; /* blocks on their way to another thread */
static atomic_uint wrong, arrived, passed;
extern uintptr_t __trax_heap, __trax_heap_end;

static void fill(struct block *b, unsigned size, unsigned mark) {
  b->size = size;
  b->mark = mark;
  for (unsigned i = 0; i < size; i++)
    b->memory[i] = (unsigned char)(mark + i * 7);
}

/* Whether the first bytes are the block's. */
static void check(const struct block *b, const unsigned char *memory, unsigned size) {
  for (unsigned i = 0; i < size && i < b->size; i++)
    if (memory[i] != (unsigned char)(b->mark + i * 7)) {
      atomic_fetch_add(&wrong, 1);
      return;
    }
}

static void drop(struct block *b) {
  check(b, b->memory, b->size);
  free(b->memory);
  free(b);
}

static unsigned next(unsigned *x) {
  return (*x = *x * 1664525 + 1013904223) >> 8;
}

static void step(struct block **slot, unsigned *x) {
  struct block *b = *slot;
  const unsigned kind = next(x) % 8, size = 1 + next(x) % (next(x) % 8 ? 100 : next(x) % 8 ? 900 : 20000);
  const unsigned mark = next(x);
  unsigned alignment = 8;
  if (!b) {
    if (!(*slot = b = malloc(sizeof *b))) {
      atomic_fetch_add(&wrong, 1);
      return;
    }
    if (kind < 2) {
      b->memory = calloc(size, 1);
      for (unsigned i = 0; b->memory && i < size; i++)
        if (b->memory[i])
          atomic_fetch_add(&wrong, 1);
    } else if (kind < 4) {
      alignment = 1u << next(x) % 14;
      b->memory = aligned_alloc(alignment, size);
    } else {
      b->memory = malloc(size);
    }
  } else if (kind < 3) {
    unsigned char *memory = realloc(b->memory, size);
    if (memory) {
      check(b, memory, size);
      b->memory = memory;
    }
  } else if (kind < 6) {
    drop(b);
    *slot = NULL;
    return;
  } else { /* into a box; this thread takes the block that was there */
    *slot = atomic_exchange(&box[next(x) % BOXES], b);
    atomic_fetch_add(&passed, 1);
    return;
  }
  const uintptr_t begin = (uintptr_t)b->memory;
  if (begin < __trax_heap || begin > __trax_heap_end - size || begin & (alignment - 1) || begin & 7)
    atomic_fetch_add(&wrong, 1);
  else
    fill(b, size, mark);
}

int main(void) {
  struct block *slots[SLOTS] = {0};
  unsigned x = trax_thread() * 977 + 5;
  for (unsigned i = 0; i < STEPS; i++)
    step(&slots[next(&x) % SLOTS], &x);
  for (unsigned i = 0; i < SLOTS; i++)
    if (slots[i])
      drop(slots[i]);
  if (atomic_fetch_add(&arrived, 1) != trax_threads() - 1)
    return 0;
  for (unsigned i = 0; i < BOXES; i++)
    if (box[i])
      drop(box[i]);
  /* Each thread keeps at most some empty pages: most of the heap is one block again. */
  void *volatile most = malloc((__trax_heap_end - __trax_heap) / 4);
  printf("%u wrong, %s\n", wrong, most && passed > trax_threads() ? "nothing lost" : "lost");
  free(most);
  return 0;
}
