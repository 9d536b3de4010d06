/* qsort, qsort_r and bsearch. */
#include <stdint.h>
#include <stdlib.h>

typedef uint32_t __attribute__((may_alias)) word;

static void swap(char *a, char *b, size_t size) {
  if ((((uintptr_t)a | (uintptr_t)b | size) & 3) == 0) {
    for (; size; size -= 4, a += 4, b += 4) {
      word t = *(word *)a;
      *(word *)a = *(word *)b;
      *(word *)b = t;
    }
    return;
  }
  for (; size; size--, a++, b++) {
    char t = *a;
    *a = *b;
    *b = t;
  }
}

typedef int compare_function(const void *, const void *);
typedef int compare_with_context(const void *, const void *, void *);

/* Heapsort, which needs no stack for parts still to be sorted. Both functions below inline it. */
static inline __attribute__((always_inline)) void heapsort(char *base, size_t count, size_t size,
                                                           compare_with_context *compare, void *context) {
  for (size_t start = count / 2, end = count; end > 1;) {
    if (start)
      start--;
    else
      swap(base, base + --end * size, size);
    /* Moves the parent's element down until no child is greater. */
    for (size_t parent = start, child; (child = 2 * parent + 1) < end; parent = child) {
      if (child + 1 < end && compare(base + child * size, base + (child + 1) * size, context) < 0)
        child++;
      if (compare(base + parent * size, base + child * size, context) >= 0)
        break;
      swap(base + parent * size, base + child * size, size);
    }
  }
}

void qsort_r(void *base, size_t count, size_t size, compare_with_context *compare, void *context) {
  heapsort(base, count, size, compare, context);
}

static int without_context(const void *a, const void *b, void *compare) {
  return (*(compare_function **)compare)(a, b);
}

void qsort(void *base, size_t count, size_t size, compare_function *compare) {
  heapsort(base, count, size, without_context, &compare);
}

void *bsearch(const void *key, const void *base, size_t count, size_t size, compare_function *compare) {
  const char *low = base;
  while (count) {
    const char *middle = low + count / 2 * size;
    int order = compare(key, middle);
    if (order == 0)
      return (void *)(uintptr_t)middle;
    if (order > 0) {
      low = middle + size;
      count--;
    }
    count /= 2;
  }
  return NULL;
}
