/* Every kind of fault: what is reported, when, and what the rest of the cycle does. bench_near: first issue in cycle 1.
 */
#include "bench.h"

#include <stdio.h>
#include <string.h>

static void expect(const uint32_t *words, size_t count, trax_fault_kind kind, uint32_t address, unsigned index,
                   uint64_t cycle) {
  const struct trax_config config = bench_near(1, 1);
  struct bench bench = bench_begin(&config, words, count);
  bench_run(&bench, 0);
  const struct trax_fault *fault = trax_machine_fault(bench.machine);
  assert_int_equal(bench.status, TRAX_FAULT);
  assert_int_equal(fault->kind, kind);
  assert_int_equal(fault->address, address);
  assert_int_equal(fault->pc, TEXT + 4 * index);
  assert_int_equal(fault->word, index < count ? words[index] : 0);
  assert_int_equal(fault->cycle, cycle);
  assert_int_equal(bench_cycles(&bench), cycle + 1);
  assert_int_equal(bench_charge(&bench, 0, TRAX_CAUSE_HALTED), 1);
  assert_non_null(strstr(bench.error.message, trax_fault_text(kind)));
  assert_int_equal(trax_machine_exit_status(bench.machine), kind == TRAX_FAULT_ABORT ? 134 : 1);
  bench_end(&bench);
}

#define FAULT(KIND, ADDRESS, INDEX, CYCLE, ...)                                                                        \
  expect((const uint32_t[]){__VA_ARGS__}, sizeof((const uint32_t[]){__VA_ARGS__}) / 4, TRAX_FAULT_##KIND, ADDRESS,     \
         INDEX, CYCLE)

static void data_addresses(void **state) {
  (void)state;
  FAULT(NULL_PAGE, 0, 0, 1, I(LW, 1, 0, 0), HALT);
  FAULT(NULL_PAGE, 0xFFF, 0, 1, S(SB, 1, 0, 0xFFF), HALT);
  FAULT(NULL_PAGE, 4, 0, 1, I(AINC, 1, 0, 4), HALT);
  FAULT(STACK_OVERFLOW, 0xFFFFFDFC, 0, 1, S(SW, 1, 0, -516), HALT);
  FAULT(STACK_OVERFLOW, 0xFFFEFE00, 1, 2, U(LUI, 1, 0xFFFF), I(LW, 2, 1, -512), HALT);
  FAULT(UNMAPPED, 0xFFFEFDFF, 1, 2, U(LUI, 1, 0xFFFF), I(LBU, 2, 1, -513), HALT);
  FAULT(UNMAPPED, 4 << 20, 1, 2, U(LUI, 1, 0x40), I(LW, 2, 1, 0), HALT); /* memory ends at 4 MiB */
  FAULT(UNMAPPED, 4 << 20, 1, 2, U(LUI, 1, 0x40), S(SB, 2, 1, 0), HALT);
  FAULT(MISALIGNED, 0x10002, 1, 2, U(LUI, 1, 1), I(LW, 2, 1, 2), HALT);
  FAULT(MISALIGNED, 0x10001, 1, 2, U(LUI, 1, 1), I(LH, 2, 1, 1), HALT);
  FAULT(MISALIGNED, 0x10003, 1, 2, U(LUI, 1, 1), S(SH, 2, 1, 3), HALT);
  FAULT(MISALIGNED, 0x10001, 1, 2, U(LUI, 1, 1), I(AINC, 2, 1, 1), HALT);
  FAULT(MISALIGNED, 0xFFFFFFFE, 0, 1, I(LW, 2, 0, -2), HALT);
  FAULT(READ_ONLY, RODATA, 1, 2, U(LUI, 1, 3), S(SW, 2, 1, 0), HALT);
  FAULT(READ_ONLY, RODATA + 63, 1, 2, U(LUI, 1, 3), S(SB, 2, 1, 63), HALT);
  FAULT(READ_ONLY, RODATA, 1, 2, U(LUI, 1, 3), I(AINC, 2, 1, 0), HALT);
  FAULT(READ_ONLY, TEXT, 0, 1, S(SW, 2, 0, TEXT), HALT);
  FAULT(NOT_GLOBAL, 0xFFFFFFFC, 0, 1, I(AINC, 2, 0, -4), HALT);
  /* The operand is waited for first: fdiv 1, usable 9. 0 / 0 is a NaN: 0x7FC00000. */
  FAULT(UNMAPPED, 0x7FC00000, 1, 9, R(FDIV, 1, 0, 0), I(LW, 2, 1, 0), HALT);
}

static void allowed_addresses(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 1);
  struct bench bench =
      BENCH(config, I(LW, 1, 0, TEXT), U(LUI, 2, 3), I(LBU, 3, 2, 63), S(SB, 3, 2, 64), U(LUI, 4, 0x3F),
            I(ORI, 4, 4, 0), S(SW, 4, 4, 0x7FFC), S(SB, 1, 0, -512), I(LB, 1, 0, -1), HALT);
  bench_end(&bench);
}

