#include "explain/places.h"

#include "explain/texts.h"
#include "machine/timing.h"
#include "program/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FRAMES = 64 };

struct trax_places {
  const trax_machine *machine;
  struct trax_places_range *ranges;
  size_t range_count;
  uint32_t count;
  struct trax_place *place; /* [count + 2]; `frames` is NULL until the first look-up */
  trax_inst *inst;          /* [count + 2] */
  uint8_t *accesses;        /* [count + 2] */
  uint8_t *refusals;        /* [count + 2] */

  struct trax_texts names;
};

static enum trax_access_class access_of(trax_op op) {
  const unsigned flags = trax_op_table[op].flags;
  if (!trax_op_table[op].access_bytes)
    return TRAX_ACCESS_NONE;
  if (flags & (TRAX_IS_NONTEMPORAL | TRAX_IS_ATOMIC))
    return TRAX_ACCESS_PAST_CACHE;
  return flags & TRAX_IS_STORE ? TRAX_ACCESS_STORE : TRAX_ACCESS_LOAD;
}

static trax_cause refusal_of(trax_op op, const struct trax_config *config) {
  const trax_shared unit = trax_op_table[op].access_bytes ? TRAX_SHARED_NONE : trax_timing_of(op, config).unit;
  return unit == TRAX_SHARED_NONE ? TRAX_CAUSE_DCACHE_BANK : trax_shared_kind(unit, config).refused;
}

struct trax_places *trax_places_create(const trax_machine *machine) {
  struct trax_places *places = calloc(1, sizeof *places);
  if (!places)
    return NULL;
  places->machine = machine;
  places->ranges = calloc(machine->space.segment_count + 1, sizeof *places->ranges);
  for (size_t i = 0; places->ranges && i < machine->space.segment_count; i++) {
    const struct trax_segment *segment = &machine->space.segments[i];
    if (!(segment->permissions & TRAX_PERMIT_EXECUTE))
      continue;
    places->ranges[places->range_count++] =
        (struct trax_places_range){segment->address, segment->bytes / 4, places->count};
    places->count += segment->bytes / 4;
  }
  places->place = calloc((size_t)places->count + 2, sizeof *places->place);
  places->inst = calloc((size_t)places->count + 2, sizeof *places->inst);
  places->accesses = calloc((size_t)places->count + 2, sizeof *places->accesses);
  places->refusals = calloc((size_t)places->count + 2, sizeof *places->refusals);
  if (!places->ranges || !places->place || !places->inst || !places->accesses || !places->refusals) {
    trax_places_destroy(places);
    return NULL;
  }
  for (uint32_t i = 0; i < places->count; i++) {
    uint32_t word;
    memcpy(&word, machine->space.bytes + trax_places_pc(places, i), sizeof word);
    places->inst[i] = trax_decode(word);
    places->accesses[i] = (uint8_t)access_of(places->inst[i].op);
    places->refusals[i] = (uint8_t)refusal_of(places->inst[i].op, &machine->config);
  }
  return places;
}

void trax_places_destroy(struct trax_places *places) {
  if (!places)
    return;
  for (uint32_t i = 0; places->place && i < places->count + 2; i++)
    free((void *)places->place[i].frames);
  trax_texts_free(&places->names);
  free(places->ranges);
  free(places->place);
  free(places->inst);
  free(places->accesses);
  free(places->refusals);
  free(places);
}

uint32_t trax_places_count(const struct trax_places *places) {
  return places->count;
}

const struct trax_places_range *trax_places_range(const struct trax_places *places, uint32_t pc) {
  for (size_t i = 0; i < places->range_count; i++)
    if ((pc - places->ranges[i].address) / 4 < places->ranges[i].count)
      return &places->ranges[i];
  return NULL;
}

uint32_t trax_places_index(const struct trax_places *places, uint32_t pc) {
  const struct trax_places_range *range = NULL;
  return trax_places_index_again(places, pc, &range);
}

