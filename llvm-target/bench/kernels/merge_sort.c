/* Merge sort from the bottom up, of records by key. */
#include "../bench.h"

enum { N = 4000 };
struct record {
  unsigned key, value;
};
static struct record records[N], buffer[N];

void kernel_setup(void) {}

static void merge(const struct record *from, struct record *to, int low, int middle, int high) {
  int i = low, j = middle;
  for (int k = low; k < high; k++)
    if (i < middle && (j >= high || from[i].key <= from[j].key))
      to[k] = from[i++];
    else
      to[k] = from[j++];
}

static int least(int a, int b) {
  return a < b ? a : b;
}

struct result kernel_run(void) {
  uint32_t random = 5, checksum = 0;
  for (int i = 0; i < N; i++)
    records[i] = (struct record){next_random(&random) >> 20, (unsigned)i};
  struct record *from = records, *to = buffer;
  for (int width = 1; width < N; width *= 2) {
    for (int low = 0; low < N; low += 2 * width)
      merge(from, to, low, least(low + width, N), least(low + 2 * width, N));
    struct record *swapped = from;
    from = to;
    to = swapped;
  }
  for (int i = 0; i < N; i++)
    checksum = mix(mix(checksum, from[i].key), from[i].value);
  return (struct result){checksum, 0};
}