static void instructions(void **state) {
  (void)state;
  FAULT(ILLEGAL, 0, 1, 2, NOP, 0xFFFFFFFF, HALT);
  FAULT(ILLEGAL, 0, 0, 1, 0, HALT);
  FAULT(ILLEGAL, 0, 0, 1, HALT | 1, HALT);
  FAULT(ILLEGAL, 0, 0, 1, U(RDSR, 1, 0) | TRAX_SR_COUNT, HALT);
  FAULT(ILLEGAL, 0, 0, 1, T(0, 0) | TRAX_TRAP_COUNT, HALT);
  FAULT(ABORT, 0, 1, 2, NOP, T(0, TRAX_TRAP_ABORT), HALT);
  FAULT(ABORT, 0x30000, 1, 2, U(LUI, 4, 3), T(4, TRAX_TRAP_ABORT), HALT);
  FAULT(NULL_PAGE, 0, 0, 1, T(0, TRAX_TRAP_PUTS), HALT);
  FAULT(UNMAPPED, 0x80000000, 1, 2, U(LUI, 1, 0x8000), T(1, TRAX_TRAP_PUTS), HALT);
}

static void program_counters(void **state) {
  (void)state;
  FAULT(EXECUTE, TEXT + 4, 1, 2, NOP);                                              /* past the end */
  FAULT(EXECUTE, TEXT - 4, -1, 2, J(0, -4), HALT);                                  /* before the beginning */
  FAULT(EXECUTE, DATA, (DATA - TEXT) / 4, 3, U(LUI, 1, 1), I(JALR, 0, 1, 0), HALT); /* not executable */
  FAULT(EXECUTE, 0, -(TEXT / 4), 2, I(JALR, 0, 0, 0), HALT);                        /* null */
  const struct trax_config config = bench_near(1, 1);
  const uint32_t odd[] = {I(JALR, 0, 0, TEXT + 2), HALT};
  struct bench bench = bench_begin(&config, odd, 2);
  bench_run(&bench, 0);
  const struct trax_fault *fault = trax_machine_fault(bench.machine);
  assert_int_equal(fault->kind, TRAX_FAULT_MISALIGNED_PC);
  assert_int_equal(fault->pc, TEXT + 2);
  assert_int_equal(fault->cycle, 2);
  bench_end(&bench);
}

static void record(void **state) {
  (void)state;
  const struct trax_config config = bench_near(2, 3);
  /* Threads 2 and 4 store to the null page, offset 8, in the same cycle; all others go on to store to DATA. */
  struct trax_config lockstep = config;
  lockstep.icache.ports_per_bank = 64;
  lockstep.dcache.tps_per_bank = 1;
  const uint32_t program[] = {U(RDSR, 5, TRAX_SR_THREAD),
                              I(ADDI, 6, 5, -2),
                              R(SLTU, 7, 0, 6), /* 7: not thread 2 */
                              I(ADDI, 8, 5, -4),
                              R(SLTU, 9, 0, 8),
                              R(AND, 7, 7, 9),
                              I(SLLI, 7, 7, 16),
                              I(SLLI, 10, 5, 2),
                              S(SW, 5, 7, 8),
                              HALT};
  struct bench bench = bench_begin(&lockstep, program, 10);
  bench_run(&bench, 0);
  const struct trax_fault *fault = trax_machine_fault(bench.machine);
  assert_int_equal(bench.status, TRAX_FAULT);
  assert_int_equal(fault->kind, TRAX_FAULT_NULL_PAGE);
  assert_int_equal(fault->thread, 2); /* first in (TM, TP) order */
  assert_int_equal(fault->tm, 0);
  assert_int_equal(fault->tp, 2);
  assert_int_equal(fault->bytes, 4);
  assert_true(fault->write);
  assert_int_equal(fault->cycle, 9);
  assert_int_equal(fault->registers[5], 2);
  assert_int_equal(fault->registers[6], 0);
  assert_int_equal(fault->registers[10], 8);
  /* The rest of the cycle happened: threads 0, 1, 3 and 5 ask for the same word's bank, one per TM stored, 5 did not.
   */
  assert_int_equal(bench_cycles(&bench), 10);
  assert_int_equal(bench_word(&bench, DATA + 8), 3);
  assert_int_equal(bench_charge(&bench, 2, TRAX_CAUSE_HALTED), 1);
  assert_int_equal(bench_charge(&bench, 4, TRAX_CAUSE_HALTED), 1);
  bench_end(&bench);
}

