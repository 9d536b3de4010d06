/* qsort and bsearch. */
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

/* Moves the element at parent down until none of its children, at twice its number plus 1 and 2, is greater. */
static void sift_down(char *base, size_t parent, size_t count, size_t size,
                      int (*compare)(const void *, const void *)) {
  size_t child;
  while ((child = 2 * parent + 1) < count) {
    if (child + 1 < count && compare(base + child * size, base + (child + 1) * size) < 0)
      child++;
    if (compare(base + parent * size, base + child * size) >= 0)
      return;
    swap(base + parent * size, base + child * size, size);
    parent = child;
  }
}

void qsort(void *base, size_t count, size_t size, int (*compare)(const void *, const void *)) {
  for (size_t i = count / 2; i-- > 0;)
    sift_down(base, i, count, size, compare);
  for (size_t last = count; last-- > 1;) {
    swap(base, (char *)base + last * size, size);
    sift_down(base, 0, last, size, compare);
  }
}

void *bsearch(const void *key, const void *base, size_t count, size_t size,
              int (*compare)(const void *, const void *)) {
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
