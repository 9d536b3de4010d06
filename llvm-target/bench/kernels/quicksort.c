/* Quicksort, recursive into the smaller part. */
#include "../bench.h"

enum { N = 4000 };
static int values[N];

void kernel_setup(void) {}

static void sort(int *first, int *last) {
  while (first < last) {
    int pivot = first[(last - first) / 2], *i = first, *j = last;
    while (i <= j) {
      while (*i < pivot)
        i++;
      while (*j > pivot)
        j--;
      if (i <= j) {
        int swapped = *i;
        *i++ = *j;
        *j-- = swapped;
      }
    }
    if (j - first < last - i) {
      sort(first, j);
      first = i;
    } else {
      sort(i, last);
      last = j;
    }
  }
}

struct result kernel_run(void) {
  uint32_t random = 99, checksum = 0;
  for (int i = 0; i < N; i++)
    values[i] = (int)next_random(&random);
  sort(values, values + N - 1);
  for (int i = 1; i < N; i++) {
    if (values[i - 1] > values[i])
      return (struct result){0, 0};
    checksum = mix(checksum, (uint32_t)values[i]);
  }
  return (struct result){checksum, 0};
}
