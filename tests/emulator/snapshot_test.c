/* Snapshots of a state (machine/snapshot.h): every byte of its sections comes back, whatever the number of parts, and
   no other one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "machine/snapshot.h"

#include <string.h>

#define THING_STATE(X, S) X(S, uint32_t, count, ) X(S, uint64_t, since, [4])
struct thing {
  THING_STATE(TRAX_FIELD, )
  uint32_t size; /* is part of the section */
};

enum { THINGS = 7, NUMBERS = 5 };
struct state {
  struct thing things[THINGS];
  uint8_t apart[3]; /* in no section */
  uint16_t numbers[NUMBERS];
};

static void visit_all(void *context, trax_section_visitor *visit, void *visitor_context) {
  struct state *state = context;
  const struct trax_visitor the_visitor = {visit, visitor_context}, *visitor = &the_visitor;
  TRAX_VISIT_ALL(thing, THING_STATE, state->things, THINGS);
  TRAX_VISIT_WITHIN(thing, THING_STATE, &state->things[1], 2);
  TRAX_VISIT_NONE(thing, THING_STATE);
  TRAX_VISIT_NUMBERS(uint16_t, state->numbers, NUMBERS);
}

static void every_byte_comes_back(void **unused) {
  (void)unused;
  for (uint32_t parts = 1; parts <= 5; parts++) {
    struct state state, before;
    struct trax_snapshot snapshot = {0};
    memset(&state, 0x5A, sizeof state);
    assert_true(trax_snapshot_create(&snapshot, visit_all, &state));
    assert_int_equal(snapshot.size, sizeof state.things + sizeof state.numbers);
    for (size_t i = 0; i < sizeof state; i++)
      ((uint8_t *)&state)[i] = (uint8_t)(i * 7 + parts);
    before = state;
    for (uint32_t part = 0; part < parts; part++)
      trax_snapshot_save(&snapshot, part, parts);
    memset(&state, 0xA5, sizeof state);
    memcpy(before.apart, state.apart, sizeof state.apart);
    for (uint32_t part = parts; part-- > 0;)
      trax_snapshot_restore(&snapshot, part, parts);
    assert_memory_equal(state.things, before.things, sizeof state.things);
    assert_memory_equal(state.numbers, before.numbers, sizeof state.numbers);
    assert_memory_equal(state.apart, before.apart, sizeof state.apart);
    trax_snapshot_destroy(&snapshot);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_byte_comes_back)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
