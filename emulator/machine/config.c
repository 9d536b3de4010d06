#include "machine/config.h"

#include "machine/machine.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define TRAX_COMPONENT(OF)
#define TRAX_ROW(KIND, OF, KEY, DEFAULT, LEAST, MOST, UNIT, ORIGIN, MEANING)                                           \
  {#OF "." #KEY, #OF, #KEY, KIND, offsetof(struct trax_config, OF.KEY), DEFAULT, LEAST, MOST, UNIT, MEANING, ORIGIN},
#define TRAX_ROW_COUNT(...) TRAX_ROW(TRAX_KIND_COUNT, __VA_ARGS__)
#define TRAX_ROW_POWER(...) TRAX_ROW(TRAX_KIND_POWER, __VA_ARGS__)
#define TRAX_ROW_FLAG(...) TRAX_ROW(TRAX_KIND_FLAG, __VA_ARGS__)
#define TRAX_ROW_REAL(...) TRAX_ROW(TRAX_KIND_REAL, __VA_ARGS__)
#define TRAX_ROW_POLICY(...) TRAX_ROW(TRAX_KIND_POLICY, __VA_ARGS__)
#define TRAX_ROW_MODEL(...) TRAX_ROW(TRAX_KIND_MODEL, __VA_ARGS__)
#define TRAX_ROW_MAPPING(...) TRAX_ROW(TRAX_KIND_MAPPING, __VA_ARGS__)
enum { OURS = false, PAPER = true };

const struct trax_config_key trax_config_keys[] = {TRAX_CONFIG_KEYS(TRAX_COMPONENT, TRAX_ROW_COUNT, TRAX_ROW_POWER,
                                                                    TRAX_ROW_FLAG, TRAX_ROW_REAL, TRAX_ROW_POLICY,
                                                                    TRAX_ROW_MODEL, TRAX_ROW_MAPPING, TRAX_COMPONENT)};
const size_t trax_config_key_count = sizeof trax_config_keys / sizeof *trax_config_keys;

const struct trax_replacement_policy trax_replacements[] = {
#define TRAX_REPLACEMENT(ID, WORD, BY_USE, PLACE) {WORD, BY_USE, PLACE},
    TRAX_REPLACEMENTS(TRAX_REPLACEMENT)
#undef TRAX_REPLACEMENT
};

double trax_config_value(const struct trax_config *config, const struct trax_config_key *key) {
  const void *member = (const char *)config + key->offset;
  switch (key->kind) {
  case TRAX_KIND_FLAG:
    return *(const bool *)member;
  case TRAX_KIND_REAL:
  case TRAX_KIND_MAPPING:
    return *(const double *)member;
  case TRAX_KIND_COUNT:
  case TRAX_KIND_POWER:
  case TRAX_KIND_POLICY:
  case TRAX_KIND_MODEL:
    break;
  }
  return *(const uint32_t *)member;
}

void trax_config_put(struct trax_config *config, const struct trax_config_key *key, double value) {
  void *member = (char *)config + key->offset;
  switch (key->kind) {
  case TRAX_KIND_FLAG:
    *(bool *)member = value != 0;
    break;
  case TRAX_KIND_REAL:
  case TRAX_KIND_MAPPING:
    *(double *)member = value;
    break;
  case TRAX_KIND_COUNT:
  case TRAX_KIND_POWER:
  case TRAX_KIND_POLICY:
  case TRAX_KIND_MODEL:
    *(uint32_t *)member = (uint32_t)value;
    break;
  }
}

/* --- words --- */

/* Word i of a kind with a list of words; NULL: there are no more. */
static const char *listed_word(const struct trax_config_key *key, size_t i) {
  if (key->kind == TRAX_KIND_POLICY)
    return i < TRAX_REPLACEMENT_COUNT ? trax_replacements[i].word : NULL;
  return key->kind == TRAX_KIND_MODEL && i < TRAX_MEMORY_MODEL_COUNT ? trax_memory_models[i] : NULL;
}

const char *trax_config_value_word(const struct trax_config_key *key, double value, char text[TRAX_CONFIG_WORD]) {
  if (key->kind == TRAX_KIND_MAPPING)
    return trax_dram_mapping_format(value, text) ? text : "";
  return listed_word(key, (size_t)value);
}

bool trax_config_word_value(const struct trax_config_key *key, const char *word, double *value) {
  if (key->kind == TRAX_KIND_MAPPING)
    return trax_dram_mapping_parse(word, value);
  const char *listed;
  for (size_t i = 0; (listed = listed_word(key, i)) != NULL; i++)
    if (strcmp(word, listed) == 0) {
      *value = (double)i;
      return true;
    }
  return false;
}

static bool is_power_of_two(double value) {
  int exponent;
  return frexp(value, &exponent) == 0.5;
}

static bool is_allowed(const struct trax_config_key *key, double value) {
  const bool in_range = value >= key->least && value <= key->most; /* false for a NaN */
  switch (key->kind) {
  case TRAX_KIND_FLAG:
    return value == 0 || value == 1;
  case TRAX_KIND_COUNT:
  case TRAX_KIND_POLICY:
  case TRAX_KIND_MODEL:
    return in_range && value == floor(value);
  case TRAX_KIND_POWER:
    return in_range && (is_power_of_two(value) || (value == 0 && key->least == 0));
  case TRAX_KIND_REAL:
    return in_range && !(fabs(value * 1000 - round(value * 1000)) > 1e-9 * value * 1000);
  case TRAX_KIND_MAPPING:
    return trax_dram_mapping_format(value, NULL);
  }
  return true;
}

void trax_config_allowed(const struct trax_config_key *key, char text[TRAX_CONFIG_ALLOWED]) {
  const size_t size = TRAX_CONFIG_ALLOWED;
  const char *word;
  switch (key->kind) {
  case TRAX_KIND_FLAG:
    snprintf(text, size, "true and false");
    break;
  case TRAX_KIND_COUNT:
    snprintf(text, size, "%.12g to %.12g%s%s", key->least, key->most, *key->unit ? " " : "", key->unit);
    break;
  case TRAX_KIND_POWER:
    snprintf(text, size, "%sthe powers of two from %.12g to %.12g %s", key->least == 0 ? "0 and " : "",
             fmax(key->least, 1), key->most, key->unit);
    break;
  case TRAX_KIND_REAL:
    snprintf(text, size, "the multiples of 0.001 from %.12g to %.12g %s", key->least, key->most, key->unit);
    break;
  case TRAX_KIND_POLICY:
  case TRAX_KIND_MODEL:
    *text = '\0';
    for (size_t i = 0, length = 0; (word = listed_word(key, i)) != NULL && length < size; i++)
      length += (size_t)snprintf(text + length, size - length, "%s%s", i ? ", " : "", word);
    break;
  case TRAX_KIND_MAPPING:
    snprintf(text, size, "row, rank, bank, column and channel, with a number of bits or without, and colons between");
    break;
  }
}

trax_status trax_config_check_value(const struct trax_config_key *key, double value, trax_error *error) {
  char allowed[TRAX_CONFIG_ALLOWED];
  if (is_allowed(key, value))
    return TRAX_OK;
  trax_config_allowed(key, allowed);
  const bool is_fraction = key->kind == TRAX_KIND_COUNT && value >= key->least && value <= key->most;
  return trax_fail(error, "%s is %.12g; allowed are %s%s", key->name, value, allowed,
                   is_fraction ? ", without a fraction" : "");
}

/* Checks that a line of the cache `name` is not longer than `limit`, the value of the key `limit_name`. */
static trax_status check_line(const char *name, uint32_t line_bytes, const char *limit_name, uint32_t limit,
                              trax_error *error) {
  if (line_bytes > limit)
    return trax_fail(error, "%s.line_bytes is %u; it must not be more than %s = %u", name, line_bytes, limit_name,
                     limit);
  return TRAX_OK;
}

static trax_status check_cache(const char *name, uint32_t bytes, uint32_t line_bytes, uint32_t ways,
                               trax_error *error) {
  if ((uint64_t)line_bytes * ways > bytes)
    return trax_fail(error, "%s.bytes is %u; it must hold %s.ways = %u lines of %s.line_bytes = %u", name, bytes, name,
                     ways, name, line_bytes);
  return TRAX_OK;
}

double trax_memory_gbps(const struct trax_config *config) {
  if (config->memory.model == TRAX_MEMORY_LIMIT)
    return config->memory.bandwidth_gbps;
  return config->dram.mtps * (config->dram.bus_bits / 8.0) * config->memory.channels / 1000;
}

static trax_status check_dram(const struct trax_config *config, trax_error *error) {
  struct trax_dram_map map;
  if (config->dram.batch_from > config->dram.writes)
    return trax_fail(error, "dram.batch_from is %u; it must not be more than dram.writes = %u", config->dram.batch_from,
                     config->dram.writes);
  if (config->dram.batch_to >= config->dram.batch_from)
    return trax_fail(error, "dram.batch_to is %u; it must be less than dram.batch_from = %u", config->dram.batch_to,
                     config->dram.batch_from);
  if (config->dram.trefi && config->dram.trefi <= config->dram.trfc)
    return trax_fail(error, "dram.trefi is %u; it must be 0 or more than dram.trfc = %u", config->dram.trefi,
                     config->dram.trfc);
  return trax_dram_map_create(&map, config, error);
}

trax_status trax_config_validate(const struct trax_config *config, trax_error *error) {
  for (size_t i = 0; i < trax_config_key_count; i++)
    if (trax_config_check_value(&trax_config_keys[i], trax_config_value(config, &trax_config_keys[i]), error))
      return TRAX_ERROR;
  if (check_cache("icache", config->icache.bytes, config->icache.line_bytes, config->icache.ways, error) ||
      check_cache("dcache", config->dcache.bytes, config->dcache.line_bytes, config->dcache.ways, error))
    return TRAX_ERROR;
  if (config->l2.bytes &&
      (check_cache("l2", config->l2.bytes, config->l2.line_bytes, config->l2.ways, error) ||
       check_line("icache", config->icache.line_bytes, "l2.line_bytes", config->l2.line_bytes, error) ||
       check_line("dcache", config->dcache.line_bytes, "l2.line_bytes", config->l2.line_bytes, error)))
    return TRAX_ERROR;
  if (config->chip.tps_per_tm % config->simt.width)
    return trax_fail(error, "simt.width is %u; it must divide chip.tps_per_tm = %u", config->simt.width,
                     config->chip.tps_per_tm);
  if (config->memory.model == TRAX_MEMORY_DRAM)
    return check_dram(config, error);
  const char *const interleave = "memory.interleave_bytes";
  const uint32_t interleave_bytes = config->memory.interleave_bytes;
  if (config->memory.channels > 1 &&
      (check_line("icache", config->icache.line_bytes, interleave, interleave_bytes, error) ||
       check_line("dcache", config->dcache.line_bytes, interleave, interleave_bytes, error) ||
       (config->l2.bytes && check_line("l2", config->l2.line_bytes, interleave, interleave_bytes, error))))
    return TRAX_ERROR;
  return TRAX_OK;
}
