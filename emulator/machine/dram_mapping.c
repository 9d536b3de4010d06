#include "machine/dram_mapping.h"

#include "machine/config.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *const trax_memory_models[] = {
#define TRAX_MODEL(ID, WORD) WORD,
    TRAX_MEMORY_MODELS(TRAX_MODEL)
#undef TRAX_MODEL
};

static const char *const names[TRAX_DRAM_FIELDS] = {"", "row", "rank", "bank", "column", "channel"};

enum { PART_BITS = 7, FIELD_MASK = 7, MOST_BITS = 15 };

/* --- as text --- */

/* Reads a part at *text, which is moved to what follows it. False: there is none. */
static bool parse_part(const char **text, uint64_t *part) {
  for (unsigned field = 1; field < TRAX_DRAM_FIELDS; field++) {
    const size_t length = strlen(names[field]);
    if (strncmp(*text, names[field], length) != 0)
      continue;
    unsigned bits = 0;
    const char *digit = *text + length;
    for (; *digit >= '0' && *digit <= '9' && bits <= MOST_BITS; digit++)
      bits = 10 * bits + (unsigned)(*digit - '0');
    if (bits > MOST_BITS || (digit > *text + length && bits == 0))
      return false;
    *part = field | (uint64_t)bits << 3;
    *text = digit;
    return true;
  }
  return false;
}

bool trax_dram_mapping_parse(const char *text, double *mapping) {
  uint64_t value = 0, part;
  for (unsigned i = 0; i < TRAX_DRAM_PARTS && parse_part(&text, &part); i++) {
    value |= part << PART_BITS * i;
    if (*text == 0) {
      *mapping = (double)value;
      return true;
    }
    if (*text++ != ':')
      return false;
  }
  return false;
}

bool trax_dram_mapping_format(double mapping, char text[TRAX_DRAM_MAPPING_TEXT]) {
  if (!(mapping >= 1 && mapping < ldexp(1, PART_BITS * TRAX_DRAM_PARTS) && mapping == floor(mapping)))
    return false;
  size_t length = 0;
  for (uint64_t parts = (uint64_t)mapping; parts; parts >>= PART_BITS) {
    const unsigned field = parts & FIELD_MASK, bits = parts >> 3 & MOST_BITS;
    if (field == 0 || field >= TRAX_DRAM_FIELDS)
      return false;
    char number[8] = "";
    if (bits)
      snprintf(number, sizeof number, "%u", bits);
    if (text)
      length += (size_t)snprintf(text + length, TRAX_DRAM_MAPPING_TEXT - length, "%s%s%s", length ? ":" : "",
                                 names[field], number);
  }
  return true;
}

/* --- with sizes --- */

static bool is_power(uint32_t value) {
  return value && (value & (value - 1)) == 0;
}

static unsigned log2_of(uint32_t power) {
  return (unsigned)__builtin_ctz(power);
}

/* The longest request that must lie in one row of one channel. */
static uint32_t longest_request(const struct trax_config *config) {
  uint32_t longest = 64; /* a write */
  const uint32_t lines[] = {config->icache.line_bytes, config->dcache.line_bytes,
                            config->l2.bytes ? config->l2.line_bytes : 0};
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
    longest = lines[i] > longest ? lines[i] : longest;
  return longest;
}

trax_status trax_dram_map_create(struct trax_dram_map *map, const struct trax_config *config, trax_error *error) {
  const uint32_t burst = config->dram.bus_bits / 8 * config->dram.burst_length;
  char text[TRAX_DRAM_MAPPING_TEXT];
  if (!trax_dram_mapping_format(config->dram.mapping, text))
    return trax_fail(error, "dram.mapping is %.17g, which is none", config->dram.mapping);
  if (!is_power(config->memory.channels))
    return trax_fail(error, "memory.channels is %u; with memory.model = dram it must be a power of two",
                     config->memory.channels);
  if (burst > config->dram.row_bytes)
    return trax_fail(error, "dram.row_bytes is %u; it must hold a burst of %u bytes", config->dram.row_bytes, burst);
  *map = (struct trax_dram_map){.burst_shift = log2_of(burst)};
  unsigned bits[TRAX_DRAM_FIELDS] = {[TRAX_DRAM_RANK] = log2_of(config->dram.ranks),
                                     [TRAX_DRAM_BANK] = log2_of(config->dram.banks),
                                     [TRAX_DRAM_COLUMN] = log2_of(config->dram.row_bytes / burst),
                                     [TRAX_DRAM_CHANNEL] = log2_of(config->memory.channels)};
  bits[TRAX_DRAM_ROW] = 32 - map->burst_shift;
  for (unsigned field = TRAX_DRAM_RANK; field < TRAX_DRAM_FIELDS; field++)
    bits[TRAX_DRAM_ROW] -= bits[field]; /* at least 3: the others have at most 2 + 5 + 16 + 4 with the burst's */

  unsigned left[TRAX_DRAM_FIELDS], rests[TRAX_DRAM_FIELDS] = {0};
  memcpy(left, bits, sizeof left);
  for (uint64_t parts = (uint64_t)config->dram.mapping; parts; parts >>= PART_BITS, map->count++) {
    const unsigned field = parts & FIELD_MASK, width = parts >> 3 & MOST_BITS;
    if (width > left[field] || (!width && rests[field]++))
      return trax_fail(error, "dram.mapping is \"%s\"; %s has %u bits in all, and one part without a number at most",
                       text, names[field], bits[field]);
    left[field] -= width;
    map->field[map->count] = (uint8_t)field;
    map->bits[map->count] = (uint8_t)width;
  }
  for (unsigned field = TRAX_DRAM_ROW; field < TRAX_DRAM_FIELDS; field++)
    if (left[field] && !rests[field])
      return trax_fail(error, "dram.mapping is \"%s\"; %s lacks %u of its %u bits", text, names[field], left[field],
                       bits[field]);
  for (unsigned i = 0; i < map->count; i++)
    if (!map->bits[i])
      map->bits[i] = (uint8_t)left[map->field[i]];
  for (unsigned low = 0, high = map->count - 1; low < high; low++, high--) {
    const uint8_t field = map->field[low], width = map->bits[low];
    map->field[low] = map->field[high];
    map->bits[low] = map->bits[high];
    map->field[high] = field;
    map->bits[high] = width;
  }
  uint32_t together = burst;
  for (unsigned i = 0; i < map->count && (map->field[i] == TRAX_DRAM_COLUMN || !map->bits[i]); i++)
    together <<= map->bits[i];
  if (together < longest_request(config))
    return trax_fail(error,
                     "dram.mapping is \"%s\"; %u bytes lie together in a row, fewer than the longest request's %u",
                     text, together, longest_request(config));
  return TRAX_OK;
}

struct trax_dram_place trax_dram_place_of(const struct trax_dram_map *map, uint32_t address) {
  struct trax_dram_place place = {{0}};
  unsigned filled[TRAX_DRAM_FIELDS] = {0};
  uint32_t rest = address >> map->burst_shift;
  for (unsigned i = 0; i < map->count; i++) {
    const unsigned field = map->field[i];
    place.field[field] |= (rest & ((1u << map->bits[i]) - 1)) << filled[field];
    filled[field] += map->bits[i];
    rest >>= map->bits[i];
  }
  return place;
}

uint32_t trax_dram_bytes(const struct trax_config *config, uint32_t address, uint32_t bytes) {
  const uint32_t burst = config->dram.bus_bits / 8 * config->dram.burst_length;
  return ((address + bytes - 1) / burst - address / burst + 1) * burst;
}
