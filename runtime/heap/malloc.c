/* malloc and the like. Blocks of up to a page come from pages of the thread's own, each for one class of sizes, whose
   table entry has a bit for every free block: no other thread reads or writes these bits, so there is no lock and no
   fence. A block that another thread frees goes to a list of its owner, who takes it back when a class has no more.
   Larger blocks are runs of pages (runs.c). */
#include "heap.h"

#include <errno.h>
#include <malloc.h>
#include <stdlib.h>

enum {
  LINEAR = 4,   /* classes in steps of 16 bytes; two for each power of two follow */
  CLASSES = 16, /* up to 4096 bytes */
  LEAST = 16,   /* size of the smallest blocks */
  SPARES = 32   /* empty pages that a thread keeps at most */
};

/* Lists of the pages with free blocks, in which only the first page may have none, and the thread's copy of the layout.
   They are in local memory, since at 128 TPs the data cache has 8 lines for each. */
static _Thread_local struct page *pages[CLASSES];
static _Thread_local struct layout layout;

void __trax_heap_complain(void) {
  machine_abort("free or realloc: not the address of an allocated block");
}

/* Whether there is a heap. */
static int learn(void) {
  if (!layout.pages)
    layout = *__trax_heap_prepare();
  return layout.pages != 0;
}

static void *out_of_memory(void) {
  errno = ENOMEM;
  return NULL;
}

/* The class of a size from 1 to PAGE. */
static inline unsigned class_of(size_t size) {
  return size <= LEAST * LINEAR ? (unsigned)(size - 1) / LEAST : digits_of((unsigned)size - 1) - (12 - LINEAR);
}

/* Blocks whose size is a power of two are aligned to it. A word has few of them, so that a new page can begin with any
   word. */
static const struct {
  uint16_t size;
  uint8_t shift;
} classes[CLASSES] = {{LEAST, 5}, {32, 5},  {48, 5},  {64, 5},   {96, 5},   {128, 2},  {192, 2},  {256, 1},
                      {384, 1},   {512, 0}, {816, 0}, {1024, 0}, {2048, 0}, {2048, 0}, {4096, 0}, {4096, 0}};

/* A block of a word that has one. The number of the lowest bit is the exponent of its value as a float. */
static inline void *take(struct page *page, unsigned word) {
  const uint32_t free = page->free[word];
  const float lowest = (float)(free & -free);
  unsigned bits;
  __builtin_memcpy(&bits, &lowest, sizeof bits);
  page->free[word] = free & (free - 1);
  return page->memory + ((word << page->shift) + (bits >> 23) - 127) * page->size;
}

/* The bits of a word in an empty page. */
static uint32_t all_free(const struct page *page, unsigned word) {
  const unsigned blocks = page->reciprocal / (0x80000000u / (PAGE / 2)); /* PAGE / page->size */
  const unsigned before = word << page->shift, each = 1u << page->shift, here = blocks - before;
  return blocks <= before ? 0 : here < each ? (1u << here) - 1 : (uint32_t)(((uint64_t)1 << each) - 1);
}

static void link_page(struct page *page) {
  page->before = NULL;
  page->next = pages[page->class];
  if (page->next)
    page->next->before = page;
  pages[page->class] = page;
}

static void unlink_page(struct page *page) {
  *(page->before ? &page->before->next : &pages[page->class]) = page->next;
  if (page->next)
    page->next->before = page->before;
}

static int is_empty(const struct page *page) {
  for (unsigned word = 0; word < WORDS; word++)
    if (page->free[word] != all_free(page, word))
      return 0;
  return 1;
}

static void release_spares(struct heap *heap) {
  __trax_pages_free(heap->spare);
  heap->spare = NULL;
  heap->spares = 0;
}

static void make_spare(struct heap *heap, struct page *page) {
  unlink_page(page);
  page->next = heap->spare;
  heap->spare = page;
  heap->spares++;
}

/* Releases all empty pages of the thread. Returns whether there were any. */
static int release(struct heap *heap) {
  for (unsigned class = 0; class < CLASSES; class ++)
    if (pages[class] && is_empty(pages[class]))
      make_spare(heap, pages[class]);
  const int some = heap->spare != NULL;
  release_spares(heap);
  return some;
}

/* Called after a word was 0, or became 0...01...1. A page that was full enters its list. A page that is empty leaves
   it, unless it is the only one there. */
__attribute__((noinline)) static void freed(struct page *page, unsigned word) {
  if (page->first == WORDS) {
    page->first = (uint8_t)word;
    link_page(page);
  }
  if ((!page->before && !page->next) || !is_empty(page))
    return;
  struct heap *heap = &layout.heaps[machine_thread()];
  if (heap->spares == SPARES)
    release_spares(heap);
  make_spare(heap, page);
}

/* The page of an address. NULL: it is not in the heap, or the thread has no copy of the layout yet. */
static inline struct page *page_of(const void *memory) {
  const uintptr_t index = ((uintptr_t)memory - (uintptr_t)layout.start) / PAGE;
  return index < layout.pages ? layout.table + index : NULL;
}

static struct page *checked_page_of(const void *memory) {
  struct page *page = learn() ? page_of(memory) : NULL;
  if (!page)
    __trax_heap_complain();
  return page;
}

/* The number of a small block in its page. */
static inline unsigned block_of(const struct page *page, const void *memory) {
  const unsigned within = (uintptr_t)memory & (PAGE - 1);
  const unsigned block = (unsigned)((uint64_t)within * page->reciprocal >> 32);
  if (block * page->size != within || within + page->size > PAGE)
    __trax_heap_complain();
  return block;
}

