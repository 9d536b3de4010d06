// RUN: %run_c %s %t
// Functions of the heap without memory set errno, and empty blocks differ. (Expected output by hand.)
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

__attribute__((noinline)) static void show(const char *name, void *volatile got) {
  printf("%s %d %d\n", name, got != NULL, errno);
  errno = 0;
}

int main(void) {
  void *(*volatile malloc_of)(size_t) = malloc;
  volatile size_t large = (size_t)-1 / 2 - 100, half = (size_t)-1 / 4, more = 5, odd = 24, none = 0;
  void *block = malloc_of(16), *given = NULL;
  errno = 0;
  show("malloc", malloc(large));
  show("calloc", calloc(large, 1));
  show("calloc product", calloc(half, more));
  show("realloc", realloc(block, large));
  show("realloc", realloc(NULL, large));
  show("aligned_alloc", aligned_alloc(64, half));
  show("aligned_alloc", aligned_alloc(odd, 48));
  show("aligned_alloc", aligned_alloc(none, 48));
  printf("posix_memalign %d %d\n", posix_memalign(&given, 64, half), posix_memalign(&given, odd, 1));
  free(block);
  void *volatile empty = aligned_alloc(8192, 0), *volatile other = aligned_alloc(8192, 0);
  printf("empty blocks %d\n", empty && other && empty != other);
  free(empty);
  free(other);
  return 0;
}
