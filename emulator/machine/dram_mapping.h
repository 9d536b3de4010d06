/* Mappings of addresses to the channels, ranks, banks, rows and columns of DRAM (docs/timing-memory.md, "DRAM"). A
   mapping is a text such as "row:rank:bank:column:channel:column3". In a configuration it is a whole number below 2^49.
 */
#ifndef TRAX_MACHINE_DRAM_MAPPING_H
#define TRAX_MACHINE_DRAM_MAPPING_H

#include "trax/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct trax_config;

#define TRAX_DRAM_MAX_RANKS 4
#define TRAX_DRAM_MAX_BANKS 32
#define TRAX_DRAM_MAX_QUEUE 256

/* The models of off-chip memory: identifier, word. */
#define TRAX_MEMORY_MODELS(X)                                                                                          \
  X(LIMIT, "limit")                                                                                                    \
  X(DRAM, "dram")

enum trax_memory_model {
#define TRAX_MODEL(ID, WORD) TRAX_MEMORY_##ID,
  TRAX_MEMORY_MODELS(TRAX_MODEL)
#undef TRAX_MODEL
      TRAX_MEMORY_MODEL_COUNT
};

extern const char *const trax_memory_models[TRAX_MEMORY_MODEL_COUNT]; /* their words */

enum trax_dram_field {
  TRAX_DRAM_ROW = 1,
  TRAX_DRAM_RANK,
  TRAX_DRAM_BANK,
  TRAX_DRAM_COLUMN,
  TRAX_DRAM_CHANNEL,
  TRAX_DRAM_FIELDS /* one more than the last */
};

/* Part i of a mapping, from the highest bits on: a field, and the number of its bits or 0 for the rest of the field. */
#define TRAX_DRAM_PART(I, FIELD, BITS) ((double)(((uint64_t)(FIELD) | (uint64_t)(BITS) << 3) << 7 * (I)))
#define TRAX_DRAM_DEFAULT_MAPPING                                                                                      \
  (TRAX_DRAM_PART(0, TRAX_DRAM_ROW, 0) + TRAX_DRAM_PART(1, TRAX_DRAM_RANK, 0) + TRAX_DRAM_PART(2, TRAX_DRAM_BANK, 0) + \
   TRAX_DRAM_PART(3, TRAX_DRAM_COLUMN, 0) + TRAX_DRAM_PART(4, TRAX_DRAM_CHANNEL, 0) +                                  \
   TRAX_DRAM_PART(5, TRAX_DRAM_COLUMN, 3))
enum { TRAX_DRAM_PARTS = 7, TRAX_DRAM_MAPPING_TEXT = 80 };

/* Whether the text is a mapping, whose value *mapping receives. */
bool trax_dram_mapping_parse(const char *text, double *mapping);
/* Whether the value is that of a mapping. text: its text, or NULL. */
bool trax_dram_mapping_format(double mapping, char text[TRAX_DRAM_MAPPING_TEXT]);

/* A mapping for the sizes of a configuration. */
struct trax_dram_map {
  unsigned count;
  uint8_t field[TRAX_DRAM_PARTS], bits[TRAX_DRAM_PARTS]; /* [count], from the lowest bits on */
  unsigned burst_shift;                                  /* log2 of a burst's bytes */
};

/* Fails if mapping and sizes do not fit; the message names the keys. */
trax_status trax_dram_map_create(struct trax_dram_map *map, const struct trax_config *config, trax_error *error);

struct trax_dram_place {
  uint32_t field[TRAX_DRAM_FIELDS];
};
struct trax_dram_place trax_dram_place_of(const struct trax_dram_map *map, uint32_t address);

/* The bytes that a request moves: those of all bursts with a byte of it. */
uint32_t trax_dram_bytes(const struct trax_config *config, uint32_t address, uint32_t bytes);

#endif
