/* Shared by the two halves of the heap. The heap is an array of pages, and a table beside it describes each of them. A
   page has blocks of one size and belongs to one thread (malloc.c), or it is part of a run of pages (runs.c). */
#ifndef TRAX_RUNTIME_HEAP_H
#define TRAX_RUNTIME_HEAP_H

#include "../internal/machine.h"

#include <stddef.h>
#include <string.h>

enum { PAGE = 4096, WORDS = 8 /* of bits, one for each free block */ };

/* A line of the data cache on the TP. */
struct page {
  _Alignas(64) uint16_t owner; /* of a page of small blocks: the thread's number + 1; 0 for other pages */
  uint16_t size;               /* of its blocks */
  uint8_t class;               /* of this size */
  uint8_t shift;               /* a word of `free` is for 2^shift blocks */
  uint8_t first;               /* the word in which malloc looks for a block; WORDS if the page is in no list */
  unsigned reciprocal;         /* 2^32 / size, rounded up */
  char *memory;
  struct page *next, *before;
  unsigned free_pages; /* length of a free run, in its first and its last page; under the lock of runs.c */
  unsigned used_pages; /* length of a block of whole pages, in its first page */
  uint32_t free[WORDS];
};

/* A thread's part that other threads use. */
struct heap {
  struct ticket_lock lock; /* protects `returned`: blocks freed by others, linked through their first words */
  void *returned;
  struct page *spare; /* empty pages, for this thread alone */
  unsigned spares;
};

/* Set once, before a thread has any memory of the heap. */
struct layout {
  char *start;
  struct page *table;
  unsigned pages;
  struct heap *heaps;
};

/* Two classes of sizes for each power of two: the upper two digits of a number are the upper bits of a float. Exact for
   numbers below 2^24. Counted from those of 1. */
INLINE unsigned digits_of(unsigned n) {
  const float value = (float)(int)n;
  unsigned bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return (bits - 0x3F800000u) >> 22;
}

/* Divides the heap on the first call. The layout has no pages if there is no memory. */
const struct layout *__trax_heap_prepare(void);
/* Blocks of whole pages, aligned to a page or more. */
void *__trax_run_allocate(size_t size, size_t alignment);
void __trax_run_free(struct page *page, const void *memory);
/* Resizes a block in place: to fewer bytes, or to more if there is room behind it. Returns its bytes. */
size_t __trax_run_resize(struct page *page, const void *memory, size_t size);
/* Allocates a page for small blocks, or returns NULL; releases pages. */
struct page *__trax_page_allocate(void);
void __trax_pages_free(struct page *list);

__attribute__((noreturn)) void __trax_heap_complain(void);

#endif