uint32_t trax_places_pc(const struct trax_places *places, uint32_t index) {
  for (size_t i = 0; i < places->range_count; i++)
    if (index - places->ranges[i].first < places->ranges[i].count)
      return places->ranges[i].address + 4 * (index - places->ranges[i].first);
  return 0;
}

const trax_inst *trax_places_inst(const struct trax_places *places, uint32_t index) {
  return &places->inst[index];
}

const uint8_t *trax_places_accesses(const struct trax_places *places) {
  return places->accesses;
}

const uint8_t *trax_places_refusals(const struct trax_places *places) {
  return places->refusals;
}

/* --- names --- */

const char *trax_places_name(const struct trax_places *places, uint32_t name) {
  return trax_texts_at(&places->names, name);
}

uint32_t trax_places_names(const struct trax_places *places) {
  return (uint32_t)places->names.count;
}

static uint32_t intern(struct trax_places *places, const char *text) {
  return trax_texts_number(&places->names, text);
}

static uint32_t intern_line(struct trax_places *places, const struct trax_source_line *line) {
  if (!line->file || !line->line)
    return 0;
  char text[1024];
  snprintf(text, sizeof text, "%s:%d", line->file, line->line);
  return intern(places, text);
}

/* --- look-up --- */

static uint32_t function_name(struct trax_places *places, uint32_t pc, const struct trax_symbol *symbol,
                              const struct trax_source_line *line) {
  char text[32];
  if (line && line->function)
    return intern(places, line->function);
  if (symbol)
    return intern(places, symbol->name);
  snprintf(text, sizeof text, "0x%08x", pc & ~0xFFFu); /* unknown functions are grouped by their page */
  return intern(places, text);
}

static void look_up(struct trax_places *places, uint32_t index, struct trax_place *place) {
  const struct trax_loaded *loaded = trax_loaded_of(places->machine);
  struct trax_source_line lines[MAX_FRAMES];
  struct trax_frame_place *frames;
  size_t count = 0;
  if (index >= places->count) {
    if (!(frames = malloc(sizeof *frames)))
      return;
    *frames = (struct trax_frame_place){intern(places, index == places->count ? "(halted)" : "(outside)"), 0};
    place->frames = frames;
    place->frame_count = 1;
    return;
  }
  const uint32_t pc = trax_places_pc(places, index);
  const struct trax_symbol *symbol = loaded ? trax_image_symbol_at(loaded->image, pc) : NULL;
  if (symbol) {
    place->symbol = symbol->name;
    place->offset = pc - symbol->address;
  }
  if (loaded)
    count = trax_image_lines(loaded->image, pc, lines, MAX_FRAMES);
  if (!(frames = calloc(count ? count : 1, sizeof *frames)))
    return;
  for (size_t i = 0; i < count; i++)
    frames[i] = (struct trax_frame_place){function_name(places, pc, symbol, &lines[i]), intern_line(places, &lines[i])};
  if (!count)
    frames[0].function = function_name(places, pc, symbol, NULL);
  place->frames = frames;
  place->frame_count = count ? (uint32_t)count : 1;
}

const struct trax_place *trax_places_at(struct trax_places *places, uint32_t index) {
  static const struct trax_frame_place nowhere = {0, 0};
  static const struct trax_place unknown = {.frames = &nowhere, .frame_count = 1}; /* no memory to look it up */
  struct trax_place *place = &places->place[index < places->count + 2 ? index : places->count + 1];
  if (!place->frames)
    look_up(places, index, place);
  return place->frames ? place : &unknown;
}

const char *trax_places_symbol(struct trax_places *places, uint32_t pc, char *text, size_t size) {
  const struct trax_place *place = trax_places_at(places, trax_places_index(places, pc));
  if (!place->symbol)
    snprintf(text, size, "0x%08x", pc);
  else if (place->offset)
    snprintf(text, size, "%s+0x%x", place->symbol, place->offset);
  else
    snprintf(text, size, "%s", place->symbol);
  return text;
}
