/* The reader of the manual and the language of its semantics, on pages made up for the purpose. */
#include "semantics.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define DIAGRAM                                                                                                        \
  "```\n"                                                                                                              \
  "    31..26   25..21   20..16   15..11   10..0\n"                                                                    \
  "  |   7    |   rd   |   ra   |   rb   |   0   |\n"                                                                  \
  "```\n"
#define SECTION(SEMANTICS) "### op\n" DIAGRAM "Semantics: `" SEMANTICS "`\n" /* whose semantics are in line 6 */
#define WORD(RD, RA, RB) (7u << 26 | (uint32_t)(RD) << 21 | (uint32_t)(RA) << 16 | (uint32_t)(RB) << 11)
#define TEXT 0x1000u

static void expect_error(const char *page, const char *message) {
  struct model_error error = {"none"};
  struct model_isa *isa = model_isa_parse("page", page, &error);
  if (isa)
    fail_msg("read without an error: %s", page);
  assert_string_equal(error.message, message);
}

/* Executes the statement with RA = a and RB = b at pc 0x1000; r3 is RD. */
static struct model_machine *execute(const char *statement, uint32_t a, uint32_t b, enum model_end expected) {
  static struct model_isa *isa; /* of the last call */
  char page[1024];
  struct model_error error = {"none"};
  uint8_t *host;
  model_isa_free(isa);
  snprintf(page, sizeof page, SECTION("%s"), statement);
  isa = model_isa_parse("page", page, &error);
  if (!isa)
    fail_msg("%s", error.message);
  struct model_machine *machine = model_create(isa, 1, 1, 1 << 20, &error);
  assert_non_null(machine);
  assert_true(model_map(machine, TEXT, 4, MODEL_READ | MODEL_EXECUTE, &host, &error));
  assert_true(model_map(machine, 0x2000, 64, MODEL_READ | MODEL_WRITE, NULL, &error));
  const uint32_t word = WORD(3, 1, 2);
  for (unsigned i = 0; i < 4; i++)
    host[i] = (uint8_t)(word >> 8 * i);
  model_set_entry(machine, TEXT);
  machine->threads[0].registers[1] = a;
  machine->threads[0].registers[2] = b;
  machine->threads[0].registers[3] = 77;
  const enum model_end end = model_run(machine, 1, &error);
  if (end != expected)
    fail_msg("%s: %s", statement, error.message);
  return machine;
}

static uint32_t value_of(const char *expression, uint32_t a, uint32_t b) {
  char statement[256];
  snprintf(statement, sizeof statement, "RD = %s;", expression);
  struct model_machine *machine = execute(statement, a, b, MODEL_LIMIT);
  const uint32_t value = machine->threads[0].registers[3];
  model_destroy(machine);
  return value;
}

