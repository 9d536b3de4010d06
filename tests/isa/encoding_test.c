/* Decoding is total and unambiguous, and encode after decode is the identity: over every 61st word, or with --all
   over all 2^32, which takes a minute of a core. */
#include "trax/isa.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static uint64_t step = 61;

/* The table's entries for each major opcode, against which the decoder is checked. */
static trax_op by_opcode[64][TRAX_OP_COUNT];
static unsigned count_by_opcode[64];

typedef struct range {
  uint64_t first, end; /* words */
  uint64_t legal, ambiguous, decoder_differs, not_identity, example;
} range;

static void *check_range(void *argument) {
  range *r = argument;
  for (uint64_t at = r->first; at < r->end; at += step) {
    uint32_t word = (uint32_t)at;
    unsigned matches = 0;
    trax_op match = TRAX_OP_ILLEGAL;
    const trax_op *ops = by_opcode[word >> 26];
    for (unsigned n = 0; n < count_by_opcode[word >> 26]; n++)
      if ((word & trax_op_table[ops[n]].mask) == trax_op_table[ops[n]].match) {
        matches++;
        match = ops[n];
      }
    trax_inst inst = trax_decode(word);
    bool beyond_limit = (match == TRAX_OP_RDSR && (word & 0xFFFFu) >= 6) ||
                        (match == TRAX_OP_TRAP && (word & 0xFFFFu) >= 8) ||
                        (match == TRAX_OP_FENCE && (word & 0xFFFFu) - 1 >= 3);
    if (matches > 1)
      r->ambiguous++, r->example = word;
    if (inst.op != (beyond_limit ? TRAX_OP_ILLEGAL : match))
      r->decoder_differs++, r->example = word;
    if (inst.op == TRAX_OP_ILLEGAL)
      continue;
    r->legal++;
    if (trax_encode(inst) != word)
      r->not_identity++, r->example = word;
  }
  return NULL;
}

static void test_words(void **state) {
  (void)state;
  for (int op = TRAX_OP_ILLEGAL + 1; op < TRAX_OP_COUNT; op++) {
    unsigned opcode = trax_op_table[op].match >> 26;
    by_opcode[opcode][count_by_opcode[opcode]++] = (trax_op)op;
  }
  long cores = sysconf(_SC_NPROCESSORS_ONLN);
  unsigned threads = cores < 1 ? 1 : cores > 16 ? 16 : (unsigned)cores;
  pthread_t thread[16];
  range ranges[16] = {0};
  for (unsigned n = 0; n < threads; n++) {
    ranges[n].first = (((uint64_t)n << 32) / threads + step - 1) / step * step;
    ranges[n].end = ((uint64_t)(n + 1) << 32) / threads;
    assert_int_equal(pthread_create(&thread[n], NULL, check_range, &ranges[n]), 0);
  }
  uint64_t words = 0, legal = 0;
  for (unsigned n = 0; n < threads; n++) {
    pthread_join(thread[n], NULL);
    words += (ranges[n].end - ranges[n].first + step - 1) / step;
    legal += ranges[n].legal;
    if (ranges[n].ambiguous || ranges[n].decoder_differs || ranges[n].not_identity)
      print_message("for example 0x%08x\n", (unsigned)ranges[n].example);
    assert_int_equal(ranges[n].ambiguous, 0);
    assert_int_equal(ranges[n].decoder_differs, 0);
    assert_int_equal(ranges[n].not_identity, 0);
  }
  assert_int_equal(words, ((UINT64_C(1) << 32) + step - 1) / step);
  print_message("%llu words, %llu legal\n", (unsigned long long)words, (unsigned long long)legal);

  if (step > 1)
    return;
  /* The legal words counted from the formats: a decoder that calls too little legal cannot pass. */
  uint64_t expected = 0;
  for (int op = TRAX_OP_ILLEGAL + 1; op < TRAX_OP_COUNT; op++) {
    unsigned free_bits = (unsigned)__builtin_popcount(~trax_op_table[op].mask);
    expected += op == TRAX_OP_RDSR    ? UINT64_C(32) * 6
                : op == TRAX_OP_TRAP  ? UINT64_C(32) * 8
                : op == TRAX_OP_FENCE ? 3
                                      : UINT64_C(1) << free_bits;
  }
  assert_int_equal(legal, expected);
}

/* No word can be two instructions. */
static void test_no_overlap(void **state) {
  (void)state;
  for (int a = TRAX_OP_ILLEGAL + 1; a < TRAX_OP_COUNT; a++)
    for (int b = a + 1; b < TRAX_OP_COUNT; b++)
      if (!((trax_op_table[a].match ^ trax_op_table[b].match) & trax_op_table[a].mask & trax_op_table[b].mask))
        fail_msg("%s and %s have words in common", trax_op_table[a].mnemonic, trax_op_table[b].mnemonic);
}

