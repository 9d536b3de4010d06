#include "machine/config.h"

#include "machine/machine.h"

#include <math.h>
#include <stdio.h>

#define TRAX_SECTION(SECTION)
#define TRAX_ROW(KIND, SECTION, KEY, DEFAULT, LEAST, MOST, UNIT, ORIGIN, MEANING)                                      \
  {#SECTION "." #KEY, #SECTION, #KEY, KIND, offsetof(struct trax_config, SECTION.KEY), DEFAULT, LEAST, MOST, UNIT,     \
   MEANING,           ORIGIN},
#define TRAX_ROW_COUNT(...) TRAX_ROW(TRAX_KIND_COUNT, __VA_ARGS__)
#define TRAX_ROW_POWER(...) TRAX_ROW(TRAX_KIND_POWER, __VA_ARGS__)
#define TRAX_ROW_FLAG(...) TRAX_ROW(TRAX_KIND_FLAG, __VA_ARGS__)
#define TRAX_ROW_REAL(...) TRAX_ROW(TRAX_KIND_REAL, __VA_ARGS__)
#define TRAX_ROW_POLICY(...) TRAX_ROW(TRAX_KIND_POLICY, __VA_ARGS__)
enum { OURS = false, PAPER = true };

const struct trax_config_key trax_config_keys[] = {TRAX_CONFIG_KEYS(
    TRAX_SECTION, TRAX_ROW_COUNT, TRAX_ROW_POWER, TRAX_ROW_FLAG, TRAX_ROW_REAL, TRAX_ROW_POLICY, TRAX_SECTION)};
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
    return *(const double *)member;
  case TRAX_KIND_COUNT:
  case TRAX_KIND_POWER:
  case TRAX_KIND_POLICY:
    break;
  }
  return *(const uint32_t *)member;
}

static bool is_power_of_two(double value) {
  int exponent;
  return frexp(value, &exponent) == 0.5;
}

static trax_status fail_policy(trax_error *error, const char *key, double value) {
  char words[200] = "";
  for (size_t i = 0, length = 0; i < TRAX_REPLACEMENT_COUNT && length < sizeof words; i++)
    length += (size_t)snprintf(words + length, sizeof words - length, "%s%s", i ? ", " : "", trax_replacements[i].word);
  return trax_fail(error, "%s is %.12g; allowed are %s", key, value, words);
}

trax_status trax_config_check_value(const struct trax_config_key *key, double value, trax_error *error) {
  const bool in_range = value >= key->least && value <= key->most; /* false for a NaN */
  switch (key->kind) {
  case TRAX_KIND_FLAG:
    if (value != 0 && value != 1)
      return trax_fail(error, "%s is %.12g; allowed are true and false", key->name, value);
    return TRAX_OK;
  case TRAX_KIND_COUNT:
    if (!in_range || value != floor(value))
      return trax_fail(error, "%s is %.12g; allowed are %.12g to %.12g%s%s", key->name, value, key->least, key->most,
                       in_range     ? ", without a fraction"
                       : *key->unit ? " "
                                    : "",
                       in_range ? "" : key->unit);
    return TRAX_OK;
  case TRAX_KIND_POWER:
    if (!in_range || !(is_power_of_two(value) || (value == 0 && key->least == 0)))
      return trax_fail(error, "%s is %.12g; allowed are %sthe powers of two from %.12g to %.12g %s", key->name, value,
                       key->least == 0 ? "0 and " : "", fmax(key->least, 1), key->most, key->unit);
    return TRAX_OK;
  case TRAX_KIND_REAL:
    if (!in_range || fabs(value * 1000 - round(value * 1000)) > 1e-9 * value * 1000)
      return trax_fail(error, "%s is %.12g; allowed are the multiples of 0.001 from %.12g to %.12g %s", key->name,
                       value, key->least, key->most, key->unit);
    return TRAX_OK;
  case TRAX_KIND_POLICY:
    return in_range && value == floor(value) ? TRAX_OK : fail_policy(error, key->name, value);
  }
  return TRAX_OK;
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
  const char *const interleave = "memory.interleave_bytes";
  const uint32_t interleave_bytes = config->memory.interleave_bytes;
  if (config->memory.channels > 1 &&
      (check_line("icache", config->icache.line_bytes, interleave, interleave_bytes, error) ||
       check_line("dcache", config->dcache.line_bytes, interleave, interleave_bytes, error) ||
       (config->l2.bytes && check_line("l2", config->l2.line_bytes, interleave, interleave_bytes, error))))
    return TRAX_ERROR;
  return TRAX_OK;
}