static void lowest_thread_of_the_cycle(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 2);
  config.icache.ports_per_bank = 64;
  /* One TP reaches an illegal instruction (step 2) in the cycle in which the other aborts (step 5), both ways round. */
  for (unsigned aborting = 0; aborting < 2; aborting++) {
    const uint32_t program[] = {U(RDSR, 1, TRAX_SR_TP), aborting ? B(BEQ, 1, 0, 8) : B(BNE, 1, 0, 8),
                                T(0, TRAX_TRAP_ABORT), 0};
    struct bench bench = bench_begin(&config, program, 4);
    bench_run(&bench, 0);
    const struct trax_fault *fault = trax_machine_fault(bench.machine);
    assert_int_equal(fault->tp, 0);
    assert_int_equal(fault->kind, aborting ? TRAX_FAULT_ILLEGAL : TRAX_FAULT_ABORT);
    assert_int_equal(fault->cycle, 3);
    bench_end(&bench);
  }
}

static void guest_output(void **state) {
  (void)state;
  const struct trax_config config = bench_near(1, 2);
  /* Both threads put 'A' + thread; thread order within a cycle. Then "hi" from local memory. */
  struct trax_config lockstep = config;
  lockstep.icache.ports_per_bank = 64;
  const uint32_t program[] = {U(RDSR, 1, TRAX_SR_TP), I(ADDI, 2, 1, 'A'),    T(2, TRAX_TRAP_PUTC),  I(ADDI, 3, 0, 'h'),
                              S(SB, 3, 0, -8),        I(ADDI, 3, 0, 'i'),    S(SB, 3, 0, -7),       I(ADDI, 4, 0, -8),
                              T(4, TRAX_TRAP_PUTS),   I(ADDI, 5, 0, 3),      T(5, TRAX_TRAP_RAYS),  U(LUI, 6, 0x2100),
                              I(ORI, 6, 6, 0x6543),   T(6, TRAX_TRAP_KINDS), T(1, TRAX_TRAP_ITEMS), HALT};
  struct bench bench = bench_begin(&lockstep, program, 16);
  FILE *file = tmpfile();
  assert_non_null(file);
  const trax_run_options options = {.output = file};
  assert_int_equal(trax_machine_run(bench.machine, &options, &bench.error), TRAX_OK);
  char text[16] = {0};
  rewind(file);
  assert_int_equal(fread(text, 1, sizeof text - 1, file), 6);
  assert_string_equal(text, "ABhihi");
  fclose(file);
  const uint64_t *kinds = &bench.machine->stats.total.rays_primary;
  const uint64_t expected[TRAX_RAY_KIND_COUNT] = {6, 8, 10, 12, 0, 0, 2, 4 + 6}; /* of two threads */
  for (unsigned kind = 0; kind < TRAX_RAY_KIND_COUNT; kind++)
    assert_int_equal(kinds[kind], expected[kind]);
  assert_int_equal(bench.machine->stats.total.rays, 48);
  assert_int_equal(bench.machine->stats.total.items, 1);
  bench_end(&bench);
}

static void segments(void **state) {
  (void)state;
  struct trax_config config = bench_near(1, 1);
  trax_error error;
  trax_machine *machine = trax_machine_create(&config, &error);
  uint8_t *host = NULL;
  const unsigned read = TRAX_PERMIT_READ, write = TRAX_PERMIT_WRITE, execute = TRAX_PERMIT_EXECUTE;
#define REFUSED(ADDRESS, BYTES, PERMISSIONS, WORDS)                                                                    \
  assert_int_equal(trax_machine_map(machine, ADDRESS, BYTES, PERMISSIONS, &host, &error), TRAX_ERROR);                 \
  assert_non_null(strstr(error.message, WORDS))
  REFUSED(0xFC0, 64, read, "null page");
  REFUSED(0x1001, 64, read, "aligned");
  REFUSED(0x3FFFC0, 65, read, "fit");
  REFUSED(0xFFFFFFC0, 0xFFFFFFFF, read, "fit");
  REFUSED(0x2000, 64, read | write | execute, "writable and executable");
  assert_int_equal(trax_machine_map(machine, 0x2000, 65, read | execute, &host, &error), TRAX_OK);
  REFUSED(0x2040, 1, read, "overlaps");
  REFUSED(0x1000, 0x1001, read, "overlaps");
  assert_int_equal(trax_machine_map(machine, 0x2080, 4, read | write, &host, &error), TRAX_OK);
#undef REFUSED
  assert_int_equal(trax_machine_set_entry(machine, 0x2002, &error), TRAX_ERROR);
  assert_int_equal(trax_machine_set_entry(machine, 0x2080, &error), TRAX_ERROR);
  assert_int_equal(trax_machine_set_entry(machine, 0x2040, &error), TRAX_ERROR); /* a single byte */
  assert_int_equal(trax_machine_set_entry(machine, 0x203C, &error), TRAX_OK);
  trax_machine_destroy(machine);

  config.chip.tps_per_tm = 65;
  assert_null(trax_machine_create(&config, &error));
  assert_non_null(strstr(error.message, "chip.tps_per_tm"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(data_addresses), cmocka_unit_test(allowed_addresses),
      cmocka_unit_test(instructions),   cmocka_unit_test(program_counters),
      cmocka_unit_test(record),         cmocka_unit_test(lowest_thread_of_the_cycle),
      cmocka_unit_test(guest_output),   cmocka_unit_test(segments),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
