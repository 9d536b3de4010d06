/* Sets, lines and their replacement, alike in all caches (docs/timing.md, "Fetch"). */
#include "reference/reference.h"

#include <stdlib.h>

bool trax_ref_lines_create(struct trax_ref_lines *lines, uint32_t bytes, uint32_t line_bytes, uint32_t ways) {
  *lines = (struct trax_ref_lines){.line_bytes = line_bytes, .ways = ways, .sets = bytes / (line_bytes * ways)};
  lines->line = calloc((size_t)lines->sets * ways, sizeof *lines->line);
  lines->pointer = calloc(lines->sets, sizeof *lines->pointer);
  return lines->line && lines->pointer;
}

void trax_ref_lines_destroy(struct trax_ref_lines *lines) {
  free(lines->line);
  free(lines->pointer);
}

bool trax_ref_lines_have(const struct trax_ref_lines *lines, uint32_t line) {
  const struct trax_ref_line *set = &lines->line[(size_t)(line % lines->sets) * lines->ways];
  for (uint32_t way = 0; way < lines->ways; way++)
    if (set[way].present && set[way].number == line)
      return true;
  return false;
}

void trax_ref_lines_take(struct trax_ref_lines *lines, uint32_t line) {
  const uint32_t set = line % lines->sets;
  lines->line[(size_t)set * lines->ways + lines->pointer[set]] = (struct trax_ref_line){true, line};
  lines->pointer[set] = (lines->pointer[set] + 1) % lines->ways;
}
