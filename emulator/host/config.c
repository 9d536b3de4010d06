/* Presets, and configurations as text. machine/config_keys.h declares the keys. */
#include "host/config.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host/dram_presets.h"
#include "trax/names.h"

/* The chips of the paper's Table 2, in its order. */
#define PAPER_CHIPS(X)                                                                                                 \
  X("1x32", 1, 32)                                                                                                     \
  X("1x48", 1, 48)                                                                                                     \
  X("2x32", 2, 32)                                                                                                     \
  X("1x64", 1, 64)                                                                                                     \
  X("2x48", 2, 48)                                                                                                     \
  X("4x32", 4, 32)                                                                                                     \
  X("2x64", 2, 64)                                                                                                     \
  X("6x32", 6, 32)                                                                                                     \
  X("4x48", 4, 48)                                                                                                     \
  X("8x32", 8, 32)                                                                                                     \
  X("4x64", 4, 64)                                                                                                     \
  X("6x48", 6, 48)                                                                                                     \
  X("8x48", 8, 48)                                                                                                     \
  X("6x64", 6, 64)                                                                                                     \
  X("8x64", 8, 64)

#define CHIP(NAME, TMS, TPS) {NAME, TMS, TPS},
static const struct {
  const char *name;
  uint32_t tms, tps_per_tm;
} presets[] = {PAPER_CHIPS(CHIP)};
enum { PRESETS = sizeof presets / sizeof *presets };

#define CHIP_NAME(NAME, TMS, TPS) NAME,
static const char *const preset_names[] = {PAPER_CHIPS(CHIP_NAME) NULL};

trax_config *trax_config_create(void) {
  trax_config *config = malloc(sizeof *config);
  if (config)
    *config = (trax_config)TRAX_CONFIG_DEFAULT;
  return config;
}

trax_config *trax_config_copy(const trax_config *config) {
  trax_config *copy = malloc(sizeof *copy);
  if (copy)
    *copy = *config;
  return copy;
}

void trax_config_destroy(trax_config *config) {
  free(config);
}

trax_status trax_config_check(const trax_config *config, trax_error *error) {
  return trax_config_validate(config, error);
}

/* --- presets --- */

static const char *preset_name(const void *context, size_t i) {
  (void)context;
  return presets[i].name;
}

const char *const *trax_config_presets(void) {
  return preset_names;
}

bool trax_config_is_preset(const char *name) {
  for (size_t i = 0; i < PRESETS; ++i)
    if (strcmp(presets[i].name, name) == 0)
      return true;
  return false;
}

static trax_status find_preset(const char *name, size_t *index, trax_error *error) {
  for (*index = 0; *index < PRESETS; ++*index)
    if (strcmp(presets[*index].name, name) == 0)
      return TRAX_OK;
  const char *nearest = trax_nearest_name(name, PRESETS, preset_name, NULL);
  return trax_fail(error, "no preset \"%s\"%s%s%s; presets are the paper's chips, %s to %s", name,
                   nearest ? " (did you mean " : "", nearest ? nearest : "", nearest ? "?)" : "", presets[0].name,
                   presets[PRESETS - 1].name);
}

trax_status trax_config_preset(trax_config *config, const char *name, trax_error *error) {
  size_t index;
  if (find_preset(name, &index, error) != TRAX_OK)
    return TRAX_ERROR;
  *config = (trax_config)TRAX_CONFIG_DEFAULT;
  config->chip.tms = presets[index].tms;
  config->chip.tps_per_tm = presets[index].tps_per_tm;
  return TRAX_OK;
}

trax_status trax_config_load(trax_config *config, const char *preset_or_path, trax_error *error) {
  trax_error reason;
  if (trax_config_preset(config, preset_or_path, &reason) == TRAX_OK)
    return TRAX_OK;
  /* A name that contains neither '/' nor '.' and is no file was meant as a preset. */
  if (!strpbrk(preset_or_path, "/.") && access(preset_or_path, F_OK) != 0)
    return trax_fail(error, "no file and %s", reason.message);
  return trax_config_read_file(config, preset_or_path, error);
}

/* --- single values --- */

static const char *key_name(const void *context, size_t i) {
  (void)context;
  return trax_config_keys[i].name;
}

void trax_config_list_keys(FILE *out) {
  for (size_t i = 0; i < trax_config_key_count; ++i)
    fprintf(out, "%s ", trax_config_keys[i].name);
}

void trax_config_list_presets(FILE *out) {
  for (size_t i = 0; i < PRESETS; ++i)
    fprintf(out, "%s ", presets[i].name);
}

