/* Programs through the public interface: buffers, statistics, faults. */
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>
#include <jansson.h>

#include "machine/machine.h"
#include "programs.h"
#include "report/energy.h"
#include "report/statistics.h"
#include "temporary.h"

static const char *file_name;

static void expect_message(const trax_error *error, const char *part) {
  if (!strstr(error->message, part))
    fail_msg("the message \"%s\" lacks \"%s\"", error->message, part);
}

static trax_machine *load_with(const char *program, const trax_config *config) {
  struct elf_file file = program_file(program);
  assert_non_null(file.bytes);
  elf_save(file_name, &file);
  free(file.bytes);
  trax_error error;
  trax_machine *machine = trax_machine_create(config, &error);
  if (!machine || trax_machine_load_elf(machine, file_name, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  return machine;
}

static trax_machine *load(const char *program) {
  trax_config *config = trax_config_create();
  assert_int_equal(trax_config_set(config, "memory.size_mib", "4", NULL), TRAX_OK);
  trax_machine *machine = load_with(program, config);
  trax_config_destroy(config);
  return machine;
}

static uint32_t word(const trax_machine *machine, uint32_t address) {
  uint32_t value;
  memcpy(&value, machine->space.bytes + address, 4);
  return value;
}

static double figure(const trax_machine *machine, const char *name) {
  double value;
  if (!trax_stats_get(machine, name, &value))
    fail_msg("there is no statistic %s", name);
  return value;
}

/* --- buffers --- */

enum { GUARD = 65536 }; /* bytes before and behind each buffer */

static void test_buffers_are_placed_behind_the_image(void **state) {
  (void)state;
  trax_machine *machine = load("copy");
  trax_error error;
  const uint32_t end = DATA + 128, first = end + GUARD,
                 second = first + 64 + GUARD; /* the segment ends at DATA + 124 */
  assert_int_equal(word(machine, COPY_HEAP), end);
  assert_int_equal(word(machine, COPY_HEAP_END), 4 << 20);

  static const uint32_t values[] = {1, 0x80000000u, 0xDEADBEEFu};
  assert_int_equal(trax_machine_bind(machine, "input", values, sizeof values, &error), TRAX_OK);
  assert_int_equal(word(machine, COPY_INPUT), first);
  assert_int_equal(word(machine, COPY_INPUT + 4), 12);
  assert_int_equal(word(machine, COPY_HEAP), second);
  assert_int_equal(trax_machine_bind(machine, "output", NULL, 100, &error), TRAX_OK);
  assert_int_equal(word(machine, COPY_OUTPUT), second);
  assert_int_equal(word(machine, COPY_OUTPUT + 4), 100);
  uint32_t place, place_bytes;
  uint8_t *in_place;
  assert_int_equal(trax_machine_buffer(machine, "output", &place, &in_place, &place_bytes, &error), TRAX_OK);
  assert_int_equal(place, word(machine, COPY_OUTPUT));
  assert_int_equal(place_bytes, 100);
  assert_ptr_equal(in_place, machine->space.bytes + place);
  assert_int_equal(trax_machine_buffer(machine, "last", &place, &in_place, &place_bytes, &error), TRAX_ERROR);
  assert_true(trax_machine_find_symbol(machine, "output", &place, &place_bytes));
  assert_int_equal(place, COPY_OUTPUT);
  assert_int_equal(place_bytes, 8);
  assert_false(trax_machine_find_symbol(machine, "none", &place, &place_bytes));
  assert_int_equal(word(machine, COPY_HEAP), second + 128 + GUARD);

  assert_int_equal(trax_machine_run(machine, NULL, &error), TRAX_OK);
  const uint8_t *bytes;
  uint32_t size;
  assert_int_equal(trax_machine_read_buffer(machine, "output", &bytes, &size, &error), TRAX_OK);
  assert_int_equal(size, 100);
  assert_memory_equal(bytes, values, sizeof values);
  for (size_t i = sizeof values; i < 100; ++i)
    assert_int_equal(bytes[i], 0);
  assert_int_equal(trax_machine_read_buffer(machine, "last", &bytes, &size, &error), TRAX_ERROR);
  expect_message(&error, "no buffer last is bound");
  trax_machine_destroy(machine);
}

static trax_fault_kind load_of(const trax_machine *machine, uint32_t address, uint32_t bytes) {
  return trax_space_check(&machine->space, address, bytes, false);
}

static trax_fault_kind store_to(const trax_machine *machine, uint32_t address, uint32_t bytes) {
  return trax_space_check(&machine->space, address, bytes, true);
}

/* Every byte outside a buffer, within 64 KiB of it, cannot be accessed, whatever its size; every byte in it can. A load
   of a word that is partly in the buffer is allowed: a search for a NUL reads whole words. */
static void test_buffers_end_at_guards(void **state) {
  (void)state;
  for (uint32_t size = 0; size < 140; size += size < 9 ? 1 : 55) {
    trax_machine *machine = load("copy");
    assert_int_equal(trax_machine_bind(machine, "input", NULL, size, NULL), TRAX_OK);
    assert_int_equal(trax_machine_bind(machine, "output", NULL, size, NULL), TRAX_OK);
    const uint32_t addresses[] = {word(machine, COPY_INPUT), word(machine, COPY_OUTPUT)};
    for (unsigned i = 0; i < 2; i++) {
      const uint32_t begin = addresses[i], end = begin + size, words_end = (end + 3) / 4 * 4;
      for (uint32_t at = begin - GUARD; at < end + GUARD; at++) {
        const bool inside = at >= begin && at < end, readable = at >= begin && at < words_end;
        assert_int_equal(store_to(machine, at, 1), inside ? TRAX_FAULT_NONE : TRAX_FAULT_UNMAPPED);
        assert_int_equal(load_of(machine, at, 1), readable ? TRAX_FAULT_NONE : TRAX_FAULT_UNMAPPED);
        if (at % 4)
          continue;
        assert_int_equal(store_to(machine, at, 4), inside && at + 4 <= end ? TRAX_FAULT_NONE : TRAX_FAULT_UNMAPPED);
        assert_int_equal(load_of(machine, at, 4), readable ? TRAX_FAULT_NONE : TRAX_FAULT_UNMAPPED);
      }
    }
    trax_machine_destroy(machine);
  }
}

static void refuse_bind(trax_machine *machine, const char *symbol, uint32_t size, const char *message) {
  trax_error error = {.message = ""};
  const uint32_t heap = word(machine, COPY_HEAP);
  if (trax_machine_bind(machine, symbol, NULL, size, &error) != TRAX_ERROR)
    fail_msg("a buffer is bound that should be refused with \"%s\"", message);
  expect_message(&error, message);
  assert_int_equal(word(machine, COPY_HEAP), heap);
}

static void test_buffers_that_cannot_be(void **state) {
  (void)state;
  trax_machine *machine = load("copy");
  const uint32_t room = (4u << 20) - (DATA + 128 + GUARD);
  refuse_bind(machine, "none", 4, "the program has no symbol none");
  refuse_bind(machine, "_start", 4, "is not an object of 8 bytes in the program's data");
  refuse_bind(machine, "__trax_heap", 4, "is not an object of 8 bytes");
  refuse_bind(machine, "last", 4, "is not an object of 8 bytes");
  refuse_bind(machine, "output", room + 1, "does not fit into memory");
  refuse_bind(machine, "output", UINT32_MAX, "raise memory.size_mib");
  assert_int_equal(trax_machine_bind(machine, "output", NULL, room, NULL), TRAX_OK); /* to the last byte */
  assert_int_equal(word(machine, COPY_HEAP), 4u << 20);
  refuse_bind(machine, "output", 0, "buffer output is bound twice");
  refuse_bind(machine, "input", 1, "does not fit into memory: 0 bytes are free");
  assert_int_equal(trax_machine_bind(machine, "input", NULL, 0, NULL), TRAX_OK);
  assert_int_equal(trax_machine_run(machine, NULL, NULL), TRAX_OK);
  refuse_bind(machine, "input", 0, "has run already");
  trax_machine_destroy(machine);
}

static void test_files_as_buffers(void **state) {
  (void)state;
  trax_machine *machine = load("copy");
  trax_error error;
  const char *path = test_path("data");
  int descriptor = open(path, O_RDWR | O_CREAT, 0600);
  assert_true(descriptor >= 0);
  assert_int_equal(ftruncate(descriptor, 4 << 20), 0);
  assert_int_equal(trax_machine_bind_file(machine, "input", path, &error), TRAX_ERROR);
  expect_message(&error, "buffer input does not fit into memory");
  assert_int_equal(trax_machine_bind_file(machine, "input", "/nonexistent", &error), TRAX_ERROR);
  expect_message(&error, "buffer input: /nonexistent: cannot be read: No such file or directory");
  assert_int_equal(trax_machine_bind_file(machine, "input", "/", &error), TRAX_ERROR);
  expect_message(&error, "buffer input: /: cannot be read: Is a directory");
  assert_int_equal(ftruncate(descriptor, 0), 0);
  assert_int_equal(write(descriptor, "abcdefgh", 8), 8);
  assert_int_equal(trax_machine_bind_file(machine, "input", path, &error), TRAX_OK);
  assert_int_equal(trax_machine_bind(machine, "output", NULL, 8, &error), TRAX_OK);
  assert_int_equal(trax_machine_run(machine, NULL, &error), TRAX_OK);
  const uint8_t *bytes;
  uint32_t size;
  assert_int_equal(trax_machine_read_buffer(machine, "output", &bytes, &size, &error), TRAX_OK);
  assert_memory_equal(bytes, "abcdefgh", 8);
  close(descriptor);
  trax_machine_destroy(machine);
}

static void test_loading_twice_or_too_large(void **state) {
  (void)state;
  trax_error error;
  trax_machine *machine = load("hello");
  assert_int_equal(trax_machine_load_elf(machine, file_name, &error), TRAX_ERROR);
  expect_message(&error, "has a program already");
  trax_machine_destroy(machine);

  struct elf_file file = program_file("hello");
  elf_program_header(&file, 1)->p_memsz = 2 << 20;
  elf_save(file_name, &file);
  free(file.bytes);
  trax_config *config = trax_config_create();
  trax_config_set(config, "memory.size_mib", "2", NULL);
  machine = trax_machine_create(config, &error);
  assert_int_equal(trax_machine_load_elf(machine, file_name, &error), TRAX_ERROR);
  expect_message(&error, "the program ends at 0x00210000, but memory ends at 0x00200000: raise memory.size_mib");
  assert_int_equal(trax_machine_bind(machine, "text", NULL, 4, &error), TRAX_ERROR);
  expect_message(&error, "no program is loaded");
  assert_int_equal(trax_machine_run(machine, NULL, &error), TRAX_ERROR);
  trax_machine_destroy(machine);
  trax_config_destroy(config);
}

/* --- statistics --- */

struct names {
  char name[512][80];
  size_t count;
};

static void collect_name(void *context, const struct trax_figure *figure) {
  struct names *names = context;
  assert_true(names->count < 512);
  assert_true(strlen(figure->unit) > 0 && strlen(figure->meaning) > 0);
  strcpy(names->name[names->count++], figure->name);
}

static void find_rays(void *context, const struct trax_figure *figure) {
  if (strcmp(figure->name, "rays") == 0)
    *(uint64_t *)context = figure->count;
}

/* Also beyond the whole numbers that a double holds. */
static void test_large_counts(void **state) {
  (void)state;
  static struct trax_stats stats = {.cycles = 1, .threads = 1};
  static const struct trax_config config = TRAX_CONFIG_DEFAULT;
  for (unsigned bit = 50; bit < 63; bit++) {
    uint64_t found = 0;
    stats.total.rays = ((uint64_t)1 << bit) + 1;
    trax_figures_visit(&stats, NULL, &config, find_rays, &found);
    assert_int_equal(found, stats.total.rays);
  }
}

/* A name is neither twice there nor both a figure and a level above figures. */
static void test_names_are_a_tree(void **state) {
  (void)state;
  static struct names names;
  trax_figures_visit(NULL, NULL, NULL, collect_name, &names);
  assert_true(names.count > 100);
  for (size_t i = 0; i < names.count; ++i)
    for (size_t j = 0; j < names.count; ++j) {
      size_t length = strlen(names.name[i]);
      if (i != j && strncmp(names.name[i], names.name[j], length) == 0 &&
          (names.name[j][length] == 0 || names.name[j][length] == '.'))
        fail_msg("%s and %s", names.name[i], names.name[j]);
    }
}

static trax_machine *run_mix(void) {
  trax_config *config = trax_config_create();
  assert_int_equal(trax_config_preset(config, "2x48", NULL), TRAX_OK);
  trax_machine *machine = load_with("mix", config);
  trax_config_destroy(config);
  trax_error error;
  if (trax_machine_run(machine, NULL, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  return machine;
}

/* The program executes, in each of 96 threads, 4 instructions, 50 rounds of 17, and 1. */
static void test_counts_of_a_known_program(void **state) {
  (void)state;
  trax_machine *machine = run_mix();
  const double rounds = 96 * 50;
  assert_true(figure(machine, "threads") == 96);
  assert_true(figure(machine, "instructions") == rounds * 17 + 96 * 5);
  assert_true(figure(machine, "causes.issued") == figure(machine, "instructions"));
  assert_true(figure(machine, "rays") == rounds);
  assert_true(figure(machine, "atomics") == rounds);
  assert_true(figure(machine, "flops") == 3 * rounds);
  assert_true(figure(machine, "fp_add.operations") == 3 * rounds); /* fadd, fsub, fmin */
  assert_true(figure(machine, "fp_mul.operations") == rounds);
  assert_true(figure(machine, "int_mul.operations") == rounds);
  assert_true(figure(machine, "special.operations") == 2 * rounds);
  assert_true(figure(machine, "local.loads") == rounds);
  assert_true(figure(machine, "local.stores") == rounds);
  assert_true(figure(machine, "nontemporal.loads") == rounds);
  assert_true(figure(machine, "nontemporal.stores") == rounds);
  assert_true(figure(machine, "taken_branches") == 96 * 49);
  assert_true(figure(machine, "instructions_by_operation.fdiv") == rounds);
  assert_true(figure(machine, "instructions_by_operation.addi") == rounds + 2 * 96);
  assert_true(figure(machine, "instructions_by_operation.fcvt_w_s") == 0);
  assert_true(figure(machine, "instructions_by_unit.memory") == 7 * rounds);
  assert_true(figure(machine, "instructions_by_unit.special") == 2 * rounds);
  assert_true(figure(machine, "dcache.hits") + figure(machine, "dcache.misses") + figure(machine, "dcache.merged") ==
              rounds);

  const double seconds = figure(machine, "cycles") / 500e6;
  assert_true(figure(machine, "seconds") == seconds);
  assert_true(fabs(figure(machine, "mrps") * seconds * 1e6 - rounds) < 1e-6);
  assert_true(fabs(figure(machine, "gflops") * seconds * 1e9 - 3 * rounds) < 1e-6);
  assert_true(fabs(figure(machine, "memory.bandwidth_gbps") * seconds * 1e9 - figure(machine, "memory.bytes")) < 1e-6);
  assert_true(figure(machine, "memory.utilisation") <= 1);
  assert_true(figure(machine, "host_seconds") > 0);
  assert_true(trax_stats_identity(&machine->stats));
  double value = 7;
  assert_false(trax_stats_get(machine, "no.such", &value));
  assert_true(value == 7);
  trax_machine_destroy(machine);
}

struct comparison {
  const trax_machine *machine;
  json_t *root, *tms;
  unsigned compared;
};

static json_t *at_path(json_t *object, const char *path) {
  char part[80];
  for (const char *dot; object && (dot = strchr(path, '.')); path = dot + 1) {
    snprintf(part, sizeof part, "%.*s", (int)(dot - path), path);
    object = json_object_get(object, part);
  }
  return json_object_get(object, path);
}

static void compare_figure(void *context, const struct trax_figure *expected) {
  struct comparison *comparison = context;
  json_t *value = at_path(comparison->root, expected->name);
  if (!json_is_number(value) || json_is_integer(value) != expected->whole)
    fail_msg("%s is missing, or of another type", expected->name);
  double got = json_number_value(value), exact = figure(comparison->machine, expected->name);
  if (fabs(got - exact) > 1e-14 * fabs(exact))
    fail_msg("%s is %.17g, not %.17g", expected->name, got, exact);
  ++comparison->compared;
  if (expected->group == TRAX_GROUP_RUN || expected->group == TRAX_GROUP_MEMORY || expected->group == TRAX_GROUP_SHARE)
    return;
  double sum = 0;
  for (size_t i = 0; i < json_array_size(comparison->tms); ++i)
    sum += json_number_value(at_path(json_array_get(comparison->tms, i), expected->name));
  if (sum != exact)
    fail_msg("%s: the TMs have %.17g, the chip %.17g", expected->name, sum, exact);
}

static void test_json_says_the_same(void **state) {
  (void)state;
  trax_machine *machine = run_mix();
  trax_error error;
  if (trax_stats_write_json(machine, file_name, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  json_error_t json_error;
  json_t *root = json_load_file(file_name, JSON_REJECT_DUPLICATES, &json_error);
  if (!root)
    fail_msg("line %d: %s", json_error.line, json_error.text);
  struct comparison comparison = {machine, root, json_object_get(root, "tms"), 0};
  assert_int_equal(json_array_size(comparison.tms), 2);
  trax_figures_visit(&machine->stats, NULL, &machine->config, compare_figure, &comparison);
  assert_true(comparison.compared > 100);

  assert_string_equal(json_string_value(json_object_get(root, "status")), "finished");
  assert_true(json_is_false(json_object_get(root, "partial")));
  assert_int_equal(json_integer_value(json_object_get(root, "exit_status")), 0);
  assert_string_equal(json_string_value(json_object_get(root, "program")), file_name);
  assert_true(json_is_true(at_path(root, "identity.holds")));
  assert_int_equal(json_integer_value(at_path(root, "identity.cause_sum")),
                   json_integer_value(json_object_get(root, "thread_cycles")));
  assert_null(json_object_get(root, "fault"));
  for (size_t i = 0; i < trax_config_key_count; ++i) {
    char path[128];
    snprintf(path, sizeof path, "configuration.%s", trax_config_keys[i].name);
    json_t *value = at_path(root, path);
    assert_non_null(value);
    const char *word = trax_config_word(&machine->config, trax_config_keys[i].name);
    if (word) {
      assert_string_equal(json_string_value(value), word);
      continue;
    }
    double number = json_is_boolean(value) ? json_is_true(value) : json_number_value(value);
    assert_true(number == trax_config_value(&machine->config, &trax_config_keys[i]));
  }
  json_decref(root);
  trax_machine_destroy(machine);
}

static void test_statistics_before_a_run(void **state) {
  (void)state;
  trax_machine *machine = load("hello");
  trax_error error;
  assert_true(figure(machine, "mrps") == 0); /* 0/0 */
  assert_int_equal(trax_stats_write_json(machine, file_name, &error), TRAX_ERROR);
  expect_message(&error, "the machine has not run");
  trax_machine_destroy(machine);
}

/* --- faults --- */

static char *fault_report(trax_machine *machine) {
  char *text;
  size_t size;
  FILE *memory = open_memstream(&text, &size);
  trax_machine_print_fault(machine, memory);
  fclose(memory);
  return text;
}

static void expect_in_report(const char *report, const char *part) {
  if (!strstr(report, part))
    fail_msg("the report lacks \"%s\":\n%s", part, report);
}

static void test_energy_of_caches(void **state) {
  (void)state;
  static const struct {
    uint32_t bytes, banks;
    double nj;
  } cases[] = {{16384, 4, 0.134578},
               {16384, 8, 0.204198},
               {16384, 6, (0.134578 + 0.204198) / 2},
               {4096, 3, (0.119011 + 0.111004) / 2},
               {8388608, 64, 2.227535},
               {64, 1, 0.057617},       /* below the table */
               {16777216, 1, 2.171381}, /* above it */
               {1024, 64, 0.105809},    /* more banks than it has at this size */
               {32768, 64, 0.590784}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    assert_true(fabs(trax_energy_of_cache(cases[i].bytes, cases[i].banks) - cases[i].nj) < 1e-12);

  struct trax_config config = TRAX_CONFIG_DEFAULT;
  struct trax_stats stats = {0};
  assert_true(trax_energy_of(&stats, &config).total == 0);
  stats.total.icache_hits = 1000000000; /* so that J are what nJ are for each */
  assert_true(fabs(trax_energy_of(&stats, &config).total - 0.013490) < 1e-9);
  config.icache.banks = 48;
  assert_true(fabs(trax_energy_of(&stats, &config).total - (0.015138 + 0.016584) / 2) < 1e-9);
  config.icache.banks = 16;
  config.icache.bytes = 16384;
  assert_true(fabs(trax_energy_of(&stats, &config).total - 0.013490 * 0.126381 / 0.072368) < 1e-9);
}

static void test_report_of_a_fault(void **state) {
  (void)state;
  trax_machine *machine = load("null");
  trax_error error;
  assert_int_equal(trax_machine_run(machine, NULL, &error), TRAX_FAULT);
  assert_int_equal(trax_machine_exit_status(machine), 1);
  char *report = fault_report(machine);
  expect_in_report(report, "fault: access to the null page\n");
  expect_in_report(report, "load of 4 bytes from 0x00000008\n");
  expect_in_report(report, "0x00001008");
  expect_in_report(report, "lw ");
  expect_in_report(report, "outer+0x8, inner at dir/source.c:5:3\n");
  expect_in_report(report, "inlined into outer at dir/source.c:12\n");
  expect_in_report(report, "0 (TM 0, TP 0), cycle ");
  expect_in_report(report, "r5  a1   00000008");
  expect_in_report(report, "r31 s11  00000000\n");
  free(report);

  assert_int_equal(trax_stats_write_json(machine, file_name, &error), TRAX_OK);
  json_t *root = json_load_file(file_name, JSON_REJECT_DUPLICATES, NULL);
  assert_string_equal(json_string_value(json_object_get(root, "status")), "fault");
  assert_true(json_is_true(json_object_get(root, "partial")));
  assert_int_equal(json_integer_value(json_object_get(root, "exit_status")), 1);
  assert_string_equal(json_string_value(at_path(root, "fault.kind")), "access to the null page");
  assert_string_equal(json_string_value(at_path(root, "fault.address")), "0x00000008");
  assert_string_equal(json_string_value(at_path(root, "fault.pc")), "0x00001008");
  assert_string_equal(json_string_value(at_path(root, "fault.symbol")), "outer");
  assert_string_equal(json_string_value(at_path(root, "fault.file")), "dir/source.c");
  assert_int_equal(json_integer_value(at_path(root, "fault.line")), 5);
  json_decref(root);
  trax_machine_destroy(machine);
}

static void test_report_of_an_abort(void **state) {
  (void)state;
  trax_machine *machine = load("abort");
  assert_int_equal(trax_machine_run(machine, NULL, NULL), TRAX_FAULT);
  assert_int_equal(trax_machine_exit_status(machine), 134);
  char *report = fault_report(machine);
  expect_in_report(report, "fault: abort\n  message     out of luck\n");
  expect_in_report(report, "outer+0x4 at dir/source.c:11:3\n");
  free(report);
  assert_int_equal(trax_stats_write_json(machine, file_name, NULL), TRAX_OK);
  json_t *root = json_load_file(file_name, JSON_REJECT_DUPLICATES, NULL);
  assert_string_equal(json_string_value(at_path(root, "fault.message")), "out of luck\n");
  assert_int_equal(json_integer_value(json_object_get(root, "exit_status")), 134);
  json_decref(root);
  trax_machine_destroy(machine);
}

/* The program `null` with other instructions, run to its fault. */
static char *report_of(const uint32_t *words, size_t count) {
  struct elf_file file = program_file("null");
  memcpy(file.bytes + elf_section(&file, ".text")->sh_offset, words, count * 4);
  elf_save(file_name, &file);
  free(file.bytes);
  trax_config *config = trax_config_create();
  trax_config_set(config, "memory.size_mib", "4", NULL);
  trax_machine *machine = trax_machine_create(config, NULL);
  assert_int_equal(trax_machine_load_elf(machine, file_name, NULL), TRAX_OK);
  assert_int_equal(trax_machine_run(machine, NULL, NULL), TRAX_FAULT);
  char *report = fault_report(machine);
  trax_machine_destroy(machine);
  trax_config_destroy(config);
  return report;
}

#define REPORT(...) report_of((const uint32_t[]){__VA_ARGS__}, sizeof((const uint32_t[]){__VA_ARGS__}) / 4)

static void test_reports_of_other_faults(void **state) {
  (void)state;
  enum { A0 = 4, RA = 1, SP = 2 };
  struct {
    char *report;
    const char *parts[3];
  } cases[] = {
      {REPORT(U(LUI, A0, 0x40), S(SH, 0, A0, 6)),
       {"neither global nor local memory", "store of 2 bytes to 0x00400006; memory ends at 0x00400000"}},
      {REPORT(I(ADDI, SP, 0, -640), S(SB, 0, SP, 1)),
       {"stack overflow", "store of 1 byte to 0xfffffd81", "sp is 0xfffffd80"}},
      {REPORT(U(LUI, A0, 1), I(LW, 0, A0, 2)), {"misaligned access", "load of 4 bytes from 0x00010002", "(text+0x2)"}},
      {REPORT(I(ADDI, A0, 0, 0x1004), S(SW, 0, A0, 0)),
       {"write to read-only memory", "store of 4 bytes to 0x00001004 (outer+0x4)"}},
      {REPORT(0xFFFFFFFF), {"illegal instruction", "ffffffff", "outer at dir/source.c:10:3"}},
      {REPORT(I(ADDI, 0, 0, 0), I(JALR, RA, 0, 0x2000)), {"execution outside the program's text", "0x00002000"}},
      {REPORT(I(ADDI, RA, 0, 0x1004), I(LW, 0, 0, 0)),
       {"access to the null page", "ra behind   outer at dir/source.c:10:3"}},
      {REPORT(I(ADDI, A0, 0, 0x10), T(A0, TRAX_TRAP_ABORT)), {"fault: abort", "(no string at 0x00000010)"}},
      {REPORT(T(0, TRAX_TRAP_ABORT), HALT, HALT, HALT), {"fault: abort\n  at "}},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    for (size_t j = 0; j < 3 && cases[i].parts[j]; ++j)
      expect_in_report(cases[i].report, cases[i].parts[j]);
    free(cases[i].report);
  }
}

static void test_no_fault_no_report(void **state) {
  (void)state;
  trax_machine *machine = load("exit3");
  assert_int_equal(trax_machine_run(machine, NULL, NULL), TRAX_OK);
  assert_int_equal(trax_machine_exit_status(machine), 3);
  char *report = fault_report(machine);
  assert_string_equal(report, "");
  free(report);
  trax_machine_destroy(machine);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_buffers_are_placed_behind_the_image),
      cmocka_unit_test(test_buffers_end_at_guards),
      cmocka_unit_test(test_large_counts),
      cmocka_unit_test(test_buffers_that_cannot_be),
      cmocka_unit_test(test_files_as_buffers),
      cmocka_unit_test(test_loading_twice_or_too_large),
      cmocka_unit_test(test_names_are_a_tree),
      cmocka_unit_test(test_counts_of_a_known_program),
      cmocka_unit_test(test_json_says_the_same),
      cmocka_unit_test(test_statistics_before_a_run),
      cmocka_unit_test(test_energy_of_caches),
      cmocka_unit_test(test_report_of_a_fault),
      cmocka_unit_test(test_report_of_an_abort),
      cmocka_unit_test(test_reports_of_other_faults),
      cmocka_unit_test(test_no_fault_no_report),
  };
  file_name = test_path("program");
  return cmocka_run_group_tests(tests, NULL, NULL);
}
