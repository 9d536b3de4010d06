/* Configurations: every key, every way in and out. */
#define _GNU_SOURCE /* memfd_create */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include <cmocka.h>

#include "host/dram_presets.h"
#include "machine/config.h"

/* A file in memory: thousands of versions of it are written. */
static char file_name[64];

static void write_file(const char *text, size_t size) {
  FILE *file = fopen(file_name, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(text, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
}

static void expect_message(const trax_error *error, const char *part) {
  if (!strstr(error->message, part))
    fail_msg("the message \"%s\" lacks \"%s\"", error->message, part);
}

static void assert_same(const trax_config *a, const trax_config *b) {
  for (size_t i = 0; i < trax_config_key_count; ++i) {
    const struct trax_config_key *key = &trax_config_keys[i];
    if (trax_config_value(a, key) != trax_config_value(b, key))
      fail_msg("%s: %.17g and %.17g", key->name, trax_config_value(a, key), trax_config_value(b, key));
  }
}

static void assert_round_trip(const trax_config *config) {
  char *text = NULL;
  size_t size;
  FILE *memory = open_memstream(&text, &size);
  trax_config_print(config, memory);
  assert_int_equal(fclose(memory), 0);
  assert_null(strstr(text, "e+")); /* 20.0, not 2e+01 */
  write_file(text, size);
  free(text);
  trax_config *loaded = trax_config_create();
  trax_error error;
  if (trax_config_load(loaded, file_name, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  assert_same(config, loaded);
  trax_config_destroy(loaded);
}

static void set_number(trax_config *config, const struct trax_config_key *key, double value) {
  char text[TRAX_CONFIG_WORD], word[TRAX_CONFIG_WORD];
  trax_error error;
  if (key->kind == TRAX_KIND_FLAG)
    snprintf(text, sizeof text, "%s", value != 0 ? "true" : "false");
  else if (trax_config_has_words(key))
    snprintf(text, sizeof text, "%s", trax_config_value_word(key, value, word));
  else
    snprintf(text, sizeof text, "%.17g", value);
  if (trax_config_set(config, key->name, text, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  assert_true(trax_config_value(config, key) == value);
}

/* Both ends of each range are allowed, set that key alone, and survive printing. */
static void test_every_key_at_its_limits(void **state) {
  (void)state;
  assert_true(trax_config_key_count >= 30);
  for (size_t i = 0; i < trax_config_key_count; ++i) {
    const struct trax_config_key *key = &trax_config_keys[i];
    const bool mapping = key->kind == TRAX_KIND_MAPPING; /* most numbers in its range are none */
    const double values[] = {mapping ? TRAX_DRAM_ROW : key->least, mapping ? TRAX_DRAM_ROW : key->most, key->initial};
    for (size_t j = 0; j < 3; ++j) {
      trax_config *config = trax_config_create(), *expected = trax_config_create();
      set_number(config, key, values[j]);
      for (size_t k = 0; k < trax_config_key_count; ++k)
        if (k != i)
          assert_true(trax_config_value(config, &trax_config_keys[k]) ==
                      trax_config_value(expected, &trax_config_keys[k]));
      assert_round_trip(config);
      trax_config_destroy(config);
      trax_config_destroy(expected);
    }
  }
}

static void refuse(const char *key, const char *value, const char *message) {
  trax_config *config = trax_config_create(), *before = trax_config_create();
  trax_error error = {.message = ""};
  if (trax_config_set(config, key, value, &error) != TRAX_ERROR)
    fail_msg("%s = %s is accepted", key, value);
  expect_message(&error, key);
  expect_message(&error, message);
  assert_same(config, before);
  trax_config_destroy(config);
  trax_config_destroy(before);
}

static void test_every_key_beyond_its_limits(void **state) {
  (void)state;
  for (size_t i = 0; i < trax_config_key_count; ++i) {
    const struct trax_config_key *key = &trax_config_keys[i];
    if (key->kind == TRAX_KIND_FLAG) {
      refuse(key->name, "2", "allowed are true and false");
      refuse(key->name, "maybe", "allowed are true and false");
      continue;
    }
    if (key->kind == TRAX_KIND_POLICY) {
      refuse(key->name, "mru", "allowed are fifo, lru");
      refuse(key->name, "0", "allowed are fifo, lru");
      refuse(key->name, "true", "allowed are fifo, lru");
      continue;
    }
    if (trax_config_has_words(key)) {
      static const char *const wrong[] = {"", "0", "true", "row:", "limits"};
      for (size_t j = 0; j < sizeof wrong / sizeof *wrong; ++j)
        refuse(key->name, wrong[j], key->kind == TRAX_KIND_MODEL ? "allowed are limit, dram" : "allowed are row, rank");
      continue;
    }
    const double step = key->kind == TRAX_KIND_REAL ? 0.001 : 1;
    char text[64], limit[64];
    snprintf(text, sizeof text, "%.17g", key->least - step);
    snprintf(limit, sizeof limit, "%.12g", key->least);
    refuse(key->name, text, limit);
    snprintf(text, sizeof text, "%.17g", key->most + step);
    snprintf(limit, sizeof limit, "%.12g", key->most);
    refuse(key->name, text, limit);
    static const char *const nonsense[] = {"",     "x",     "1x",  " 1",    "1 ",   "nan",     "inf",
                                           "-inf", "1e999", "--1", "4.5.6", "true", "infinity"};
    for (size_t j = 0; j < sizeof nonsense / sizeof *nonsense; ++j)
      refuse(key->name, nonsense[j], "allowed are");
    if (key->kind == TRAX_KIND_POWER)
      refuse(key->name, "96", "powers of two");
    if (key->kind == TRAX_KIND_COUNT)
      refuse(key->name, "1.5", "without a fraction");
  }
  refuse("memory.bandwidth_gbps", "8.0001", "multiples of 0.001");
}

static void test_flags_and_numbers_as_text(void **state) {
  (void)state;
  trax_config *config = trax_config_create();
  static const char *const yes[] = {"true", "yes", "on", "1"}, *const no[] = {"false", "no", "off", "0"};
  for (size_t i = 0; i < 4; ++i) {
    assert_int_equal(trax_config_set(config, "special.pipelined", yes[i], NULL), TRAX_OK);
    assert_true(config->special.pipelined);
    assert_int_equal(trax_config_set(config, "special.pipelined", no[i], NULL), TRAX_OK);
    assert_false(config->special.pipelined);
  }
  assert_int_equal(trax_config_set(config, "memory.size_mib", "0x200", NULL), TRAX_OK);
  assert_int_equal(config->memory.size_mib, 512);
  assert_int_equal(trax_config_set(config, "memory.size_mib", "1e3", NULL), TRAX_OK);
  assert_int_equal(config->memory.size_mib, 1000);
  trax_config_destroy(config);
}

static void test_values_by_name(void **state) {
  (void)state;
  trax_config *config = trax_config_create();
  assert_null(trax_config_next_change(config, NULL));
  assert_int_equal(trax_config_set(config, "special.pipelined", config->special.pipelined ? "false" : "true", NULL), 0);
  assert_int_equal(trax_config_set(config, "chip.tms", "4", NULL), TRAX_OK);
  trax_config *copy = trax_config_copy(config);
  assert_int_equal(trax_config_set(config, "chip.tms", "2", NULL), TRAX_OK);
  assert_true(trax_config_get(copy, "chip.tms") == 4);
  assert_true(trax_config_get(copy, "special.pipelined") == copy->special.pipelined);
  assert_true(isnan(trax_config_get(copy, "chip.tns")));
  assert_string_equal(trax_config_word(copy, "dcache.replacement"), "fifo");
  assert_string_equal(trax_config_word(copy, "l2.replacement"), "lru");
  assert_null(trax_config_word(copy, "chip.tms"));
  const char *first = trax_config_next_change(copy, NULL);
  assert_string_equal(first, "chip.tms");
  assert_string_equal(trax_config_next_change(copy, first), "special.pipelined");
  assert_null(trax_config_next_change(copy, "special.pipelined"));
  trax_config_destroy(copy);
  trax_config_destroy(config);
}

static void test_unknown_keys_get_a_suggestion(void **state) {
  (void)state;
  refuse("memory.bandwith_gbps", "8", "did you mean memory.bandwidth_gbps?");
  refuse("chip.mts", "8", "did you mean chip.tms?");
  refuse("dcache.line_byte", "8", "did you mean dcache.line_bytes?");
  refuse("precision_bits", "8", "did you mean special.precision_bits?");
  refuse("", "8", "unknown key");
  refuse("entirely.different", "8", "--help-config");
}

/* xorshift64*: the same numbers everywhere. */
static uint64_t random_state = 88172645463325252u;
static uint64_t next_random(void) {
  random_state ^= random_state >> 12;
  random_state ^= random_state << 25;
  random_state ^= random_state >> 27;
  return random_state * 2685821657736338717u;
}

static void test_random_configurations_round_trip(void **state) {
  (void)state;
  for (int trial = 0; trial < 200; ++trial) {
    trax_config *config = trax_config_create();
    for (size_t i = 0; i < trax_config_key_count; ++i) {
      const struct trax_config_key *key = &trax_config_keys[i];
      double fraction = (double)(next_random() >> 11) / 9007199254740992.0;
      double value = key->least + fraction * (key->most - key->least);
      if (key->kind == TRAX_KIND_MAPPING)
        value = TRAX_DRAM_PART(0, 1 + next_random() % 5, next_random() % 16) +
                TRAX_DRAM_PART(1, 1 + next_random() % 5, next_random() % 16);
      else if (key->kind == TRAX_KIND_POWER)
        value = key->least == 0 && next_random() % 2
                    ? 0
                    : exp2(floor(log2(fmax(key->least, 1)) + fraction * (log2(key->most) - log2(fmax(key->least, 1)))));
      else
        value = key->kind == TRAX_KIND_REAL ? round(value * 1000) / 1000 : floor(value);
      set_number(config, key, value);
    }
    assert_round_trip(config);
    trax_config_destroy(config);
  }
}

/* The paper's Tables 1 and 2: name, TMs, TPs of a TM, mm2, peak GFLOPS. */
static const struct {
  const char *name;
  unsigned tms, tps;
  double area, peak_gflops;
} paper[] = {{"1x32", 1, 32, 1.9, 4},   {"1x48", 1, 48, 2.5, 6},   {"2x32", 2, 32, 3.8, 8},   {"1x64", 1, 64, 3.2, 8},
             {"2x48", 2, 48, 5.1, 12},  {"4x32", 4, 32, 7.6, 16},  {"2x64", 2, 64, 6.3, 16},  {"6x32", 6, 32, 11.4, 24},
             {"4x48", 4, 48, 10.1, 24}, {"8x32", 8, 32, 15.2, 32}, {"4x64", 4, 64, 12.6, 32}, {"6x48", 6, 48, 15.2, 36},
             {"8x48", 8, 48, 20.2, 48}, {"6x64", 6, 64, 18.9, 48}, {"8x64", 8, 64, 25.3, 64}};
enum { PAPER = sizeof paper / sizeof *paper };

static void test_presets_are_the_papers_chips(void **state) {
  (void)state;
  const char *const *names = trax_config_presets();
  for (size_t i = 0; i < PAPER; ++i) {
    assert_string_equal(names[i], paper[i].name);
    trax_config *config = trax_config_create(), *expected = trax_config_create();
    assert_int_equal(trax_config_set(config, "memory.latency_cycles", "7", NULL), TRAX_OK); /* a preset is everything */
    assert_int_equal(trax_config_preset(config, paper[i].name, NULL), TRAX_OK);
    expected->chip.tms = paper[i].tms;
    expected->chip.tps_per_tm = paper[i].tps;
    assert_same(config, expected);
    assert_int_equal(trax_config_check(config, NULL), TRAX_OK);
    assert_round_trip(config);

    trax_machine *machine = trax_machine_create(config, NULL);
    assert_non_null(machine);
    double value;
    assert_true(trax_stats_get(machine, "area_mm2", &value));
    assert_true(fabs(value - paper[i].area) < 0.07); /* Table 1 has one decimal, and the fit is as good as that */
    assert_true(trax_stats_get(machine, "peak_gflops", &value));
    assert_true(fabs(value - paper[i].peak_gflops) < 1e-9);
    trax_machine_destroy(machine);
    trax_config_destroy(config);
    trax_config_destroy(expected);
  }
  assert_null(names[PAPER]);
}

/* docs: what the paper fixes, in numbers. */
static void test_defaults_are_the_papers(void **state) {
  (void)state;
  trax_config *config = trax_config_create();
  assert_int_equal(config->chip.tms * config->chip.tps_per_tm, 1); /* an ordinary program runs once */
  assert_int_equal(config->chip.clock_mhz, 500);
  assert_int_equal(config->icache.bytes, 4096);
  assert_int_equal(config->icache.banks, 16);
  assert_int_equal(config->icache.tps_per_cache, 16);
  assert_int_equal(config->fpu.tps_per_cluster, 8);
  assert_int_equal(config->special.units_per_tm, 1);
  assert_int_equal(config->special.latency_cycles, 8);
  assert_int_equal(config->dcache.bytes, 16384);
  assert_int_equal(config->dcache.tps_per_bank, 8);
  assert_true(config->memory.bandwidth_gbps == 8);
  trax_config_destroy(config);
}

static void load_text(const char *text, size_t size, const char *message) {
  write_file(text, size);
  trax_config *config = trax_config_create(), *before = trax_config_create();
  trax_error error = {.message = ""};
  if (trax_config_load(config, file_name, &error) != TRAX_ERROR)
    fail_msg("accepted: %s", text);
  expect_message(&error, file_name);
  expect_message(&error, message);
  assert_same(config, before);
  trax_config_destroy(config);
  trax_config_destroy(before);
}

static void test_bad_files(void **state) {
  (void)state;
  static const struct {
    const char *text, *message;
  } files[] = {
      {"chip: {\n  tms = 0;\n};", ":2: chip.tms is 0; allowed are 1 to 64 TMs"},
      {"chip: {\n\n  tms = 65;\n};", ":3: chip.tms is 65; allowed are 1 to 64"},
      {"chip: { tms = 2.5; };", ":1: chip.tms is 2.5; allowed are 1 to 64 TMs, without a fraction"},
      {"chip: { tms = \"4\"; };", ":1: chip.tms is \"4\", a string; allowed are 1 to 64 TMs"},
      {"chip: { tms = true; };", "chip.tms is true; allowed are 1 to 64 TMs"},
      {"chip: { tms = [1, 2]; };", "chip.tms is a list"},
      {"chip: { tms = (); };", "chip.tms is a list"},
      {"chip: { tms = { a = 1; }; };", "chip.tms is a component"},
      {"chip: { tps = 4; };", "unknown key \"chip.tps\""},
      {"chip = 4;", "chip is 4; it must be a component"},
      {"tms = 4;", "did you mean chip.tms?"},
      {"chips: { tms = 4; };", ":1: unknown component \"chips\"; did you mean chip?"},
      {"nonsense: { };", "unknown component \"nonsense\""},
      {"special: { pipelined = 1; };", "special.pipelined is 1; allowed are true and false"},
      {"special: { pipelined = \"yes\"; };", "special.pipelined is \"yes\", a string; allowed are true and false"},
      {"icache: { bytes = 3000; };", "powers of two"},
      {"memory: { bandwidth_gbps = 0.0; };", "from 0.001 to 1000000 GB/s"},
      {"memory: { bandwidth_gbps = 1e400; };", "larger than any key allows"},
      {"chip: {\n tms = 4294967297; };", ":2: tms is 4294967297, larger than any key allows"},
      {"/* a\n comment */ chip: {\n tms = 0x100000001; };", ":3: tms is 0x100000001, larger"},
      {"chip: { tms = 18446744073709551617L; };", "larger than any key allows"},
      {"preset = \"4x33\";", ":1: no preset \"4x33\" (did you mean"},
      {"\npreset = 4;", ":2: preset is 4; it must be a string"},
      {"chip: { tms = 4; tms = 5; };", ":1: duplicate"},
      {"chip: { tms = ", ":1: syntax error"},
      {"chip: {\n tms = 4\n }}", ":3: syntax error"},
      {"\n@include \"/\"\n", ":2: directives such as @include are not supported"},
      {"}", "syntax error"},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; ++i)
    load_text(files[i].text, strlen(files[i].text), files[i].message);
  load_text("chip\0", 5, ":1: not a text file");
  char deep[3 * 20000 + 1];
  for (size_t i = 0; i < sizeof deep - 1; i++)
    deep[i] = "a:{"[i % 3];
  load_text(deep, sizeof deep - 1, ":1: components are nested too deeply");
  char *large = malloc(2 << 20);
  memset(large, ' ', 2 << 20);
  load_text(large, 2 << 20, "more than 1048576 bytes");
  memset(large, '(', 100000);
  load_text(large, 100000, "");
  free(large);
}

static void test_former_names(void **state) {
  (void)state;
  refuse("dcache.lru", "true", "did you mean dcache.replacement?");
  refuse("l2.lru", "true", "did you mean l2.replacement?");
  load_text("\ndcache: { lru = true; };", 24, ":2: unknown key \"dcache.lru\"; did you mean dcache.replacement?");
}

/* Gives every key in a file a value of another type, one out of range, one that is no power of two, and a fraction, and
   writes its name wrong. */
static void test_every_key_wrong_in_a_file(void **state) {
  (void)state;
  for (size_t i = 0; i < trax_config_key_count; ++i) {
    const struct trax_config_key *key = &trax_config_keys[i];
    const bool flag = key->kind == TRAX_KIND_FLAG, real = key->kind == TRAX_KIND_REAL;
    const bool word = trax_config_has_words(key);
    const char *const values[] = {"\"x\"",
                                  "[1]",
                                  "(1)",
                                  "{ a = 1; }",
                                  flag ? "1" : "true",
                                  flag ? "0" : "-1",
                                  flag   ? "2.5"
                                  : real ? "0.0004"
                                         : "7.25",
                                  key->kind == TRAX_KIND_POWER ? "96" : "2147483647"};
    for (size_t j = 0; j < sizeof values / sizeof *values; ++j) {
      char text[256], place[128];
      const int length =
          snprintf(text, sizeof text, "# %s\n%s: {\n  %s = %s;\n};\n", key->unit, key->component, key->key, values[j]);
      snprintf(place, sizeof place, ":3: %s is %.4s", key->name,
               *values[j] == '"'           ? "\"x\""
               : strchr("[({", *values[j]) ? "a"
                                           : values[j]);
      load_text(text, (size_t)length, place);
      load_text(text, (size_t)length,
                flag   ? "; allowed are true and false"
                : word ? (key->kind == TRAX_KIND_POLICY  ? "; allowed are fifo, lru"
                          : key->kind == TRAX_KIND_MODEL ? "; allowed are limit, dram"
                                                         : "; allowed are row, rank, bank")
                       : "; allowed are ");
    }
    char text[256], suggestion[128];
    const int length = snprintf(text, sizeof text, "\n%s: { %sx = 1; };", key->component, key->key);
    snprintf(suggestion, sizeof suggestion, ":2: unknown key \"%s.%sx\"; did you mean %s?", key->component, key->key,
             key->name);
    load_text(text, (size_t)length, suggestion);
  }
}

static void test_missing_files(void **state) {
  (void)state;
  trax_config *config = trax_config_create();
  trax_error error;
  assert_int_equal(trax_config_load(config, "/nonexistent/x.cfg", &error), TRAX_ERROR);
  expect_message(&error, "/nonexistent/x.cfg: cannot be read: No such file or directory");
  assert_int_equal(trax_config_load(config, "/", &error), TRAX_ERROR);
  expect_message(&error, "/: cannot be read: Is a directory");
  assert_int_equal(trax_config_load(config, "4x23", &error), TRAX_ERROR);
  expect_message(&error, "no file and no preset \"4x23\" (did you mean 4x");
  trax_config_destroy(config);
}

static void test_good_files(void **state) {
  (void)state;
  const char *text = "# faster memory\nmemory: { bandwidth_gbps = 16; size_mib = 0x400; };\n"
                     "preset = \"8x48\"; /* wherever it stands */\nspecial = { pipelined = TRUE; };\n"
                     "fpu: { mul_latency_cycles = 3.0; }; // a whole number\n";
  write_file(text, strlen(text));
  trax_config *config = trax_config_create(), *expected = trax_config_create();
  trax_error error;
  if (trax_config_load(config, file_name, &error) != TRAX_OK)
    fail_msg("%s", error.message);
  expected->chip.tms = 8;
  expected->chip.tps_per_tm = 48;
  expected->memory.bandwidth_gbps = 16;
  expected->special.pipelined = true;
  expected->fpu.mul_latency_cycles = 3;
  assert_same(config, expected);
  write_file("", 0); /* nothing said: the defaults */
  assert_int_equal(trax_config_load(config, file_name, &error), TRAX_OK);
  trax_config_preset(expected, "1x32", NULL);
  expected->chip.tps_per_tm = 1;
  assert_same(config, expected);
  trax_config_destroy(config);
  trax_config_destroy(expected);
}

static void test_relations_between_keys(void **state) {
  (void)state;
  static const struct {
    const char *key, *value, *message;
  } cases[] = {{"dcache.ways", "64", NULL},
               {"dcache.line_bytes", "4096", "dcache.bytes is 16384; it must hold dcache.ways = 64 lines"},
               {"icache.bytes", "64", NULL},
               {"icache.line_bytes", "128", "icache.bytes is 64"}};
  trax_error error;
  for (size_t i = 0; i < 4; i += 2) {
    trax_config *config = trax_config_create();
    for (size_t j = 0; j < 2; ++j)
      assert_int_equal(trax_config_set(config, cases[i + j].key, cases[i + j].value, &error), TRAX_OK);
    assert_int_equal(trax_config_check(config, &error), TRAX_ERROR);
    expect_message(&error, cases[i + 1].message);
    assert_null(trax_machine_create(config, &error));
    expect_message(&error, cases[i + 1].message);
    trax_config_destroy(config);
  }
}

/* With memory.model = dram; without it none of this matters. */
static void test_relations_of_dram(void **state) {
  (void)state;
  static const struct {
    const char *key, *value, *message;
  } cases[] = {{"memory.channels", "3", "memory.channels is 3; with memory.model = dram it must be a power of two"},
               {"dram.batch_from", "33", "dram.batch_from is 33; it must not be more than dram.writes = 32"},
               {"dram.batch_to", "24", "dram.batch_to is 24; it must be less than dram.batch_from = 24"},
               {"dram.trefi", "104", "dram.trefi is 104; it must be 0 or more than dram.trfc = 104"},
               {"dram.row_bytes", "64", "dram.mapping is \"row:rank:bank:column:channel:column3\"; column has 1 bits"},
               {"dram.mapping", "bank:row:rank:channel:column", NULL},
               {"dram.mapping", "column:row:rank:bank:channel", "32 bytes lie together"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    trax_config *config = trax_config_create();
    trax_error error = {.message = ""};
    assert_int_equal(trax_config_set(config, cases[i].key, cases[i].value, &error), TRAX_OK);
    assert_int_equal(trax_config_check(config, &error), TRAX_OK);
    assert_int_equal(trax_config_set(config, "memory.model", "dram", &error), TRAX_OK);
    if (cases[i].message) {
      assert_int_equal(trax_config_check(config, &error), TRAX_ERROR);
      expect_message(&error, cases[i].message);
    } else {
      assert_int_equal(trax_config_check(config, &error), TRAX_OK);
    }
    trax_config_destroy(config);
  }
}

static void test_presets_of_dram(void **state) {
  (void)state;
  static const struct {
    const char *name;
    double gbps;
  } presets[] = {{"lpddr2-1066", 8.528}, {"lpddr3-1600", 12.8}, {"lpddr4-3200", 25.6}};
  trax_config *config = trax_config_create();
  trax_error error;
  for (size_t i = 0; i < 3; ++i) {
    char text[128];
    const int length =
        snprintf(text, sizeof text, "dram: { cap = 3; preset = \"%s\"; trcd = 77; };\nmemory: { model = \"dram\"; };",
                 presets[i].name);
    write_file(text, (size_t)length);
    assert_int_equal(trax_config_load(config, file_name, &error), TRAX_OK);
    assert_int_equal(trax_config_check(config, &error), TRAX_OK);
    assert_true(trax_memory_gbps(config) == presets[i].gbps);
    assert_int_equal(config->dram.trcd, 77); /* it comes after the preset */
    assert_int_equal(config->dram.cap, 16);
    assert_round_trip(config);
  }
  refuse("dram.preset", "lpddr3-160",
         "(did you mean lpddr3-1600?); allowed are lpddr2-1066, lpddr3-1600 and lpddr4-3200");
  load_text("\ndram: { preset = 5; };", 22, ":2: dram.preset is \"5\"");
  /* The message has as many names as there are presets. */
  char *described = NULL, *rest = NULL;
  size_t size;
  FILE *out = open_memstream(&described, &size);
  trax_dram_presets_describe(out);
  fclose(out);
  for (char *line = strtok_r(described, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
    refuse("dram.preset", "none", strtok(line, " "));
  free(described);
  trax_config_destroy(config);
}

/* Every file made by cutting or damaging a good one is read or refused, never anything worse. */
static void test_damaged_files(void **state) {
  (void)state;
  trax_config *config = trax_config_create();
  char *text;
  size_t size;
  FILE *memory = open_memstream(&text, &size);
  trax_config_print(config, memory);
  fclose(memory);
  for (size_t i = 0; i < size; i += 7) {
    trax_error error = {.message = ""};
    write_file(text, i);
    if (trax_config_load(config, file_name, &error) != TRAX_OK)
      expect_message(&error, file_name);
    char before = text[i];
    text[i] = (char)(next_random() % 255 + 1);
    write_file(text, size);
    if (trax_config_load(config, file_name, &error) != TRAX_OK)
      expect_message(&error, file_name);
    text[i] = before;
  }
  free(text);
  trax_config_destroy(config);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_every_key_at_its_limits),
      cmocka_unit_test(test_every_key_beyond_its_limits),
      cmocka_unit_test(test_flags_and_numbers_as_text),
      cmocka_unit_test(test_values_by_name),
      cmocka_unit_test(test_unknown_keys_get_a_suggestion),
      cmocka_unit_test(test_former_names),
      cmocka_unit_test(test_random_configurations_round_trip),
      cmocka_unit_test(test_presets_are_the_papers_chips),
      cmocka_unit_test(test_defaults_are_the_papers),
      cmocka_unit_test(test_bad_files),
      cmocka_unit_test(test_every_key_wrong_in_a_file),
      cmocka_unit_test(test_missing_files),
      cmocka_unit_test(test_good_files),
      cmocka_unit_test(test_relations_between_keys),
      cmocka_unit_test(test_relations_of_dram),
      cmocka_unit_test(test_presets_of_dram),
      cmocka_unit_test(test_damaged_files),
  };
  int descriptor = memfd_create("test", 0);
  if (descriptor < 0)
    return 1;
  snprintf(file_name, sizeof file_name, "/proc/self/fd/%d", descriptor);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