const struct trax_config_key *trax_config_find(const char *name, trax_error *error) {
  for (size_t i = 0; i < trax_config_key_count; ++i)
    if (strcmp(trax_config_keys[i].name, name) == 0)
      return &trax_config_keys[i];
  const char *nearest = trax_nearest_name(name, trax_config_key_count, key_name, NULL);
  if (strcmp(name, "dcache.lru") == 0 || strcmp(name, "l2.lru") == 0)
    nearest = name[0] == 'd' ? "dcache.replacement" : "l2.replacement"; /* their former names */
  /* A key without its component, such as "latency_cycles", is completed in the message. */
  for (size_t i = 0; i < trax_config_key_count && !nearest; ++i)
    if (strcmp(trax_config_keys[i].key, name) == 0)
      nearest = trax_config_keys[i].name;
  if (nearest)
    trax_fail(error, "unknown key \"%s\"; did you mean %s?", name, nearest);
  else
    trax_fail(error, "unknown key \"%s\"; --help-config lists the keys", name);
  return NULL;
}

trax_status trax_config_store(struct trax_config *config, const struct trax_config_key *key, double value,
                              trax_error *error) {
  if (trax_config_check_value(key, value, error) != TRAX_OK)
    return TRAX_ERROR;
  trax_config_put(config, key, value);
  return TRAX_OK;
}

static trax_status parse_flag(const char *name, const char *text, double *value, trax_error *error) {
  static const char *const words[] = {"false", "true", "no", "yes", "off", "on", "0", "1"};
  for (size_t i = 0; i < sizeof words / sizeof *words; ++i)
    if (strcmp(text, words[i]) == 0) {
      *value = i % 2;
      return TRAX_OK;
    }
  return trax_fail(error, "%s is \"%s\"; allowed are true and false", name, text);
}

trax_status trax_config_parse_word(const struct trax_config_key *key, const char *word, double *value,
                                   trax_error *error) {
  char allowed[TRAX_CONFIG_ALLOWED];
  if (trax_config_word_value(key, word, value))
    return TRAX_OK;
  trax_config_allowed(key, allowed);
  return trax_fail(error, "%s is \"%.80s\"; allowed are %s", key->name, word, allowed);
}

static trax_status parse_number(const struct trax_config_key *key, const char *text, double *value, trax_error *error) {
  char *end;
  *value = strtod(text, &end);
  /* strtod also accepts blanks and names such as "inf", which are no values. */
  if (end != text && *end == 0 && strchr("+-.0123456789", *text) && isfinite(*value))
    return TRAX_OK;
  char allowed[TRAX_CONFIG_ALLOWED];
  trax_config_allowed(key, allowed);
  return trax_fail(error, "%s is \"%s\", not a number; allowed are %s", key->name, text, allowed);
}

trax_status trax_config_set(trax_config *config, const char *key_text, const char *value_text, trax_error *error) {
  if (strcmp(key_text, TRAX_DRAM_PRESET) == 0)
    return trax_dram_preset_apply(config, value_text, error);
  const struct trax_config_key *key = trax_config_find(key_text, error);
  if (!key)
    return TRAX_ERROR;
  double value = 0;
  const trax_status status = key->kind == TRAX_KIND_FLAG  ? parse_flag(key_text, value_text, &value, error)
                             : trax_config_has_words(key) ? trax_config_parse_word(key, value_text, &value, error)
                                                          : parse_number(key, value_text, &value, error);
  return status == TRAX_OK ? trax_config_store(config, key, value, error) : TRAX_ERROR;
}

/* --- values by name --- */

double trax_config_get(const trax_config *config, const char *name) {
  for (size_t i = 0; i < trax_config_key_count; ++i)
    if (strcmp(trax_config_keys[i].name, name) == 0)
      return trax_config_value(config, &trax_config_keys[i]);
  return NAN;
}

const char *trax_config_word(const trax_config *config, const char *name) {
  static _Thread_local char text[TRAX_CONFIG_WORD];
  for (size_t i = 0; i < trax_config_key_count; ++i)
    if (strcmp(trax_config_keys[i].name, name) == 0)
      return trax_config_value_word(&trax_config_keys[i], trax_config_value(config, &trax_config_keys[i]), text);
  return NULL;
}

const char *trax_config_next_change(const trax_config *config, const char *after) {
  bool behind = !after;
  for (size_t i = 0; i < trax_config_key_count; ++i) {
    const struct trax_config_key *key = &trax_config_keys[i];
    if (behind && trax_config_value(config, key) != key->initial)
      return key->name;
    behind = behind || strcmp(key->name, after) == 0;
  }
  return NULL;
}

