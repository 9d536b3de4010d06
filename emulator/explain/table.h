/* A map from 64-bit keys to 32-bit numbers, with open addressing. */
#ifndef TRAX_EXPLAIN_TABLE_H
#define TRAX_EXPLAIN_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "trax/grow.h"

struct trax_table_entry {
  uint64_t key;
  uint32_t value; /* the number + 1; 0: an empty entry */
};

struct trax_table {
  struct trax_table_entry *entries;
  size_t capacity, count; /* capacity: a power of two, or 0 */
};

static inline size_t trax_table_slot(const struct trax_table *table, uint64_t key) {
  uint64_t hash = key * 0x9E3779B97F4A7C15u;
  hash ^= hash >> 32;
  size_t slot = hash & (table->capacity - 1);
  while (table->entries[slot].value && table->entries[slot].key != key)
    slot = (slot + 1) & (table->capacity - 1);
  return slot;
}

static inline bool trax_table_grow(struct trax_table *table) {
  struct trax_table grown = {.capacity = table->capacity ? 2 * table->capacity : 1024};
  grown.entries = calloc(grown.capacity, sizeof *grown.entries);
  if (!grown.entries)
    return false;
  for (size_t i = 0; i < table->capacity; i++)
    if (table->entries[i].value)
      grown.entries[trax_table_slot(&grown, table->entries[i].key)] = table->entries[i];
  grown.count = table->count;
  free(table->entries);
  *table = grown;
  return true;
}

/* Sets *value to the key's number. A new key gets the number `otherwise`. False: out of memory. */
static inline bool trax_table_find(struct trax_table *table, uint64_t key, uint32_t otherwise, uint32_t *value) {
  if (2 * table->count >= table->capacity && !trax_table_grow(table))
    return false;
  struct trax_table_entry *entry = &table->entries[trax_table_slot(table, key)];
  if (!entry->value) {
    *entry = (struct trax_table_entry){key, otherwise + 1};
    table->count++;
  }
  *value = entry->value - 1;
  return true;
}

/* Sets *value to the number of a key; false: the key has none. */
static inline bool trax_table_has(const struct trax_table *table, uint64_t key, uint32_t *value) {
  const struct trax_table_entry *entry = table->capacity ? &table->entries[trax_table_slot(table, key)] : NULL;
  if (!entry || !entry->value)
    return false;
  *value = entry->value - 1;
  return true;
}

static inline void trax_table_free(struct trax_table *table) {
  free(table->entries);
  *table = (struct trax_table){0};
}

#endif