static void test_zero_and_ones_are_illegal(void **state) {
  (void)state;
  assert_int_equal(trax_decode(0).op, TRAX_OP_ILLEGAL);
  assert_int_equal(trax_decode(0xFFFFFFFFu).op, TRAX_OP_ILLEGAL);
}

static void check_text(trax_inst inst, uint32_t word, const char *expected) {
  char text[64];
  assert_int_equal(trax_encode(inst), word);
  trax_disassemble(word, 0x1000, text, sizeof text);
  assert_string_equal(text, expected);
}

/* Words assembled by hand from the bit diagrams of docs/isa.md, one for each format. */
static void test_known_words(void **state) {
  (void)state;
  check_text((trax_inst){TRAX_OP_ADD, 4, 5, 6, 0}, 0x04853000u, "add r4, r5, r6");
  check_text((trax_inst){TRAX_OP_FRSQRT, 1, 31, 0, 0}, 0x183F0001u, "frsqrt r1, r31");
  check_text((trax_inst){TRAX_OP_ADDI, 2, 2, 0, -16}, 0x2042FFF0u, "addi r2, r2, -16");
  check_text((trax_inst){TRAX_OP_SRAI, 3, 4, 0, 31}, 0x4064001Fu, "srai r3, r4, 31");
  check_text((trax_inst){TRAX_OP_LUI, 7, 0, 0, 0x3F80}, 0x44E03F80u, "lui r7, 16256");
  check_text((trax_inst){TRAX_OP_LW, 8, 2, 0, -4}, 0x6102FFFCu, "lw r8, -4(r2)");
  check_text((trax_inst){TRAX_OP_SW, 0, 2, 9, 8}, 0x71220008u, "sw r9, 8(r2)");
  check_text((trax_inst){TRAX_OP_BNE, 0, 1, 2, -4}, 0x8422FFFFu, "bne r1, r2, 0xffc");
  check_text((trax_inst){TRAX_OP_JAL, 1, 0, 0, 8}, 0x98200002u, "jal r1, 0x1008");
  check_text((trax_inst){TRAX_OP_JALR, 0, 1, 0, 0}, 0x9C010000u, "jalr r0, 0(r1)");
  check_text((trax_inst){TRAX_OP_RDSR, 5, 0, 0, 3}, 0xA0A00003u, "rdsr r5, threads");
  check_text((trax_inst){TRAX_OP_TRAP, 0, 4, 0, 1}, 0xA4040001u, "trap r4, putc");
  check_text((trax_inst){TRAX_OP_FENCE, 0, 0, 0, 2}, 0xAC000002u, "fence w");
  check_text((trax_inst){.op = TRAX_OP_HALT}, 0xA8000000u, "halt");
}

/* The first of these instructions are of the class, those behind "-" are not. */
static void check_class(unsigned flag, const char *names) {
  bool expected = true;
  char name[16];
  for (int length; sscanf(names, "%15s%n", name, &length) == 1; names += length) {
    unsigned op = 0;
    while (op < TRAX_OP_COUNT && strcmp(trax_op_table[op].mnemonic, name) != 0)
      op++;
    if (strcmp(name, "-") == 0)
      expected = false;
    else if (op == TRAX_OP_COUNT || ((trax_op_table[op].flags & flag) != 0) != expected)
      fail_msg("%s: flag 0x%x", name, flag);
  }
}

static void test_classes(void **state) {
  (void)state;
  check_class(TRAX_IS_FLOP, "fadd fsub fmul - fmin fcvt.s.w fdiv mul");
  check_class(TRAX_IS_COMPARE, "fmin fmax feq flt fle - fadd fmul fcvt.w.s slt");
  check_class(TRAX_IS_CONVERSION, "fcvt.w.s fcvt.wu.s fcvt.s.w fcvt.s.wu - fadd fmin fdiv");
  check_class(TRAX_IS_ROOT, "frsqrt - fdiv");
  check_class(TRAX_IS_LOAD, "lb lbu lh lhu lw lwnt ainc - sb sh sw swnt");
  check_class(TRAX_IS_STORE, "sb sh sw swnt - lw lwnt ainc");
  check_class(TRAX_IS_ATOMIC, "ainc - lw sw lwnt");
  check_class(TRAX_IS_NONTEMPORAL, "lwnt swnt - lw sw ainc");
  check_class(TRAX_IS_BRANCH, "beq bne blt bge bltu bgeu jal jalr - add trap halt");
  check_class(TRAX_IS_RELATIVE, "beq bne blt bge bltu bgeu jal - jalr add trap");
}

int main(int argc, char **argv) {
  if (argc == 2 && strcmp(argv[1], "--all") == 0)
    step = 1;
  else if (argc != 1) {
    fprintf(stderr, "usage: isa-encoding-test [--all]\n");
    return 1;
  }
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_words),
      cmocka_unit_test(test_no_overlap),
      cmocka_unit_test(test_zero_and_ones_are_illegal),
      cmocka_unit_test(test_known_words),
      cmocka_unit_test(test_classes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