/* --- output --- */

/* Formats a value as libconfig reads it. A number is the shortest decimal that reads back as the same value. A real has
   a point, by which libconfig distinguishes reals from integers. */
static void format_value(const struct trax_config_key *key, double value, char *text, size_t size) {
  if (key->kind == TRAX_KIND_FLAG) {
    snprintf(text, size, "%s", value != 0 ? "true" : "false");
    return;
  }
  char word[TRAX_CONFIG_WORD];
  if (trax_config_has_words(key)) {
    snprintf(text, size, "\"%s\"", trax_config_value_word(key, value, word));
    return;
  }
  for (int digits = 1; digits <= 17; ++digits) {
    snprintf(text, size, "%.*g", digits, value);
    if (strtod(text, NULL) == value)
      break;
  }
  if (key->kind != TRAX_KIND_REAL)
    snprintf(text, size, "%.0f", value);
  else if (floor(value) == value && fabs(value) < 0x1p53) /* 20.0, not 2e+01 */
    snprintf(text, size, "%.1f", value);
}

void trax_config_print(const trax_config *config, FILE *out) {
  const char *component = "";
  for (size_t i = 0; i < trax_config_key_count; ++i) {
    const struct trax_config_key *key = &trax_config_keys[i];
    if (strcmp(component, key->component) != 0)
      fprintf(out, "%s%s: {\n", *component ? "};\n" : "", key->component);
    component = key->component;
    char value[TRAX_CONFIG_WORD + 2], setting[TRAX_CONFIG_WORD + 48];
    format_value(key, trax_config_value(config, key), value, sizeof value);
    snprintf(setting, sizeof setting, "%s = %s;", key->key, value);
    fprintf(out, "  %-32s # %s%s%s\n", setting, *key->unit ? key->unit : "", *key->unit ? ": " : "", key->meaning);
  }
  fprintf(out, "};\n");
}

void trax_config_describe(FILE *out) {
  fprintf(out, "Keys of --set and of configuration files. \"paper\" marks a default that the paper fixes.\n\n");
  for (size_t i = 0; i < trax_config_key_count; ++i) {
    const struct trax_config_key *key = &trax_config_keys[i];
    char initial[TRAX_CONFIG_WORD + 2], range[96];
    format_value(key, key->initial, initial, sizeof initial);
    switch (key->kind) {
    case TRAX_KIND_FLAG:
      snprintf(range, sizeof range, "true or false");
      break;
    case TRAX_KIND_POLICY:
      snprintf(range, sizeof range, "a policy");
      break;
    case TRAX_KIND_MODEL:
      snprintf(range, sizeof range, "a model");
      break;
    case TRAX_KIND_MAPPING:
      snprintf(range, sizeof range, "a mapping");
      break;
    case TRAX_KIND_POWER:
      snprintf(range, sizeof range, "%spower of two, %.12g to %.12g", key->least == 0 ? "0 or " : "",
               fmax(key->least, 1), key->most);
      break;
    case TRAX_KIND_REAL:
      snprintf(range, sizeof range, "%.12g to %.12g, multiples of 0.001", key->least, key->most);
      break;
    case TRAX_KIND_COUNT:
      snprintf(range, sizeof range, "%.12g to %.12g", key->least, key->most);
      break;
    }
    fprintf(out, "%-28s %s; %s%s%s; default %s%s\n", key->name, key->meaning, range, *key->unit ? " " : "", key->unit,
            initial, key->paper ? " (paper)" : "");
  }
  fprintf(out, "\nPolicies, by the place that an arriving line takes in its set:\n");
  for (size_t i = 0; i < TRAX_REPLACEMENT_COUNT; ++i)
    fprintf(out, "  %-6s %s\n", trax_replacements[i].word, trax_replacements[i].place);
  fprintf(out, "\nModels of off-chip memory:");
  for (size_t i = 0; i < TRAX_MEMORY_MODEL_COUNT; ++i)
    fprintf(out, " %s", trax_memory_models[i]);
  fprintf(
      out,
      "\nA mapping has the fields row, rank, bank, column and channel, with a number of bits or the rest of them.\n");
  fprintf(out, "\n%s sets the other keys of dram, and memory.channels:\n", TRAX_DRAM_PRESET);
  trax_dram_presets_describe(out);
  fprintf(out, "\nPresets, TMs x TPs of a TM (the paper's Table 2):");
  for (size_t i = 0; i < PRESETS; ++i)
    fprintf(out, " %s", presets[i].name);
  fprintf(out, "\n");
}
