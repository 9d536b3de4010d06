/* Arrays that grow. */
#ifndef TRAX_GROW_H
#define TRAX_GROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

/* Makes room for one more element than `count`. False: out of memory, and the array is unchanged. */
static inline bool trax_grow(void **array, size_t count, size_t *capacity, size_t size) {
  if (count < *capacity)
    return true;
  const size_t more = *capacity ? 2 * *capacity : 64;
  void *grown = realloc(*array, more * size);
  if (!grown)
    return false;
  *array = grown;
  *capacity = more;
  return true;
}

#endif
