/* Runs of pages. From the beginning of the heap up there are runs, in use or free, neighbours joined; free ones are in
   lists by length. From the end down there are the pages of small blocks, which threads draw with the atomic increment,
   without a lock. The memory in between is untouched. */
#include "heap.h"

enum {
  LISTS = 42,   /* two for each power of two up to 2^20 pages */
  LOOKED_AT = 8 /* runs of a list whose runs may be too short */
};

/* The emulator stores the heap's bounds here before the run (docs/abi.md, "Buffers"). */
uintptr_t __trax_heap, __trax_heap_end;

static struct layout layout;

static struct ticket_lock runs_lock; /* protects `lists`, `top` and free_pages in the table */
static struct page *lists[LISTS];
static unsigned top;   /* the first page above the runs */
static unsigned drawn; /* pages from the end down */

static char *memory_of(const struct page *page) {
  return layout.start + (size_t)(page - layout.table) * PAGE;
}

static void remove_run(struct page *first) {
  const unsigned pages = first->free_pages;
  first->free_pages = first[pages - 1].free_pages = 0;
  *(first->before ? &first->before->next : &lists[digits_of(pages)]) = first->next;
  if (first->next)
    first->next->before = first->before;
}

/* Pages become a free run, joined with free neighbours. */
static void insert_run(struct page *first, unsigned pages) {
  if (pages == 0)
    return;
  if (first + pages < layout.table + layout.pages && first[pages].free_pages) {
    const unsigned more = first[pages].free_pages;
    remove_run(first + pages);
    pages += more;
  }
  if (first > layout.table && first[-1].free_pages) {
    const unsigned more = first[-1].free_pages;
    first -= more;
    remove_run(first);
    pages += more;
  }
  struct page **list = &lists[digits_of(pages)];
  first->free_pages = first[pages - 1].free_pages = pages;
  first->before = NULL;
  first->next = *list;
  if (first->next)
    first->next->before = first;
  *list = first;
}

/* Finds a free run of at least `pages` pages. Runs of the first list may be shorter, those of higher lists are not. */
static struct page *find_run(unsigned pages) {
  unsigned list = digits_of(pages), looked_at = 0;
  for (struct page *run = lists[list]; run && looked_at < LOOKED_AT; run = run->next, looked_at++)
    if (run->free_pages >= pages)
      return run;
  while (++list < LISTS)
    if (lists[list])
      return lists[list];
  return NULL;
}

/* Takes untouched memory, so that a free run of `pages` pages ends there. A thread that draws a page at the same time
   sees the new top, or its page is seen here. */
static int grow(unsigned pages) {
  const unsigned last = top ? layout.table[top - 1].free_pages : 0, more = last < pages ? pages - last : 0;
  if (more > layout.pages - top)
    return 0;
  top += more;
  __atomic_thread_fence(__ATOMIC_SEQ_CST);
  if (__atomic_load_n(&drawn, __ATOMIC_RELAXED) > layout.pages - top) {
    top -= more;
    return 0;
  }
  insert_run(layout.table + top - more, more);
  return 1;
}

static struct page *take_run(unsigned pages) {
  struct page *run = find_run(pages);
  if (!run && grow(pages))
    run = find_run(pages);
  if (run) {
    const unsigned rest = run->free_pages - pages;
    remove_run(run);
    insert_run(run + pages, rest);
  }
  return run;
}

/* Divides the heap. The table and the threads' parts are zero, as all memory is at the start. */
const struct layout *__trax_heap_prepare(void) {
  lock(&runs_lock);
  const uintptr_t heaps = (__trax_heap + 63) & ~(uintptr_t)63;
  const uintptr_t table = (heaps + machine_threads() * sizeof(struct heap) + 63) & ~(uintptr_t)63;
  if (!layout.heaps && __trax_heap_end > table + 2 * PAGE) {
    layout.pages = (unsigned)((__trax_heap_end - table - PAGE) / (PAGE + sizeof(struct page)));
    layout.table = (struct page *)table;
    layout.start = (char *)((table + layout.pages * sizeof(struct page) + PAGE - 1) & ~(uintptr_t)(PAGE - 1));
    layout.heaps = (struct heap *)heaps;
  }
  unlock(&runs_lock);
  return &layout;
}

struct page *__trax_page_allocate(void) {
  const unsigned pages = layout.pages;
  if (__atomic_load_n(&drawn, __ATOMIC_RELAXED) < pages - __atomic_load_n(&top, __ATOMIC_RELAXED)) {
    const unsigned number = __atomic_fetch_add(&drawn, 1, __ATOMIC_RELAXED);
    if (number < pages - __atomic_load_n(&top, __ATOMIC_RELAXED))
      return layout.table + pages - 1 - number;
  }
  lock(&runs_lock);
  struct page *page = take_run(1);
  unlock(&runs_lock);
  return page;
}

void __trax_pages_free(struct page *list) {
  lock(&runs_lock);
  for (struct page *next; list; list = next) {
    next = list->next;
    list->owner = 0;
    insert_run(list, 1);
  }
  unlock(&runs_lock);
}

void *__trax_run_allocate(size_t size, size_t alignment) {
  if (size > (size_t)-1 / 4 || alignment > (size_t)-1 / 4)
    return NULL;
  const unsigned pages = (unsigned)((size + PAGE - 1) / PAGE), more = (unsigned)(alignment / PAGE) - 1;
  void *memory = NULL;
  lock(&runs_lock);
  struct page *run = take_run(pages + more);
  if (run) {
    const unsigned front = (unsigned)(-(uintptr_t)memory_of(run) & (alignment - 1)) / PAGE;
    insert_run(run, front);
    run += front;
    insert_run(run + pages, more - front);
    run->used_pages = pages;
    memory = memory_of(run);
  }
  unlock(&runs_lock);
  return memory;
}

static void check_run(const struct page *page, const void *memory) {
  if (page->used_pages == 0 || memory != memory_of(page))
    __trax_heap_complain();
}

void __trax_run_free(struct page *page, const void *memory) {
  check_run(page, memory);
  lock(&runs_lock);
  insert_run(page, page->used_pages);
  page->used_pages = 0;
  unlock(&runs_lock);
}

size_t __trax_run_resize(struct page *page, const void *memory, size_t size) {
  check_run(page, memory);
  unsigned pages = (unsigned)((size + PAGE - 1) / PAGE);
  const unsigned before = page->used_pages;
  if (pages == before || size <= PAGE || size > (size_t)-1 / 4)
    return (size_t)before * PAGE;
  lock(&runs_lock);
  struct page *end = page + before;
  if (pages > before && end == layout.table + top)
    grow(pages - before);
  if (pages < before) {
    insert_run(page + pages, before - pages);
  } else if (end < layout.table + layout.pages && end->free_pages >= pages - before) {
    const unsigned rest = end->free_pages - (pages - before);
    remove_run(end);
    insert_run(page + pages, rest);
  } else {
    pages = before;
  }
  page->used_pages = pages;
  unlock(&runs_lock);
  return (size_t)pages * PAGE;
}