/* Mixed signs and precedence are the point here. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wparentheses"

static void expressions(void **state) {
  (void)state;
#define EXPECT(EXPRESSION, RA, RB)                                                                                     \
  assert_int_equal(value_of(#EXPRESSION, RA, RB), (uint32_t)(EXPRESSION)) /* the host's compiler agrees */
  const uint32_t PC = TEXT, values[] = {0, 1, 2, 31, 0x7FFFFFFF, 0x80000000, 0x80000001, 0xFFFFFFFF};
  for (size_t i = 0; i < sizeof values / sizeof *values; i++)
    for (size_t j = 0; j < sizeof values / sizeof *values; j++) {
      const uint32_t RA = values[i], RB = values[j];
      EXPECT(RA + RB * 3 - 1, RA, RB);
      EXPECT(RA - RB - 1, RA, RB);
      EXPECT(RA | RB ^ RA & 12, RA, RB);
      EXPECT((RA | RB) ^ RA, RA, RB);
      EXPECT(RA << (RB & 31) >> 3, RA, RB);
      EXPECT(RA < RB, RA, RB);
      EXPECT(RA <= RB, RA, RB);
      EXPECT(RA > RB, RA, RB);
      EXPECT(RA >= RB, RA, RB);
      EXPECT(RA == RB, RA, RB);
      EXPECT(RA != RB, RA, RB);
      EXPECT((int32_t)RA < (int32_t)RB, RA, RB);
      EXPECT((int32_t)RA <= (int32_t)RB, RA, RB);
      EXPECT((int32_t)RA > (int32_t)RB, RA, RB);
      EXPECT((int32_t)RA >= (int32_t)RB, RA, RB);
      EXPECT((int32_t)RA < RB, RA, RB);
      EXPECT((int64_t)RA < (int64_t)(int32_t)RB, RA, RB);
      EXPECT((int64_t)(int32_t)RA < RB, RA, RB);
      EXPECT((uint32_t)(((uint64_t)RA * RB) >> 32), RA, RB);
      EXPECT((uint32_t)((uint64_t)((int64_t)(int32_t)RA * (int32_t)RB) >> 32), RA, RB);
      EXPECT(~RA + !RB + -RB, RA, RB);
      EXPECT(RA && RB, RA, RB);
      EXPECT(RA || RB, RA, RB);
      EXPECT((RA ? RB : PC + 4), RA, RB);
      EXPECT((RA < RB ? RA : RB < 5 ? 6u : 0x10), RA, RB);
    }
#undef EXPECT
  assert_int_equal(value_of("trax_signed(RA) < 0", 0x80000000, 0), 1);
  assert_int_equal(value_of("trax_sra(RA, RB)", 0x80000000, 31), 0xFFFFFFFF);
  assert_int_equal(value_of("trax_sra(RA, RB)", 0x80000000, 0), 0x80000000);
  assert_int_equal(value_of("trax_sra(RA, RB)", 0x7FFFFFFF, 30), 1);
  assert_int_equal(value_of("trax_sext8(RA)", 0x1280, 0), 0xFFFFFF80);
  assert_int_equal(value_of("trax_sext8(RA)", 0x127F, 0), 0x7F);
  assert_int_equal(value_of("trax_sext16(RA)", 0x128000, 0), 0xFFFF8000);
  assert_int_equal(value_of("trax_mulh(RA, RB)", 0x80000000, 0x80000000), 0x40000000);
  assert_int_equal(value_of("trax_mulh(RA, RB)", 0xFFFFFFFF, 1), 0xFFFFFFFF);
  assert_int_equal(value_of("trax_mulh(RA, RB)", 0x7FFFFFFF, 0x80000000), 0xC0000000);
}

#pragma GCC diagnostic pop

static void statements(void **state) {
  (void)state;
  struct model_machine *machine = execute("if (RA) { RD = 1; NEXT_PC = PC + 8; } else RD = 2;", 1, 0, MODEL_LIMIT);
  assert_int_equal(machine->threads[0].registers[3], 1);
  assert_int_equal(machine->threads[0].pc, TEXT + 8);
  model_destroy(machine);
  machine = execute("if (RA) { RD = 1; NEXT_PC = PC + 8; } else RD = 2;", 0, 0, MODEL_LIMIT);
  assert_int_equal(machine->threads[0].registers[3], 2);
  assert_int_equal(machine->threads[0].pc, TEXT + 4);
  model_destroy(machine);
  /* Statements after a fault do not happen, nor does the assignment of a load that faults. */
  machine = execute("RD = LOAD32(RA); NEXT_PC = 0;", 0x2002, 0, MODEL_FAULTED);
  assert_int_equal(machine->fault.kind, MODEL_FAULT_MISALIGNED);
  assert_int_equal(machine->fault.address, 0x2002);
  assert_int_equal(machine->threads[0].registers[3], 77);
  assert_int_equal(machine->threads[0].pc, TEXT);
  model_destroy(machine);
  machine = execute("STORE16(RA, RB); RD = LOAD8(RA) + LOAD32(RA);", 0x2002, 0xABCD1234, MODEL_FAULTED);
  assert_int_equal(machine->memory[0x2002], 0x34);
  assert_int_equal(machine->memory[0x2003], 0x12);
  assert_int_equal(machine->memory[0x2004], 0);
  model_destroy(machine);
}

