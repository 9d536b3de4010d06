/* The heap: free blocks in a list ordered by address, first fit, neighbours joined when freed. Beyond the last block
   is untouched memory, from which the heap grows. One lock serves all threads. */
#include "../internal/machine.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* The emulator stores the heap's bounds here before the run (docs/abi.md, "Buffers"). */
uintptr_t __trax_heap, __trax_heap_end;

struct block {
  size_t size;        /* with this header; a multiple of 8 */
  struct block *next; /* in the free list; IN_USE in a block that is not in it */
};

#define HEADER sizeof(struct block)
#define LEAST_BLOCK (2 * HEADER)
#define IN_USE ((struct block *)(uintptr_t)0x74726178)

static struct block *free_list;
static uintptr_t top; /* first untouched address; 0 before the first call */
static struct ticket_lock heap_lock;

static inline struct block *header_of(void *memory) {
  return (struct block *)memory - 1;
}
static inline uintptr_t end_of(struct block *b) {
  return (uintptr_t)b + b->size;
}

/* The block size for a request, or 0 if there is no such size. */
static size_t block_size(size_t size) {
  if (size > (size_t)-1 / 2)
    return 0;
  size = (size + HEADER + 7) & ~(size_t)7;
  return size < LEAST_BLOCK ? LEAST_BLOCK : size;
}

/* Makes the part of a block beyond size a block of its own, if it is large enough; returns it or NULL. */
static struct block *split(struct block *b, size_t size) {
  if (b->size - size < LEAST_BLOCK)
    return NULL;
  struct block *rest = (struct block *)((uintptr_t)b + size);
  rest->size = b->size - size;
  b->size = size;
  return rest;
}

static struct block *take(size_t size) {
  for (struct block **link = &free_list; *link; link = &(*link)->next) {
    struct block *b = *link;
    if (b->size < size)
      continue;
    struct block *rest = split(b, size);
    if (rest) {
      rest->next = b->next;
      *link = rest;
    } else {
      *link = b->next;
    }
    return b;
  }
  if (top == 0)
    top = (__trax_heap + 7) & ~(uintptr_t)7;
  if (top > __trax_heap_end || __trax_heap_end - top < size)
    return NULL;
  struct block *b = (struct block *)top;
  b->size = size;
  top += size;
  return b;
}

static void give_back(struct block *b) {
  struct block **link = &free_list, **link_before = NULL;
  while (*link && *link < b) {
    link_before = link;
    link = &(*link)->next;
  }
  b->next = *link;
  *link = b;
  if (b->next && end_of(b) == (uintptr_t)b->next) {
    b->size += b->next->size;
    b->next = b->next->next;
  }
  if (link_before && end_of(*link_before) == (uintptr_t)b) {
    link = link_before;
    (*link)->size += b->size;
    (*link)->next = b->next;
  }
  if (end_of(*link) == top) { /* the last one: untouched memory begins earlier */
    top = (uintptr_t)*link;
    *link = NULL;
  }
}

/* The block of memory that malloc gave; anything else ends the program, since the heap would be ruined. */
static struct block *checked_block(void *memory) {
  struct block *b = header_of(memory);
  if ((uintptr_t)memory & 7 || (uintptr_t)b < __trax_heap || (uintptr_t)b >= top || b->next != IN_USE)
    machine_abort("free or realloc: not the address of an allocated block");
  return b;
}

static void *out_of_memory(void) {
  errno = ENOMEM;
  return NULL;
}

void *malloc(size_t size) {
  size_t needed = block_size(size);
  struct block *b = NULL;
  if (needed) {
    lock(&heap_lock);
    b = take(needed);
    if (b)
      b->next = IN_USE;
    unlock(&heap_lock);
  }
  return b ? b + 1 : out_of_memory();
}

void free(void *memory) {
  if (!memory)
    return;
  lock(&heap_lock);
  give_back(checked_block(memory));
  unlock(&heap_lock);
}

void *calloc(size_t count, size_t size) {
  size_t bytes;
  if (__builtin_mul_overflow(count, size, &bytes))
    return out_of_memory();
  void *memory = malloc(bytes);
  return memory ? memset(memory, 0, bytes) : NULL;
}

void *realloc(void *memory, size_t size) {
  if (!memory)
    return malloc(size);
  size_t needed = block_size(size);
  if (!needed)
    return out_of_memory();
  lock(&heap_lock);
  struct block *b = checked_block(memory);
  size_t old = b->size;
  if (needed <= old) {
    struct block *rest = split(b, needed);
    if (rest)
      give_back(rest);
  } else if (end_of(b) == top && __trax_heap_end - (uintptr_t)b >= needed) { /* the last block grows in place */
    b->size = needed;
    top = end_of(b);
  }
  int fits = b->size >= needed;
  unlock(&heap_lock);
  if (fits)
    return memory;
  void *larger = malloc(size);
  if (!larger)
    return NULL;
  memcpy(larger, memory, old - HEADER);
  free(memory);
  return larger;
}

void *aligned_alloc(size_t alignment, size_t size) {
  if (alignment & (alignment - 1)) {
    errno = EINVAL;
    return NULL;
  }
  if (size > (size_t)-1 / 4 || alignment > (size_t)-1 / 4)
    return out_of_memory();
  if (alignment <= 8)
    return malloc(size);
  size_t needed = block_size(size);
  void *memory = malloc(needed + alignment + LEAST_BLOCK);
  if (!memory)
    return NULL;
  /* The front goes back to the heap, so it must be nothing or a block. */
  uintptr_t address = ((uintptr_t)memory + alignment - 1) & ~(uintptr_t)(alignment - 1);
  while (address != (uintptr_t)memory && address - (uintptr_t)memory < LEAST_BLOCK)
    address += alignment;
  lock(&heap_lock);
  struct block *b = header_of(memory);
  if (address != (uintptr_t)memory) {
    struct block *aligned = header_of((void *)address);
    aligned->size = end_of(b) - (uintptr_t)aligned;
    aligned->next = IN_USE;
    b->size = (uintptr_t)aligned - (uintptr_t)b;
    give_back(b);
    b = aligned;
  }
  struct block *rest = split(b, needed);
  if (rest)
    give_back(rest);
  unlock(&heap_lock);
  return (void *)address;
}
