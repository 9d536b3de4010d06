/* qsort_r: qsort whose comparison gets a third argument. */
#include <stdlib.h>

static void swap(char *a, char *b, size_t size) {
  for (; size; size--, a++, b++) {
    char t = *a;
    *a = *b;
    *b = t;
  }
}

void qsort_r(void *base, size_t count, size_t size, int (*compare)(const void *, const void *, void *), void *context) {
  char *first = base;
  for (size_t start = count / 2, end = count; end > 1;) {
    if (start)
      start--;
    else
      swap(first, first + --end * size, size);
    /* The element at the parent moves down until none of its children is greater. */
    for (size_t parent = start, child; (child = 2 * parent + 1) < end; parent = child) {
      if (child + 1 < end && compare(first + child * size, first + (child + 1) * size, context) < 0)
        child++;
      if (compare(first + parent * size, first + child * size, context) >= 0)
        break;
      swap(first + parent * size, first + child * size, size);
    }
  }
}
