/* Translated code against the interpreter of the functional engine: random programs, to the last count and byte. Then
   one template after the other is replaced by a wrong one, and each must be noticed. */
#include "cases.h"

#include "translate/template.h"

#include <string.h>

enum { CASES = 60, MOST_CASES = 600 };

static void give_input(void *context, struct trax_machine *machine) {
  (void)context;
  machine->space.input = DATA;
  machine->space.input_bytes = DATA_BYTES / 2;
}

static bool is_different(unsigned seed, struct difference *difference) {
  struct random_case c = case_of_seed(seed);
  const uint64_t most = 40000; /* instructions of a thread: a wrong jump may loop */
  c.config.ray.units_per_group += c.config.ray.units_per_group == 0;
  const trax_run_options interpreted = {.engine = "functional-interpreted", .max_cycles = most};
  const trax_run_options translated = {.engine = "functional-translated", .max_cycles = most};
  struct run a = run_prepared(&c.config, c.words, c.count, &interpreted, give_input, NULL);
  struct run b = run_prepared(&c.config, c.words, c.count, &translated, give_input, NULL);
  assert_int_not_equal(a.bench.status, TRAX_ERROR);
  assert_int_not_equal(b.bench.status, TRAX_ERROR);
  const struct trax_fault *const x = &a.bench.machine->fault, *const y = &b.bench.machine->fault;
  const bool is = different_runs(difference, &a, &b) ||
                  (a.bench.status == TRAX_FAULT &&
                   (different_number(difference, "pc of the fault", x->pc, y->pc) ||
                    different_number(difference, "address of the fault", x->address, y->address) ||
                    different_number(difference, "instructions before the fault", x->cycle, y->cycle) ||
                    different_bytes(difference, "registers", x->registers, y->registers, sizeof x->registers)));
  end(&a);
  end(&b);
  return is;
}

static void test_equal(void **state) {
  (void)state;
  for (unsigned seed = 0; seed < setting("TRAX_RANDOM_ROUNDS", CASES); seed++) {
    struct difference difference = {""};
    if (is_different(seed, &difference))
      fail_msg("seed %u: %s", seed, difference.text);
  }
}

/* The code of these sequences is larger than all that may be translated. */
static void test_large_sequences(void **state) {
  enum { LARGE = 4000, ROUNDS = 3 };
  static uint32_t words[LARGE + 5];
  (void)state;
  struct trax_config config = bench_near(1, 2);
  config.ray.units_per_group = 1;
  words[0] = I(ADDI, 31, 0, ROUNDS);
  for (unsigned i = 1; i <= LARGE; i++)
    words[i] = i % 1000 ? R(FTRI, 20, 2, 8) : J(0, 4); /* a sequence begins behind a jump */
  words[LARGE + 1] = I(ADDI, 31, 31, -1);
  words[LARGE + 2] = B(BEQ, 31, 0, 8);
  words[LARGE + 3] = J(0, -4 * (LARGE + 2));
  words[LARGE + 4] = HALT;
  const trax_run_options interpreted = {.engine = "functional-interpreted"},
                         translated = {.engine = "functional-translated"};
  struct run a = run_with(&config, words, LARGE + 5, &interpreted),
             b = run_with(&config, words, LARGE + 5, &translated);
  assert_int_equal(a.bench.status, TRAX_OK);
  expect_same(&a, &b);
  end(&a);
  end(&b);
}

struct trax_template *mutable_templates(unsigned op); /* mutable_templates.c */

static bool is_slow(unsigned op) {
  const struct trax_template_part *hot = &mutable_templates(op)[0].hot;
  return hot->bytes == 5 && hot->hole_count == 1 && hot->holes[0].kind == TRAX_HOLE_SLOW;
}

/* Another instruction with the same operands, or none. Only those that read groups have the state as an operand. */
static unsigned partner_of(unsigned op) {
  const unsigned alike = TRAX_READS_RA | TRAX_READS_RB | TRAX_READS_RD | TRAX_WRITES_RD | TRAX_IS_LOAD | TRAX_IS_STORE |
                         TRAX_IS_BRANCH | TRAX_IS_RELATIVE;
  const unsigned flags = trax_op_table[op].flags;
  for (unsigned i = 1; i < TRAX_OP_COUNT; i++) {
    const unsigned other = (op + i) % TRAX_OP_COUNT, others = trax_op_table[other].flags;
    if (other != TRAX_OP_ILLEGAL && !is_slow(other) && !((flags ^ others) & alike) &&
        (trax_group_a(flags) > 1) == (trax_group_a(others) > 1))
      return other;
  }
  return TRAX_OP_ILLEGAL;
}

static void add_to_constants(unsigned op, int32_t difference) {
  for (unsigned v = 0; v < TRAX_VARIANTS; v++)
    for (unsigned i = 0; i < mutable_templates(op)[v].hot.hole_count; i++) {
      struct trax_template_hole *hole = (struct trax_template_hole *)(uintptr_t)&mutable_templates(op)[v].hot.holes[i];
      hole->addend += hole->kind == TRAX_HOLE_IMM || hole->kind == TRAX_HOLE_PC ? difference : 0;
    }
}

static void test_mutants(void **state) {
  (void)state;
  const size_t bytes = sizeof(struct trax_template[TRAX_VARIANTS]);
  for (unsigned op = 1; op < TRAX_OP_COUNT; op++) {
    struct trax_template saved[TRAX_VARIANTS];
    struct difference difference;
    const unsigned partner = partner_of(op);
    if (is_slow(op))
      continue;
    memcpy(saved, mutable_templates(op), bytes);
    if (partner)
      memcpy(mutable_templates(op), mutable_templates(partner), bytes);
    else
      add_to_constants(op, 4);
    unsigned seed = 0;
    while (seed < MOST_CASES && !is_different(seed, &difference))
      seed++;
    if (!partner)
      add_to_constants(op, -4);
    memcpy(mutable_templates(op), saved, bytes);
    if (seed == MOST_CASES)
      fail_msg("nobody notices that %s executes as %s", trax_op_table[op].name,
               partner ? trax_op_table[partner].name : "something else");
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_equal), cmocka_unit_test(test_large_sequences),
                                     cmocka_unit_test(test_mutants)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