static void without_a_result(void **state) {
  (void)state;
  model_destroy(execute("RD = RA << RB;", 1, 32, MODEL_ERROR));
  model_destroy(execute("RD = RA >> RB;", 1, 0xFFFFFFFF, MODEL_ERROR));
  model_destroy(execute("RD = trax_sra(RA, RB);", 1, 32, MODEL_ERROR));
  model_destroy(execute("RD = (int32_t)RA + (int32_t)RB;", 0x7FFFFFFF, 1, MODEL_ERROR));
  model_destroy(execute("RD = (int32_t)RA * (int32_t)RB;", 0x10000, 0x10000, MODEL_ERROR));
  model_destroy(execute("RD = -(int32_t)RA;", 0x80000000, 0, MODEL_ERROR));
}

static void segments(void **state) {
  (void)state;
  struct model_error error = {"none"};
  struct model_machine *machine =
      execute("HALT();", 0, 0, MODEL_ENDED); /* text at 0x1000, 64 bytes of data at 0x2000 */
  assert_false(model_map(machine, 0x1000, 4, MODEL_READ, NULL, &error));
  assert_string_equal(error.message, "segments 0x00001000 and 0x00001000 share 64 bytes");
  assert_false(model_map(machine, 0x1FC0, 65, MODEL_READ, NULL, &error));
  assert_string_equal(error.message, "segments 0x00002000 and 0x00001fc0 share 64 bytes");
  assert_true(model_map(machine, 0x1FC0, 64, MODEL_READ, NULL, &error));
  assert_true(model_map(machine, 0x2040, 4, MODEL_READ, NULL, &error));
  assert_false(model_map(machine, 0x2080, 64, MODEL_WRITE | MODEL_EXECUTE, NULL, &error));
  assert_string_equal(error.message, "segment 0x00002080 is both writable and executable");
  assert_false(model_map(machine, 0x0FC0, 4, MODEL_READ, NULL, &error));
  assert_false(model_map(machine, 0x2084, 4, MODEL_READ, NULL, &error));
  assert_false(model_map(machine, 0xFFFC0, 65, MODEL_READ, NULL, &error));
  /* A segment's permissions hold for all of its last 64 bytes. */
  assert_int_equal(model_check(machine, 0x207F, 1, MODEL_STORE), MODEL_FAULT_READ_ONLY);
  assert_int_equal(model_check(machine, 0x2080, 1, MODEL_STORE), MODEL_FAULT_NONE);
  assert_int_equal(model_check(machine, 0x203C, 4, MODEL_STORE), MODEL_FAULT_NONE);
  assert_int_equal(model_check(machine, 0x1FFC, 4, MODEL_STORE), MODEL_FAULT_READ_ONLY);
  assert_int_equal(model_check(machine, 0x1FFC, 4, MODEL_LOAD), MODEL_FAULT_NONE);
  /* Of several faults, the first of docs/isa.md's list is reported. */
  assert_int_equal(model_check(machine, 0xFFF, 4, MODEL_INCREMENT), MODEL_FAULT_NULL);
  assert_int_equal(model_check(machine, 0x100001, 4, MODEL_INCREMENT), MODEL_FAULT_UNMAPPED);
  assert_int_equal(model_check(machine, 0xFFFEFDFF, 4, MODEL_INCREMENT), MODEL_FAULT_UNMAPPED);
  assert_int_equal(model_check(machine, 0xFFFEFE01, 4, MODEL_INCREMENT), MODEL_FAULT_STACK);
  assert_int_equal(model_check(machine, 0xFFFFFDFF, 1, MODEL_LOAD), MODEL_FAULT_STACK);
  assert_int_equal(model_check(machine, 0xFFFFFE01, 4, MODEL_INCREMENT), MODEL_FAULT_MISALIGNED);
  assert_int_equal(model_check(machine, 0xFFFFFE00, 4, MODEL_INCREMENT), MODEL_FAULT_LOCAL);
  assert_int_equal(model_check(machine, 0x1001, 2, MODEL_STORE), MODEL_FAULT_MISALIGNED);
  model_destroy(machine);
}

