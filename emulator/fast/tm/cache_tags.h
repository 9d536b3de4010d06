/* The tags of a cache, of any kind: sets of ways, and the state of its replacement policy (machine/replacement.h). A
   line's number is address / line_bytes. */
#ifndef TRAX_FAST_CACHE_TAGS_H
#define TRAX_FAST_CACHE_TAGS_H

#include "machine/replacement.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct trax_cache_tags {
  uint32_t ways, set_mask;
  unsigned line_shift;
  enum trax_replacement policy;
  bool by_use;     /* the policy depends on the uses of lines */
  uint32_t *lines; /* [sets][ways]: line number + 1; 0: empty. LRU: in the order of use, the latest first */
  uint32_t *next;  /* [sets]: the policy's state. FIFO: the way of the next arriving line */
};

static inline bool trax_cache_tags_create(struct trax_cache_tags *tags, uint32_t bytes, uint32_t line_bytes,
                                          uint32_t ways, enum trax_replacement policy) {
  const uint32_t sets = bytes / line_bytes / ways;
  tags->ways = ways;
  tags->set_mask = sets - 1;
  tags->policy = policy;
  tags->by_use = trax_replacements[policy].by_use && ways > 1;
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
  const uint32_t *set = tags->lines + (size_t)(line & tags->set_mask) * tags->ways;
  bool has = set[0] == line + 1;
  for (uint32_t way = 1; way < tags->ways; way++) /* without branches that are hard to predict */
    has |= set[way] == line + 1;
  return has;
}

/* Returns the way that the next arriving line takes. */
static inline uint32_t trax_cache_tags_next(const struct trax_cache_tags *tags, size_t set) {
  switch (tags->policy) {
  case TRAX_REPLACE_FIFO:
    break;
  case TRAX_REPLACE_LRU:
    return tags->ways - 1;
  }
  return tags->next[set] & (tags->ways - 1);
}

/* Updates the policy's state: the line in `way` is used, or has arrived there. */
static inline void trax_cache_tags_note(struct trax_cache_tags *tags, size_t set, uint32_t way, bool arrived) {
  uint32_t *lines = tags->lines + set * tags->ways;
  const uint32_t line = lines[way];
  switch (tags->policy) {
  case TRAX_REPLACE_FIFO:
    if (arrived)
      tags->next[set] = (way + 1) & (tags->ways - 1);
    break;
  case TRAX_REPLACE_LRU: /* moves the line to the front */
    for (; way > 0; way--)
      lines[way] = lines[way - 1];
    lines[0] = line;
    break;
  }
}

/* Whether the cache has the line; counts as a use of it. */
static inline bool trax_cache_tags_use(struct trax_cache_tags *tags, uint32_t line) {
  if (!tags->by_use)
    return trax_cache_tags_have(tags, line);
  const size_t set = line & tags->set_mask;
  for (uint32_t way = 0; way < tags->ways; way++)
    if (tags->lines[set * tags->ways + way] == line + 1) {
      trax_cache_tags_note(tags, set, way, false);
      return true;
    }
  return false;
}

/* Drops all lines and returns their number. */
static inline uint32_t trax_cache_tags_drop(struct trax_cache_tags *tags) {
  const size_t places = ((size_t)tags->set_mask + 1) * tags->ways;
  uint32_t dropped = 0;
  for (size_t i = 0; i < places; i++)
    dropped += tags->lines[i] != 0;
  memset(tags->lines, 0, places * sizeof *tags->lines);
  return dropped;
}

/* Enters a line. Returns the number of the line that it replaces, + 1; 0: none. */
static inline uint32_t trax_cache_tags_install(struct trax_cache_tags *tags, uint32_t line) {
  const size_t set = line & tags->set_mask;
  const uint32_t way = trax_cache_tags_next(tags, set);
  uint32_t *place = tags->lines + set * tags->ways + way;
  const uint32_t evicted = *place;
  *place = line + 1;
  trax_cache_tags_note(tags, set, way, true);
  return evicted;
}

#endif
