/* A map from 64-bit keys to 32-bit values, with open addressing. Entries may be larger: then they begin with a struct
   trax_map_entry, and all calls for a map pass their size. A map of zeros is empty. */
#ifndef TRAX_MAP_H
#define TRAX_MAP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct trax_map_entry {
  uint64_t key;
  uint32_t generation; /* the map's + 1, if the entry is used */
  uint32_t value;
};

struct trax_map {
  char *entries;
  size_t capacity, count; /* capacity: a power of two, or 0 */
  uint32_t generation;    /* the number of times that the map was emptied */
};

/* Returns the entry of a key, or the one that it would take. The map has a capacity. */
static inline struct trax_map_entry *trax_map_slot(const struct trax_map *map, size_t size, uint64_t key) {
  uint64_t slot = key * 0x9E3779B97F4A7C15u;
  slot = (slot ^ slot >> 32) & (map->capacity - 1);
  for (;; slot = (slot + 1) & (map->capacity - 1)) {
    struct trax_map_entry *entry = (struct trax_map_entry *)(map->entries + slot * size);
    if (entry->generation != map->generation + 1 || entry->key == key)
      return entry;
  }
}

/* NULL: the map does not have the key. */
static inline struct trax_map_entry *trax_map_find(const struct trax_map *map, size_t size, uint64_t key) {
  struct trax_map_entry *entry = map->count ? trax_map_slot(map, size, key) : NULL;
  return entry && entry->generation == map->generation + 1 ? entry : NULL;
}

/* Doubles the capacity. */
static inline bool trax_map_grow(struct trax_map *map, size_t size) {
  struct trax_map grown = {.capacity = map->capacity ? 2 * map->capacity : 64, .count = map->count};
  if (!(grown.entries = calloc(grown.capacity, size)))
    return false;
  for (size_t i = 0; i < map->capacity; i++) {
    struct trax_map_entry *from = (struct trax_map_entry *)(map->entries + i * size);
    if (from->generation == map->generation + 1) {
      struct trax_map_entry *to = trax_map_slot(&grown, size, from->key);
      memcpy(to, from, size);
      to->generation = 1;
    }
  }
  free(map->entries);
  *map = grown;
  return true;
}

/* Returns the entry of a key. A new one has the value `otherwise`, and zeros behind it. NULL: out of memory. */
static inline struct trax_map_entry *trax_map_put(struct trax_map *map, size_t size, uint64_t key, uint32_t otherwise) {
  if (2 * map->count >= map->capacity && !trax_map_grow(map, size))
    return NULL;
  struct trax_map_entry *entry = trax_map_slot(map, size, key);
  if (entry->generation != map->generation + 1) {
    memset(entry, 0, size);
    *entry = (struct trax_map_entry){key, map->generation + 1, otherwise};
    map->count++;
  }
  return entry;
}

/* Removes all entries, in a time that does not depend on their number. */
static inline void trax_map_empty(struct trax_map *map, size_t size) {
  map->count = 0;
  if (++map->generation < UINT32_MAX)
    return;
  map->generation = 0;
  if (map->capacity)
    memset(map->entries, 0, map->capacity * size);
}

static inline void trax_map_free(struct trax_map *map) {
  free(map->entries);
  *map = (struct trax_map){0};
}

#endif