/* Values with names; registers that follow ra and rb, which are r1 and r2. */
static void names_and_groups(void **state) {
  (void)state;
  const struct {
    const char *statement;
    uint32_t value;
  } cases[] = {{"uint32_t x = RA + 1; uint32_t y = x * x; RD = y - RB;", 120},
               {"uint32_t x = RA; RD = 1; RD = RD + x;", 11},
               {"RD = GROUP_A(0) * 1000 + GROUP_A(1);", 10001},
               {"RD = GROUP_A(2);", 77},
               {"RD = GROUP_B(1) + GROUP_B(30) + GROUP_B(31);", 87}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    struct model_machine *machine = execute(cases[i].statement, 10, 1, MODEL_LIMIT);
    assert_int_equal(machine->threads[0].registers[3], cases[i].value);
    model_destroy(machine);
  }
}

static void wrong_statements(void **state) {
  (void)state;
  expect_error(SECTION("uint32_t = 1; RD = 1;"), "page:6:22: op: expected a name before '='");
  expect_error(SECTION("uint32_t x; RD = 1;"), "page:6:23: op: expected '=' before ';'");
  expect_error(SECTION("uint32_t x = y; uint32_t y = 1;"), "page:6:26: op: unknown word 'y'");
  expect_error(SECTION("RD = trax_fadd(RA, RB, RA);"), "page:6:34: op: expected ')' before ','");
  expect_error(SECTION("RD = trax_foo(RA);"), "page:6:18: op: unknown word 'trax_foo'");
  expect_error(SECTION("RD = RA + RC;"), "page:6:23: op: unknown word 'RC'");
  expect_error(SECTION("RD = IMM;"), "page:6:18: op: the encoding has no field for 'IMM'");
  expect_error(SECTION("RA = RB;"), "page:6:13: op: only RD and NEXT_PC can be assigned to");
  expect_error(SECTION("RD = RA / RB;"), "page:6:21: op: expected ';' before '/'");
  expect_error(SECTION("RD = RA"), "page:6:20: op: expected ';' before 'the end'");
  expect_error(SECTION(""), "page:6:13: op: no statement");
  expect_error(SECTION("RD = (int32_t)RA >> 1;"),
               "page:6:30: op: what the right shift of a signed value gives depends on the compiler");
  expect_error(SECTION("RD = HALT();"), "page:6:18: op: a value is needed here");
  expect_error(SECTION("RD = HALT() + 1;"), "page:6:18: op: a value is needed here");
  expect_error(SECTION("RD = 0x100000000;"), "page:6:18: op: not a number of 32 bits: '0x100000000'");
  expect_error(SECTION("RD = 12ab;"), "page:6:18: op: not a number of 32 bits: '12ab'");
  expect_error(SECTION("RA + RB;"), "page:6:13: op: a value that is not used");
  expect_error(SECTION("if RA RD = 1;"), "page:6:16: op: expected '(' before 'RA'");
  expect_error(SECTION("{ RD = 1;"), "page:6:22: op: expected a value before 'the end'");
  char page[2048] = "### op\n" DIAGRAM "Semantics: `RD = ";
  for (unsigned i = 0; i < 1000; i++)
    strcat(page, "-");
  strcat(page, "RA;`\n");
  expect_error(page, "page:6:80: op: nested too deeply");
}

