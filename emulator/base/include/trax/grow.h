/* Arrays that grow. */
#ifndef TRAX_GROW_H
#define TRAX_GROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

/* Makes room for `most` elements. False: out of memory, and the array is unchanged. */
static inline bool trax_grow_to(void **array, size_t most, size_t *capacity, size_t size) {
  if (most <= *capacity)
    return true;
  const size_t more = most > 32 ? 2 * most : 64;
  void *grown = realloc(*array, more * size);
  if (!grown)
    return false;
  *array = grown;
  *capacity = more;
  return true;
}

/* Makes room for one more element than `count`. */
static inline bool trax_grow(void **array, size_t count, size_t *capacity, size_t size) {
  return trax_grow_to(array, count + 1, capacity, size);
}

#endif
