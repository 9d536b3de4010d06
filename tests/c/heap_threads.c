// RUN: %run_c %s %t --turns -O0,-O2 --simflags "--config 1x32 --max-cycles 3000000"
// The heap shared by all threads: no block is given to two, all come back. (Expected output by hand.)
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <trax.h>

extern uintptr_t __trax_heap, __trax_heap_end;
static unsigned torn, unaligned, finished;

__attribute__((noinline)) static void check(const unsigned char *block, size_t size, unsigned char mark) {
  for (size_t i = 0; i < size; i++)
    if (block[i] != mark) {
      trax_atomic_inc(&torn);
      return;
    }
}

int main(void) {
  unsigned x = trax_thread();
  unsigned char *blocks[2] = {NULL, NULL};
  size_t sizes[2] = {0, 0};
  for (int i = 0; i < 12; i++) {
    x = x * 1664525 + 1013904223;
    unsigned which = x >> 24 & 1;
    check(blocks[which], sizes[which], (unsigned char)(trax_thread() * 4 + which));
    if (x >> 25 & 1) {
      free(blocks[which]);
      blocks[which] = NULL;
      sizes[which] = 0;
      continue;
    }
    size_t size = 1 + (x >> 8) % 40;
    blocks[which] = realloc(blocks[which], size);
    check(blocks[which], size < sizes[which] ? size : sizes[which], (unsigned char)(trax_thread() * 4 + which));
    memset(blocks[which], (int)(trax_thread() * 4 + which), size);
    sizes[which] = size;
    if ((uintptr_t)blocks[which] & 7)
      trax_atomic_inc(&unaligned);
  }
  for (int i = 0; i < 2; i++) {
    check(blocks[i], sizes[i], (unsigned char)(trax_thread() * 4 + (unsigned)i));
    free(blocks[i]);
  }
  if (__atomic_fetch_add(&finished, 1, __ATOMIC_ACQ_REL) != trax_threads() - 1)
    return 0;
  void *volatile most = malloc((__trax_heap_end - __trax_heap) / 10 * 9); /* threads keep a few pages */
  printf("%u %u %d\n", torn, unaligned, most != NULL);
  free(most);
  return 0;
}
