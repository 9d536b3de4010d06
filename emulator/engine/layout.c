#include "engine/layout.h"

#include "machine/stats.h"
#include "machine/text.h"
#include "state_sources.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

struct layouts {
  struct trax_layout *entries; /* [count] */
  size_t count;
};

/* FNV-1a. */
static void add_bytes(struct trax_layout *layout, const void *bytes, size_t size) {
  for (const uint8_t *byte = bytes; size--; byte++)
    layout->hash = (layout->hash ^ *byte) * 0x100000001B3u;
}

static void add_text(struct trax_layout *layout, const char *text) {
  add_bytes(layout, text, strlen(text) + 1);
}

/* Adds an entry. NULL: there is one of that name already. */
static struct trax_layout *new_entry(struct layouts *layouts, const char *name) {
  for (size_t i = 0; i < layouts->count; i++)
    if (strncmp(layouts->entries[i].name, name, sizeof layouts->entries[i].name - 1) == 0)
      return NULL;
  assert(layouts->count < TRAX_MOST_LAYOUTS);
  struct trax_layout *layout = &layouts->entries[layouts->count++];
  *layout = (struct trax_layout){.hash = 0xCBF29CE484222325u};
  snprintf(layout->name, sizeof layout->name, "%s", name);
  return layout;
}

static void add_section(void *context, const struct trax_section *section) {
  struct layouts *layouts = context;
  struct trax_layout *layout = section->field_count ? new_entry(layouts, section->name) : NULL;
  for (size_t i = 0; layout && i < section->field_count; i++) {
    const uint64_t size = section->fields[i].size;
    add_text(layout, section->fields[i].type);
    add_text(layout, section->fields[i].name);
    add_bytes(layout, &size, sizeof size);
  }
}

size_t trax_layout_of(const struct trax_engine *engine, void *chip, struct trax_layout *entries) {
  struct layouts layouts = {.entries = entries};
  engine->visit(chip, add_section, &layouts);
  struct trax_layout *operations = new_entry(&layouts, "operations"), *causes = new_entry(&layouts, "causes");
  for (unsigned op = 0; op < TRAX_OP_COUNT; op++)
    add_text(operations, trax_op_table[op].mnemonic);
#define CAUSE(ID, NAME, ...) add_text(causes, NAME);
  TRAX_CAUSES(CAUSE)
#undef CAUSE
  /* The rest: orders of other enumerations, and what fields mean. It is last, so that a known difference is named. */
  *new_entry(&layouts, "sources") = (struct trax_layout){.name = "sources", .hash = TRAX_STATE_SOURCES};
  return layouts.count;
}