static void wrong_pages(void **state) {
  (void)state;
  expect_error("", "page: the page describes no instruction");
  expect_error("### add\nprose\n", "page: the page describes no instruction");
  expect_error("### op\nSemantics: `HALT();`\n", "page:1: the instruction has no diagram of its bits");
  expect_error("### op\n" DIAGRAM, "page:1: the instruction has no line 'Semantics: `...`'");
  expect_error("### op\n31..0\nprose\n", "page:3: expected the boxes of the bits in the line above");
  expect_error("### op\n31..26 25..0\n| 1 |\n", "page:3: there are fewer boxes than bits in the line above");
  expect_error("### op\n31..0\n| 1 | 0 |\n", "page:3: there are more boxes than bits in the line above");
  expect_error("### op\n31..26 25..0\n| 64 | 0 |\n", "page:3: '64' is neither a field nor a number of 6 bits");
  expect_error("### op\n31..26 25..0\n| 1 | rx |\n", "page:3: 'rx' is neither a field nor a number of 26 bits");
  expect_error("### op\n31..26 25..0\n| 1 | rd |\n", "page:3: a register's field must have 5 bits");
  expect_error("### op\n31..26 25..21 20..16 15..0\n| 1 | rd | rd | 0 |\n",
               "page:3: a field stands twice in the diagram");
  expect_error("### op\nSemantics: HALT();\n", "page:2: expected a statement between backquotes");
  expect_error(SECTION("HALT();") SECTION("HALT();"), "page:7: the encodings of op and op overlap");
  expect_error("### op\n31..16 15..0\n| 1 | imm |\nSemantics: `HALT();`\n",
               "page:1: the line 'IMM is bits ...' and the diagram do not go together");
  expect_error("### op\n31..16 15..0\n| 1 | imm |\nIMM is bits 14..0, sign extended.\nSemantics: `HALT();`\n",
               "page:1: the line 'IMM is bits ...' and the diagram do not go together");
  expect_error("### op\n31..16 15..0\n| 1 | imm |\nIMM is bits 15..0, maybe extended.\nSemantics: `HALT();`\n",
               "page:4: expected 'IMM is bits H..L, sign|zero extended[, times N].[ Values of N and above are illegal."
               "[ Values below N are illegal.]]'");
}

static void immediates(void **state) {
  (void)state;
  struct model_error error = {"none"};
  struct model_isa *isa =
      model_isa_parse("page",
                      "### a\n31..26 25..16 15..0\n| 1 | 0 | imm |\nIMM is bits 15..0, sign extended, times 4.\n"
                      "Semantics: `NEXT_PC = IMM;`\n## Others\n### prose\ntext\n### b\n"
                      "31..26 25..5 4..0\n| 2 | 0 | imm |\nIMM is bits 4..0, zero extended. Values of 6 and above are "
                      "illegal. Values below 2 are illegal.\nSemantics: `NEXT_PC = IMM;`\n",
                      &error);
  if (!isa)
    fail_msg("%s", error.message);
  assert_int_equal(isa->count, 2);
  assert_true(isa->instructions[0].imm_signed);
  assert_int_equal(isa->instructions[0].imm_scale, 4);
  assert_false(isa->instructions[1].imm_signed);
  assert_int_equal(isa->instructions[1].imm_limit, 6);
  assert_ptr_equal(model_decode(isa, 0x0400FFFF), &isa->instructions[0]);
  assert_null(model_decode(isa, 0x0401FFFF));
  assert_ptr_equal(model_decode(isa, 0x08000005), &isa->instructions[1]);
  assert_null(model_decode(isa, 0x08000006));
  assert_ptr_equal(model_decode(isa, 0x08000002), &isa->instructions[1]);
  assert_null(model_decode(isa, 0x08000001));
  assert_null(model_decode(isa, 0));
  model_isa_free(isa);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(expressions), cmocka_unit_test(statements),       cmocka_unit_test(without_a_result),
      cmocka_unit_test(segments),    cmocka_unit_test(names_and_groups), cmocka_unit_test(wrong_statements),
      cmocka_unit_test(wrong_pages), cmocka_unit_test(immediates),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
