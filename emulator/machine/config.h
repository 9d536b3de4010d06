/* The machine's configuration: a plain struct with one member per key of machine/config_keys.h. A key's name is the
   member's path in the struct ("memory.bandwidth_gbps"); emulator/host/config.c reads and prints keys. */
#ifndef TRAX_MACHINE_CONFIG_H
#define TRAX_MACHINE_CONFIG_H

#include "machine/config_keys.h"
#include "trax/emulator.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct trax_config {
#define TRAX_COMPONENT_BEGIN(COMPONENT) struct {
#define TRAX_COMPONENT_END(COMPONENT)                                                                                  \
  }                                                                                                                    \
  COMPONENT;
#define TRAX_KEY_COUNT(COMPONENT, KEY, ...) uint32_t KEY;
#define TRAX_KEY_FLAG(COMPONENT, KEY, ...) bool KEY;
#define TRAX_KEY_REAL(COMPONENT, KEY, ...) double KEY;
  TRAX_CONFIG_KEYS(TRAX_COMPONENT_BEGIN, TRAX_KEY_COUNT, TRAX_KEY_COUNT, TRAX_KEY_FLAG, TRAX_KEY_REAL, TRAX_KEY_COUNT,
                   TRAX_KEY_COUNT, TRAX_KEY_REAL, TRAX_COMPONENT_END)
#undef TRAX_COMPONENT_BEGIN
#undef TRAX_COMPONENT_END
#undef TRAX_KEY_COUNT
#undef TRAX_KEY_FLAG
#undef TRAX_KEY_REAL
};

/* Initialiser with the defaults: one TP, everything else as in the paper or, where the paper is silent, our choice. */
#define TRAX_CONFIG_NOTHING(COMPONENT)
#define TRAX_CONFIG_INITIAL(COMPONENT, KEY, DEFAULT, ...) .COMPONENT.KEY = DEFAULT,
#define TRAX_CONFIG_DEFAULT                                                                                            \
  {TRAX_CONFIG_KEYS(TRAX_CONFIG_NOTHING, TRAX_CONFIG_INITIAL, TRAX_CONFIG_INITIAL, TRAX_CONFIG_INITIAL,                \
                    TRAX_CONFIG_INITIAL, TRAX_CONFIG_INITIAL, TRAX_CONFIG_INITIAL, TRAX_CONFIG_INITIAL,                \
                    TRAX_CONFIG_NOTHING)}

/* One row of the table, for code that visits all keys. */
struct trax_config_key {
  const char *name; /* "memory.bandwidth_gbps" */
  const char *component, *key;
  enum {
    TRAX_KIND_COUNT,
    TRAX_KIND_POWER,
    TRAX_KIND_FLAG,
    TRAX_KIND_REAL,
    TRAX_KIND_POLICY,
    TRAX_KIND_MODEL,
    TRAX_KIND_MAPPING
  } kind;
  size_t offset;               /* in struct trax_config */
  double initial, least, most; /* a double holds every value exactly */
  const char *unit, *meaning;  /* unit is "" for flags */
  bool paper;                  /* the paper states the default */
};

extern const struct trax_config_key trax_config_keys[];
extern const size_t trax_config_key_count;

/* The value of a key in a configuration; counts, flags and words as numbers. */
double trax_config_value(const struct trax_config *config, const struct trax_config_key *key);
/* Sets a key to a value that trax_config_check_value allows. */
void trax_config_put(struct trax_config *config, const struct trax_config_key *key, double value);

/* The word of a value of the key; NULL: the key's values are no words. A mapping's is written to `text`. */
enum { TRAX_CONFIG_WORD = TRAX_DRAM_MAPPING_TEXT };
const char *trax_config_value_word(const struct trax_config_key *key, double value, char text[TRAX_CONFIG_WORD]);
/* Whether the word is one of a key whose values are words; *value receives it. */
bool trax_config_word_value(const struct trax_config_key *key, const char *word, double *value);
/* Whether the key's values are words. */
static inline bool trax_config_has_words(const struct trax_config_key *key) {
  return key->kind >= TRAX_KIND_POLICY;
}
/* Checks that the key may have the value. The message names the key, the value and the allowed values. */
trax_status trax_config_check_value(const struct trax_config_key *key, double value, trax_error *error);
/* Describes the values that the key may have, as in "allowed are ...". */
enum { TRAX_CONFIG_ALLOWED = 200 };
void trax_config_allowed(const struct trax_config_key *key, char text[TRAX_CONFIG_ALLOWED]);

/* Checks all ranges and the relations between keys, which are all that the machine relies on. The message names the key
   and what is allowed. */
trax_status trax_config_validate(const struct trax_config *config, trax_error *error);

/* The most that the buses of off-chip memory can move, in GB/s. */
double trax_memory_gbps(const struct trax_config *config);

#endif
