/* Translated code against the interpreters of the functional and the fast engine: random programs, to the last count
   and byte. Then one template after the other is replaced by a wrong one, and each must be noticed. */
#include "cases.h"

#include "translate/template.h"

#include <string.h>

enum { CASES = 60, MOST_CASES = 600 };

/* The compared results. */
struct engines {
  const char *interpreted, *translated;
  uint64_t most; /* instructions of a thread, or cycles: a wrong jump may loop */
};
static const struct engines functional = {"functional-interpreted", "functional-translated", 40000},
                            bursts = {"fast-interpreted", "fast-translated", 20000};

static void give_input(void *context, struct trax_machine *machine) {
  (void)context;
  machine->space.input = DATA;
  machine->space.input_bytes = DATA_BYTES / 2;
}

static bool is_different(const struct engines *engines, struct random_case c, struct difference *difference) {
  c.config.ray.units_per_group += c.config.ray.units_per_group == 0;
  const trax_run_options interpreted = {.engine = engines->interpreted, .max_cycles = engines->most, .host_threads = 1};
  const trax_run_options translated = {.engine = engines->translated, .max_cycles = engines->most, .host_threads = 1};
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
  const struct engines *const engines = *state;
  for (unsigned seed = 0; seed < setting("TRAX_RANDOM_ROUNDS", CASES); seed++) {
    struct difference difference = {""};
    if (is_different(engines, case_of_seed(seed), &difference))
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

/* A loop in another segment, from end to end of it: a burst's record has 16 bits of an instruction's number. */
enum { FAR = 0x100000, FAR_WORDS = 66000 };

static void map_far(void *context, struct trax_machine *machine) {
  const uint32_t begin[] = {I(JALR, 0, 2, 4) /* no jump */, I(ADDI, 1, 1, 1), J(0, 4 * (FAR_WORDS - 9))};
  const uint32_t end[] = {I(ADDI, 31, 31, -1),
                          B(BEQ, 31, 0, 5 * 4),
                          I(ANDI, 4, 31, 1),
                          B(BEQ, 4, 0, 8),
                          I(JALR, 0, 2, 0),
                          J(0, -4 * (FAR_WORDS - 2)),
                          HALT};
  uint8_t *text;
  (void)context;
  assert_int_equal(trax_machine_map(machine, FAR, 4 * FAR_WORDS, TRAX_PERMIT_READ | TRAX_PERMIT_EXECUTE, &text, NULL),
                   TRAX_OK);
  memcpy(text, begin, sizeof begin);
  memcpy(text + 4 * FAR_WORDS - sizeof end, end, sizeof end);
}

static void test_far_jumps(void **state) {
  const struct trax_config config = bench_near(1, 2);
  const uint32_t words[] = {I(ADDI, 31, 0, 60), I(ADDI, 2, 0, 1), I(SLLI, 2, 2, 20), R1(JALR, 0, 2)};
  const trax_run_options reference = {.engine = "reference"};
  struct run a = run_prepared(&config, words, 4, &reference, map_far, NULL);
  (void)state;
  assert_int_equal(a.bench.status, TRAX_OK);
  for (unsigned i = 0; i < 2; i++) {
    const trax_run_options fast = {.engine = i ? bursts.translated : bursts.interpreted};
    struct run b = run_prepared(&config, words, 4, &fast, map_far, NULL);
    expect_same(&a, &b);
    end(&b);
  }
  end(&a);
}

/* A load that ends a translated burst is no store, though the burst before, which was interpreted, had one in its
   place. If it were taken for one, it would execute at issue. */
static void test_load_in_the_place_of_a_store(void **state) {
  enum { NOPS = 150, LOOP = 4, STORE = LOOP + 2 + NOPS + 1 };
  const struct trax_config config = bench_near(1, 2);
  uint32_t words[STORE + 3] = {U(LUI, 20, 1),      I(ADDI, 21, 0, TEXT / 4), I(SLLI, 21, 21, 2),
                               I(ADDI, 31, 0, 20), I(ADDI, 31, 31, -1),      B(BEQ, 31, 0, 4 * (STORE - 3))};
  uint64_t at_issue[2];
  (void)state;
  for (unsigned i = 0; i < NOPS; i++)
    words[LOOP + 2 + i] = NOP;
  words[STORE - 1] = I(LW, 1, 21, 0); /* the program's own words are never written */
  words[STORE] = S(SW, 31, 20, 0);
  words[STORE + 1] = J(0, 4 * (LOOP - STORE - 1));
  words[STORE + 2] = HALT;
  for (unsigned i = 0; i < 2; i++) {
    const trax_run_options options = {.engine = i ? bursts.translated : bursts.interpreted};
    struct run run = run_with(&config, words, STORE + 3, &options);
    assert_int_equal(run.bench.status, TRAX_OK);
    at_issue[i] = run.bench.machine->slow_paths.part[TRAX_SLOW_AT_ISSUE];
    end(&run);
  }
  assert_int_equal(at_issue[0], at_issue[1]);
}

/* Many bursts with stores to local memory follow each other. */
static void test_local_stores(void **state) {
  const struct trax_config config = bench_near(1, 2);
  const uint32_t words[] = {I(ADDI, 31, 0, 200), I(ADDI, 5, 0, -256), S(SW, 31, 5, 0), S(SW, 31, 5, 4),
                            S(SW, 31, 5, 8),     I(LW, 6, 5, 4),      R(ADD, 7, 7, 6), I(ADDI, 31, 31, -1),
                            B(BNE, 31, 0, -24),  U(LUI, 1, 1),        S(SW, 7, 1, 0),  HALT};
  const trax_run_options reference = {.engine = "reference"}, translated = {.engine = bursts.translated};
  struct run a = run_with(&config, words, sizeof words / 4, &reference),
             b = run_with(&config, words, sizeof words / 4, &translated);
  (void)state;
  assert_int_equal(a.bench.status, TRAX_OK);
  expect_same(&a, &b);
  end(&a);
  end(&b);
}

struct trax_template *mutable_templates(unsigned op), *mutable_burst_templates(unsigned op); /* mutable_templates.c */

static bool is_slow(unsigned op) {
  const struct trax_template_part *hot = &mutable_templates(op)[0].hot;
  return hot->bytes == 5 && hot->hole_count == 1 && hot->holes[0].kind == TRAX_HOLE_SLOW;
}

/* The templates of an instruction: bursts have others of loads and stores. */
static struct trax_template *templates_of(const struct engines *engines, unsigned op) {
  return engines == &bursts && mutable_burst_templates(op)[0].hot.bytes ? mutable_burst_templates(op)
                                                                        : mutable_templates(op);
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

static void add_to_constants(struct trax_template *templates, int32_t difference) {
  for (unsigned v = 0; v < TRAX_VARIANTS; v++)
    for (unsigned i = 0; i < templates[v].hot.hole_count; i++) {
      struct trax_template_hole *hole = (struct trax_template_hole *)(uintptr_t)&templates[v].hot.holes[i];
      hole->addend += hole->kind == TRAX_HOLE_IMM || hole->kind == TRAX_HOLE_PC ? difference : 0;
    }
}

enum { INPUT = 20, LOCAL, ROUNDS, OUTPUT, OTHERS, LINK };

/* Appends an instruction of the operation with random operands, which accesses only what the thread may, and jumps over
   one instruction. Only part of global memory is input; a burst stores to local memory alone. */
static void append(struct random_case *c, unsigned op, uint32_t random) {
  const unsigned flags = trax_op_table[op].flags, rd = 1 + random % 12;
  trax_inst inst = {op, (uint8_t)rd, (uint8_t)(1 + (random >> 4) % 12), (uint8_t)(1 + (random >> 8) % 12),
                    (int32_t)(random >> 12) % 32};
  if (flags & (TRAX_IS_LOAD | TRAX_IS_STORE)) {
    const uint8_t bases[] = {LOCAL, INPUT, OTHERS};
    inst.ra = flags & TRAX_IS_STORE ? LOCAL : bases[(random >> 4) % 3];
    inst.imm = (int32_t)(4 * ((random >> 12) % 16));
  }
  if (op == TRAX_OP_JALR) {
    c->words[c->count++] = J(LINK, 8);
    c->words[c->count++] = NOP;
    inst.ra = LINK;
    inst.imm = 12;
  }
  inst.imm = flags & TRAX_IS_RELATIVE ? 8 : inst.imm;
  c->words[c->count++] = trax_encode(inst);
  c->words[c->count++] = I(ADDI, rd, rd, 1);
}

/* Two threads that execute an operation often and store what follows from it: neither is alone. */
static struct random_case case_of_operation(unsigned op, unsigned seed) {
  struct random_case c = {.config = bench_near(1, 2)};
  uint32_t random = seed * 2654435761u + 12345;
  const uint32_t begin[] = {U(LUI, INPUT, 1),           I(ADDI, LOCAL, 0, -256),   I(ADDI, OTHERS, 0, 0x188),
                            I(SLLI, OTHERS, OTHERS, 8), I(ADDI, OUTPUT, 0, 0x1F0), I(SLLI, OUTPUT, OUTPUT, 8),
                            I(ADDI, ROUNDS, 0, 4)};
  memcpy(c.words, begin, sizeof begin);
  c.count = sizeof begin / sizeof *begin;
  const size_t round = c.count;
  for (unsigned i = 1; i <= 12; i++)
    c.words[c.count++] = I(LW, i, i % 2 ? INPUT : OTHERS, (int32_t)(4 * i + 64 * (seed % 8)));
  for (unsigned i = 1; i <= 6; i++) /* small numbers, too */
    c.words[c.count++] = I(ANDI, i, i, 31);
  for (unsigned i = 0; i < 24; i++, random = random * 1664525 + 1013904223)
    append(&c, op, random >> 3);
  for (unsigned i = 1; i <= 12; i++)
    c.words[c.count++] = S(SW, i, OUTPUT, (int32_t)(4 * i));
  for (unsigned i = 0; i < 16; i++) {
    c.words[c.count++] = I(LW, 1, LOCAL, (int32_t)(4 * i));
    c.words[c.count++] = S(SW, 1, OUTPUT, (int32_t)(64 + 4 * i));
  }
  c.words[c.count++] = U(RDSR, LINK, TRAX_SR_CYCLE); /* no burst that began with a store reaches the next round */
  c.words[c.count++] = I(ADDI, INPUT, INPUT, 64);    /* each round has other data */
  c.words[c.count++] = I(ADDI, OTHERS, OTHERS, 64);
  c.words[c.count++] = I(ADDI, ROUNDS, ROUNDS, -1);
  c.words[c.count] = B(BNE, ROUNDS, 0, -4 * (int32_t)(c.count - round));
  c.words[++c.count] = HALT;
  c.count++;
  return c;
}

static void test_mutants(void **state) {
  const struct engines *const engines = *state;
  const size_t bytes = sizeof(struct trax_template[TRAX_VARIANTS]);
  for (unsigned op = 1; op < TRAX_OP_COUNT; op++) {
    struct trax_template saved[TRAX_VARIANTS];
    struct difference difference;
    const unsigned partner = partner_of(op);
    if (is_slow(op))
      continue;
    struct trax_template *const templates = templates_of(engines, op);
    memcpy(saved, templates, bytes);
    if (partner)
      memcpy(templates, templates_of(engines, partner), bytes);
    else
      add_to_constants(templates, 4);
    unsigned seed = 0;
    while (seed < MOST_CASES &&
           !is_different(engines, engines == &bursts ? case_of_operation(op, seed) : case_of_seed(seed), &difference))
      seed++;
    if (!partner)
      add_to_constants(templates, -4);
    memcpy(templates, saved, bytes);
    if (seed == MOST_CASES)
      fail_msg("nobody notices that %s executes as %s", trax_op_table[op].name,
               partner ? trax_op_table[partner].name : "something else");
  }
}

int main(void) {
  void *const both[] = {(void *)(uintptr_t)&functional, (void *)(uintptr_t)&bursts};
  const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(test_equal, both[0]),
                                     cmocka_unit_test(test_large_sequences),
                                     cmocka_unit_test(test_far_jumps),
                                     cmocka_unit_test(test_local_stores),
                                     cmocka_unit_test(test_load_in_the_place_of_a_store),
                                     cmocka_unit_test_prestate(test_mutants, both[0]),
                                     cmocka_unit_test_prestate(test_equal, both[1]),
                                     cmocka_unit_test_prestate(test_mutants, both[1])};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
