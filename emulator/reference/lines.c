/* Sets, lines and replacement, which are the same in all caches (docs/timing.md, "Fetch"). */
#include "reference/reference.h"

#include <stdlib.h>

bool trax_ref_lines_create(struct trax_ref_lines *lines, uint32_t bytes, uint32_t line_bytes, uint32_t ways,
                           enum trax_replacement policy) {
  *lines = (struct trax_ref_lines){
      .line_bytes = line_bytes, .ways = ways, .sets = bytes / (line_bytes * ways), .policy = policy};
  lines->line = calloc((size_t)lines->sets * ways, sizeof *lines->line);
  lines->pointer = calloc(lines->sets, sizeof *lines->pointer);
  return lines->line && lines->pointer;
}

void trax_ref_lines_destroy(struct trax_ref_lines *lines) {
  free(lines->line);
  free(lines->pointer);
}

/* There is a power of two of sets. */
static uint32_t set_of(const struct trax_ref_lines *lines, uint32_t line) {
  return line & (lines->sets - 1);
}

static struct trax_ref_line *find(const struct trax_ref_lines *lines, uint32_t line) {
  struct trax_ref_line *set = &lines->line[(size_t)set_of(lines, line) * lines->ways];
  for (uint32_t way = 0; way < lines->ways; way++)
    if (set[way].present && set[way].number == line)
      return &set[way];
  return NULL;
}

bool trax_ref_lines_have(const struct trax_ref_lines *lines, uint32_t line) {
  return find(lines, line) != NULL;
}

bool trax_ref_lines_use(struct trax_ref_lines *lines, uint32_t line) {
  struct trax_ref_line *found = find(lines, line);
  if (found)
    found->used = ++lines->uses;
  return found != NULL;
}

static uint32_t first_in(struct trax_ref_lines *lines, uint32_t set) {
  const uint32_t way = lines->pointer[set];
  lines->pointer[set] = (way + 1) % lines->ways;
  return way;
}

static uint32_t least_recently_used(const struct trax_ref_lines *lines, uint32_t set) {
  const struct trax_ref_line *places = &lines->line[(size_t)set * lines->ways];
  uint32_t least = 0;
  for (uint32_t way = 0; way < lines->ways; way++) {
    if (!places[way].present)
      return way;
    if (places[way].used < places[least].used)
      least = way;
  }
  return least;
}

/* Returns the way that an arriving line takes. */
static uint32_t choose(struct trax_ref_lines *lines, uint32_t set) {
  switch (lines->policy) {
  case TRAX_REPLACE_FIFO:
    return first_in(lines, set);
  case TRAX_REPLACE_LRU:
    return least_recently_used(lines, set);
  }
  return 0;
}

uint32_t trax_ref_lines_drop(struct trax_ref_lines *lines) {
  uint32_t dropped = 0;
  for (uint32_t i = 0; i < lines->sets * lines->ways; i++) {
    dropped += lines->line[i].present;
    lines->line[i].present = false;
  }
  return dropped;
}

void trax_ref_lines_install(struct trax_ref_lines *lines, uint32_t line) {
  const uint32_t set = set_of(lines, line), way = choose(lines, set);
  lines->line[(size_t)set * lines->ways + way] = (struct trax_ref_line){true, line, ++lines->uses};
}
