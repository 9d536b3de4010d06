/* An overlay of memory (machine/overlay.h) against a plain array: stores, loads, lines in use, and what is copied back.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "machine/overlay.h"

enum { BYTES = 1 << 17, LINES = BYTES / TRAX_OVERLAY_BYTES, ROUNDS = 200, STEPS = 6000 };

static uint32_t random_below(uint32_t limit) {
  static uint32_t state = 1;
  state ^= state << 13;
  state ^= state >> 17;
  state ^= state << 5;
  return state % limit;
}

struct plain {
  uint8_t below[BYTES], now[BYTES]; /* the memory below the overlay, and with it */
  uint32_t written[LINES];
  size_t lines;
};

static void step(struct trax_overlay *overlay, struct plain *plain, uint32_t range) {
  const uint32_t bytes = 1u << random_below(3), address = random_below(range / bytes) * bytes;
  const uint32_t number = address / TRAX_OVERLAY_BYTES, value = random_below(UINT32_MAX);
  struct trax_overlay_line *line = trax_overlay_find(overlay, number);
  uint32_t expected = 0;
  assert_int_equal(line != NULL, plain->written[number] != 0);
  if (line) {
    assert_int_equal(line->number, number);
    assert_int_equal(line->written, plain->written[number]);
    memcpy(&expected, plain->now + address, bytes);
    assert_int_equal(trax_overlay_load(line, plain->below, address, bytes), expected);
  }
  if (random_below(2)) {
    plain->lines += !line;
    if (!(line = trax_overlay_put(overlay, number)))
      abort();
    trax_overlay_store(line, address, value, bytes);
    memcpy(plain->now + address, &value, bytes);
    for (uint32_t i = 0; i < bytes; i++)
      plain->written[number] |= 1u << (address + i) % TRAX_OVERLAY_BYTES;
  }
  assert_int_equal(overlay->count, plain->lines);
}

static void same_as_an_array(void **state) {
  (void)state;
  static struct trax_overlay overlay;
  static struct plain plain;
  for (unsigned round = 0; round < ROUNDS; round++) {
    const uint32_t range = BYTES >> random_below(12); /* few lines, or several in a slot */
    for (uint32_t i = 0; i < BYTES; i++)
      plain.below[i] = plain.now[i] = (uint8_t)random_below(256);
    memset(plain.written, 0, sizeof plain.written);
    plain.lines = 0;
    for (unsigned i = 0; i < STEPS; i++)
      step(&overlay, &plain, range);
    for (size_t i = 0; i < overlay.count; i++)
      trax_overlay_copy(plain.below + overlay.lines[i].number * TRAX_OVERLAY_BYTES, overlay.lines[i].bytes,
                        overlay.lines[i].written);
    assert_memory_equal(plain.below, plain.now, BYTES);
    trax_overlay_empty(&overlay);
    for (uint32_t number = 0; number < LINES; number++)
      assert_null(trax_overlay_find(&overlay, number));
  }
  trax_overlay_destroy(&overlay);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(same_as_an_array)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
