/* Ranks by binary64 values: a radix sort by the leading 33 bits, then by the others where these are the same. */
#include "internal.h"

#include <string.h>

enum { BITS = 11, SIZE = 1 << BITS, KEY_BITS = 63, COARSE_SHIFT = KEY_BITS - 3 * BITS, SHORT_RUN = 256 };

static void swap(struct scene_ranking *a, struct scene_ranking *b) {
  const struct scene_ranking other = *a;
  *a = *b, *b = other;
}

/* Moves the records to the other arrays, sorted by the bits of their keys from `shift` on. */
static void scatter(const struct scene_ranking *from, const struct scene_ranking *to, uint32_t count, int shift) {
  uint32_t starts[SIZE] = {0}, start = 0;
  for (uint32_t i = 0; i < count; i++)
    starts[from->keys[i] >> shift & (SIZE - 1)]++;
  for (int i = 0; i < SIZE; i++) {
    const uint32_t size = starts[i];
    starts[i] = start, start += size;
  }
  for (uint32_t i = 0; i < count; i++) {
    const uint32_t at = starts[from->keys[i] >> shift & (SIZE - 1)]++;
    to->keys[at] = from->keys[i], to->numbers[at] = from->numbers[i];
  }
}

/* Sorts a few records. */
static void insert(const struct scene_ranking *records, uint32_t first, uint32_t end) {
  for (uint32_t i = first + 1; i < end; i++) {
    const uint64_t key = records->keys[i];
    const uint32_t number = records->numbers[i];
    uint32_t at = i;
    for (; at > first && records->keys[at - 1] > key; at--)
      records->keys[at] = records->keys[at - 1], records->numbers[at] = records->numbers[at - 1];
    records->keys[at] = key, records->numbers[at] = number;
  }
}

/* Sorts many, whose keys differ below COARSE_SHIFT only. */
static void sort_run(const struct scene_ranking *records, const struct scene_ranking *room, uint32_t first,
                     uint32_t end) {
  const struct scene_ranking run = {records->keys + first, records->numbers + first};
  const uint32_t count = end - first;
  scatter(&run, room, count, 0);
  scatter(room, &run, count, BITS);
  scatter(&run, room, count, 2 * BITS);
  memcpy(run.keys, room->keys, count * sizeof *run.keys);
  memcpy(run.numbers, room->numbers, count * sizeof *run.numbers);
}

void scene_rank(struct scene_ranking *records, struct scene_ranking *room, uint32_t count) {
  for (uint32_t i = 0; i < count; i++)
    records->keys[i] = ~records->keys[i] & INT64_MAX;
  for (int shift = COARSE_SHIFT; shift < KEY_BITS; shift += BITS) {
    scatter(records, room, count, shift);
    swap(records, room);
  }
  for (uint32_t first = 0, end; first < count; first = end) {
    bool sorted = true;
    for (end = first + 1; end < count && records->keys[end] >> COARSE_SHIFT == records->keys[first] >> COARSE_SHIFT;
         end++)
      sorted &= records->keys[end - 1] <= records->keys[end];
    if (!sorted && end - first > SHORT_RUN)
      sort_run(records, room, first, end);
    else if (!sorted)
      insert(records, first, end);
  }
}
