/* Counts the work of look-ups, whose results are right even if they search everything. */
#define _GNU_SOURCE /* MAP_ANONYMOUS */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

#include "gdb/stub.h"
#include "program/program.h"
#include "programs.h"
#include "report/watchdog.h"
#include "temporary.h"

/* --- the watchdog's report --- */

static unsigned looked_up;

const struct trax_symbol *__real_trax_image_symbol_at(const trax_image *image, uint32_t address);
const struct trax_symbol *__wrap_trax_image_symbol_at(const trax_image *image, uint32_t address);

const struct trax_symbol *__wrap_trax_image_symbol_at(const trax_image *image, uint32_t address) {
  looked_up++;
  return __real_trax_image_symbol_at(image, address);
}

static void test_the_watchdog_looks_up_each_thread_once(void **state) {
  (void)state;
  const char *path = test_path("idle.elf");
  struct elf_file file = program_file("idle");
  elf_save(path, &file);
  free(file.bytes);
  trax_config *config = trax_config_create();
  trax_error error;
  assert_int_equal(trax_config_preset(config, "2x32", &error), TRAX_OK);
  trax_machine *machine = trax_machine_create(config, &error);
  assert_int_equal(trax_machine_load_elf(machine, path, &error), TRAX_OK);
  struct trax_watchdog *watchdog = trax_watchdog_begin(machine, 1000);
  assert_int_equal(trax_machine_run(machine, NULL, &error), TRAX_STUCK);
  FILE *out = fopen("/dev/null", "w");
  trax_watchdog_print(watchdog, out);
  fclose(out);
  assert_in_range(looked_up, 1, 64);
  trax_watchdog_end(watchdog);
  trax_machine_destroy(machine);
  trax_config_destroy(config);
}

/* --- breakpoints --- */

static volatile sig_atomic_t touched; /* pages */

static void on_fault(int number, siginfo_t *info, void *context) {
  (void)number, (void)context;
  const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE);
  mprotect((void *)((uintptr_t)info->si_addr / page * page), page, PROT_READ | PROT_WRITE);
  touched++;
}

/* A binary search touches few of the pages that have the breakpoints. */
static void test_breakpoints_are_found_by_a_binary_search(void **state) {
  (void)state;
  const size_t page = (size_t)sysconf(_SC_PAGESIZE), size = sizeof(struct trax_gdb) + page;
  struct trax_gdb *gdb = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  assert_true(gdb != MAP_FAILED);
  for (uint32_t i = 0; i < TRAX_GDB_BREAKS; i++)
    gdb->breaks[i] = (struct trax_gdb_break){.address = 0x1000 + 8 * i};
  gdb->break_count = TRAX_GDB_BREAKS;
  struct sigaction action = {.sa_sigaction = on_fault, .sa_flags = SA_SIGINFO}, before;
  assert_int_equal(sigaction(SIGSEGV, &action, &before), 0);
  const uintptr_t first = ((uintptr_t)gdb->breaks + page - 1) / page * page;
  const size_t pages = ((uintptr_t)(gdb->breaks + TRAX_GDB_BREAKS) - first) / page;
  assert_true(pages >= 7);
  for (uint32_t i = 0; i <= TRAX_GDB_BREAKS; i += TRAX_GDB_BREAKS / 4) {
    touched = 0;
    mprotect((void *)first, pages * page, PROT_NONE);
    assert_int_equal(trax_gdb_breaks_at(gdb, 0x1000 + 8 * i), i < TRAX_GDB_BREAKS);
    assert_false(trax_gdb_breaks_at(gdb, 0x1004 + 8 * i));
    assert_in_range(touched, 0, 5);
  }
  sigaction(SIGSEGV, &before, NULL);
  munmap(gdb, size);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_the_watchdog_looks_up_each_thread_once),
                                     cmocka_unit_test(test_breakpoints_are_found_by_a_binary_search)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
