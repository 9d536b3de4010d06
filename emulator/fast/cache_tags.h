/* Which lines a cache holds: sets of ways, first in, first out (docs/timing.md, "Fetch") or least recently used out
   ("Data cache"). Lines are known by their number, address / line_bytes. Used by all caches. */
#ifndef TRAX_FAST_CACHE_TAGS_H
#define TRAX_FAST_CACHE_TAGS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct trax_cache_tags {
  uint32_t ways, set_mask;
  unsigned line_shift;
  uint64_t *lines; /* [sets][ways]: line number + 1; 0 is an empty place. If `lru` the latest used first */
  uint32_t *next;  /* [sets]: the way the next arriving line takes, unless `lru` */
  bool lru;
};

static inline bool trax_cache_tags_create(struct trax_cache_tags *tags, uint32_t bytes, uint32_t line_bytes,
                                          uint32_t ways, bool lru) {
  const uint32_t sets = bytes / line_bytes / ways;
  tags->ways = ways;
  tags->set_mask = sets - 1;
  tags->lru = lru && ways > 1;
  tags->line_shift = (unsigned)__builtin_ctz(line_bytes);
  tags->lines = calloc((size_t)sets * ways, sizeof *tags->lines);
  tags->next = calloc(sets, sizeof *tags->next);
  return tags->lines && tags->next;
}

static inline void trax_cache_tags_destroy(struct trax_cache_tags *tags) {
  free(tags->lines);
  free(tags->next);
}

static inline uint32_t trax_line_of(const struct trax_cache_tags *tags, uint32_t address) {
  return address >> tags->line_shift;
}

static inline bool trax_cache_tags_have(const struct trax_cache_tags *tags, uint32_t line) {
  const uint64_t *set = tags->lines + (size_t)(line & tags->set_mask) * tags->ways;
  for (uint32_t way = 0; way < tags->ways; way++)
    if (set[way] == (uint64_t)line + 1)
      return true;
  return false;
}

/* Makes the line in `way` of a set the latest used; those used since it was go one way back. */
static inline void trax_cache_tags_to_front(uint64_t *set, uint32_t way, uint64_t line) {
  for (; way > 0; way--)
    set[way] = set[way - 1];
  set[0] = line;
}

/* Whether the cache has the line, which is used if so. */
static inline bool trax_cache_tags_use(struct trax_cache_tags *tags, uint32_t line) {
  if (!tags->lru)
    return trax_cache_tags_have(tags, line);
  uint64_t *set = tags->lines + (size_t)(line & tags->set_mask) * tags->ways;
  for (uint32_t way = 0; way < tags->ways; way++)
    if (set[way] == (uint64_t)line + 1) {
      trax_cache_tags_to_front(set, way, set[way]);
      return true;
    }
  return false;
}

/* All places are empty from now on. Returns how many were not. */
static inline uint32_t trax_cache_tags_drop(struct trax_cache_tags *tags) {
  const size_t places = ((size_t)tags->set_mask + 1) * tags->ways;
  uint32_t dropped = 0;
  for (size_t i = 0; i < places; i++)
    dropped += tags->lines[i] != 0;
  memset(tags->lines, 0, places * sizeof *tags->lines);
  return dropped;
}

/* Returns the number of the line whose place it takes, plus 1; 0 if the place was empty. */
static inline uint64_t trax_cache_tags_install(struct trax_cache_tags *tags, uint32_t line) {
  const uint32_t set = line & tags->set_mask;
  uint64_t *lines = tags->lines + (size_t)set * tags->ways;
  const uint32_t way = tags->lru ? tags->ways - 1 : tags->next[set];
  const uint64_t gone = lines[way];
  if (tags->lru) {
    trax_cache_tags_to_front(lines, way, (uint64_t)line + 1);
  } else {
    lines[way] = (uint64_t)line + 1;
    tags->next[set] = (way + 1) & (tags->ways - 1);
  }
  return gone;
}

#endif