static inline void give(struct page *page, void *memory) {
  const unsigned block = block_of(page, memory), word = block >> page->shift;
  const uint32_t before = page->free[word], bit = (uint32_t)1 << (block - (word << page->shift)), now = before | bit;
  if (before & bit)
    __trax_heap_complain();
  page->free[word] = now;
  if ((before == 0 || (now & (now + 1)) == 0) && (page->first == WORDS || page->before || page->next))
    freed(page, word);
}

/* Takes back the blocks that other threads have freed. Returns whether there were any. */
static int take_back(struct heap *heap) {
  if (!__atomic_load_n(&heap->returned, __ATOMIC_RELAXED))
    return 0;
  lock(&heap->lock);
  void *block = heap->returned;
  heap->returned = NULL;
  unlock(&heap->lock);
  while (block) {
    void *next;
    __builtin_memcpy(&next, block, sizeof next);
    give(page_of(block), block);
    block = next;
  }
  return 1;
}

/* A page for a class. Its first block is not always at the page's beginning, or the first blocks of all threads would
   be in the same lines of a direct-mapped cache. */
static int add_page(struct heap *heap, unsigned class) {
  struct page *page = heap->spare;
  if (page) {
    heap->spare = page->next;
    heap->spares--;
  } else if (!(page = __trax_page_allocate())) {
    return 0;
  }
  const unsigned index = (unsigned)(page - layout.table);
  page->owner = (uint16_t)(machine_thread() + 1);
  page->size = classes[class].size;
  page->shift = classes[class].shift;
  page->class = (uint8_t)class;
  page->reciprocal = 0xFFFFFFFFu / page->size + 1;
  page->memory = layout.start + (size_t)index * PAGE;
  for (unsigned word = 0; word < WORDS; word++)
    page->free[word] = all_free(page, word);
  page->first = page->free[index / 4 % WORDS] ? index / 4 % WORDS : 0;
  link_page(page);
  return 1;
}

/* A block of a page, or NULL. */
static inline void *take_any(struct page *page) {
  unsigned word = page->first;
  if (!page->free[word]) {
    for (word = 0; !page->free[word];)
      if (++word == WORDS)
        return NULL;
    page->first = (uint8_t)word;
  }
  return take(page, word);
}

/* A block of the class from the thread's pages, or NULL. */
static void *take_small(unsigned class) {
  for (struct page *page; (page = pages[class]); unlink_page(page), page->first = WORDS) {
    void *memory = take_any(page);
    if (memory)
      return memory;
  }
  return NULL;
}

/* The slow path of malloc. If there is no memory for a page, a larger class may have a free block. */
__attribute__((noinline)) static void *allocate(size_t size) {
  void *memory = NULL;
  if (learn()) {
    struct heap *heap = &layout.heaps[machine_thread()];
    if (size > PAGE) {
      while (!(memory = __trax_run_allocate(size, PAGE)) && (take_back(heap) || release(heap)))
        ;
    } else {
      unsigned class = class_of(size ? size : 1);
      while (!(memory = take_small(class)) && (take_back(heap) || add_page(heap, class)))
        ;
      while (!memory && ++class < CLASSES)
        memory = take_small(class);
    }
  }
  return memory ? memory : out_of_memory();
}

void *malloc(size_t size) {
  if (size - 1 < PAGE) {
    struct page *page = pages[class_of(size)];
    void *memory = page ? take_any(page) : NULL;
    if (memory)
      return memory;
  }
  return allocate(size);
}

/* A block of whole pages, or one that another thread owns. */
__attribute__((noinline)) static void free_other(void *memory) {
  struct page *page = checked_page_of(memory);
  if (page->owner == machine_thread() + 1) {
    give(page, memory);
  } else if (page->owner) {
    block_of(page, memory);
    struct heap *heap = &layout.heaps[page->owner - 1];
    enter(&heap->lock);
    void *next = __atomic_load_n(&heap->returned, __ATOMIC_RELAXED);
    __builtin_memcpy(memory, &next, sizeof next);
    heap->returned = memory;
    unlock(&heap->lock);
  } else {
    __trax_run_free(page, memory);
  }
}

/* Like malloc, a leaf: a frame would be in the data cache with -mstack=global. */
void free(void *memory) {
  if (!memory)
    return;
  struct page *page = page_of(memory);
  if (page && page->owner == machine_thread() + 1)
    give(page, memory);
  else
    free_other(memory);
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
  struct page *page = checked_page_of(memory);
  if (page->owner)
    block_of(page, memory);
  const size_t old = page->owner ? page->size : __trax_run_resize(page, memory, size);
  if (size <= old && (old == LEAST || size > (page->owner ? old / 2 : PAGE)))
    return memory;
  void *other = malloc(size);
  if (!other)
    return size <= old ? memory : NULL;
  memcpy(other, memory, size < old ? size : old);
  free(memory);
  return other;
}

size_t malloc_usable_size(void *memory) {
  struct page *page = memory ? checked_page_of(memory) : NULL;
  return !page ? 0 : page->owner ? page->size : __trax_run_resize(page, memory, 0);
}

void *aligned_alloc(size_t alignment, size_t size) {
  if (!alignment || alignment & (alignment - 1)) {
    errno = EINVAL;
    return NULL;
  }
  size_t power = alignment; /* blocks of such a size are aligned to it */
  while (power < size && power < PAGE)
    power *= 2;
  if (alignment <= LEAST || (alignment <= PAGE && size > PAGE))
    return malloc(size);
  if (power <= PAGE)
    return malloc(power);
  void *memory = learn() ? __trax_run_allocate(size ? size : 1, alignment) : NULL;
  return memory ? memory : out_of_memory();
}
