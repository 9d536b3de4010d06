/* Memory in large pages. */
#define _GNU_SOURCE /* MADV_HUGEPAGE */
#include "internal.h"

#include <stdlib.h>
#include <sys/mman.h>

void *scene_allocate(size_t size) {
  enum { LINE = 64, PAGE = 2 << 20 };
  const bool large = size >= PAGE;
  const size_t unit = large ? PAGE : LINE, whole = (size + unit - 1) / unit * unit;
  void *memory = aligned_alloc(unit, whole);
  if (memory && large)
    madvise(memory, whole, MADV_HUGEPAGE);
  return memory;
}
