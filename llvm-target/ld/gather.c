/* Input sections gathered in output sections by name, in the order that they have there (docs/abi.md). */
#include "ld.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static const char *const standard_names[] = {".text", ".rodata", ".data",       ".bss",
                                             ".tbss", ".tdata",  ".init_array", ".fini_array"};

/* ".text.f" goes to ".text". */
static const char *output_name(const ld_section *section) {
  if (!(section->flags & SHF_ALLOC))
    return section->name;
  if (strcmp(section->name, "COMMON") == 0)
    return ".bss";
  if (strcmp(section->name, ".tcommon") == 0)
    return ".tbss";
  for (size_t i = 0; i < sizeof standard_names / sizeof standard_names[0]; i++) {
    size_t length = strlen(standard_names[i]);
    if (strncmp(section->name, standard_names[i], length) == 0 && section->name[length] == '.')
      return standard_names[i];
  }
  return section->name;
}

static void add_to_output(ld_context *ctx, ld_map *by_name, ld_section *section) {
  const char *name = output_name(section);
  uint32_t flags = section->flags & ~(uint32_t)(SHF_GROUP | SHF_LINK_ORDER | SHF_GNU_RETAIN | SHF_INFO_LINK);
  const char *key = flags & SHF_ALLOC ? name : ld_format(ctx, "%s (unloaded)", name);
  uintptr_t *slot = ld_map_at(ctx, by_name, key, strlen(key));
  ld_output *output = (ld_output *)*slot;
  const uint32_t merge = SHF_MERGE | SHF_STRINGS;
  if (!output) {
    output = ld_alloc(ctx, sizeof *output);
    output->name = name;
    output->type = section->type;
    output->flags = flags;
    output->entry_size = section->entry_size;
    *slot = (uintptr_t)output;
    ld_push(ctx, &ctx->outputs, output);
  } else {
    if (((output->flags | flags) & (SHF_WRITE | SHF_EXECINSTR)) == (SHF_WRITE | SHF_EXECINSTR))
      ld_error(ctx, "%s:(%s): %s section among %s ones in %s", section->object->name, section->name,
               flags & SHF_WRITE ? "a writable" : "an executable", flags & SHF_WRITE ? "executable" : "writable", name);
    if ((output->flags ^ flags) & SHF_TLS)
      ld_error(ctx, "%s:(%s): %s thread-local, other sections in %s are%s", section->object->name, section->name,
               flags & SHF_TLS ? "is" : "is not", name, flags & SHF_TLS ? " not" : "");
    if (output->type != section->type)
      output->type = output->type == SHT_NOBITS    ? section->type
                     : section->type == SHT_NOBITS ? output->type
                                                   : SHT_PROGBITS;
    if (((output->flags ^ flags) & merge) || output->entry_size != section->entry_size) {
      output->flags &= ~merge;
      output->entry_size = 0;
      flags &= ~merge;
    }
    output->flags |= flags;
  }
  section->output = output;
  ld_push(ctx, &output->sections, section);
}

static ld_class class_of(const ld_output *output) {
  return !(output->flags & SHF_ALLOC)    ? LD_NOT_LOADED
         : output->flags & SHF_TLS       ? LD_THREAD_LOCAL
         : output->flags & SHF_EXECINSTR ? LD_CODE
         : !(output->flags & SHF_WRITE)  ? LD_CONSTANTS
                                         : LD_DATA;
}

static ld_order order_of(const ld_output *output) {
  if (output->class == LD_NOT_LOADED)
    return LD_CONTENTS;
  if (output->class == LD_DATA && output->type == SHT_INIT_ARRAY)
    return LD_CONSTRUCTORS;
  if (output->class == LD_DATA && output->type == SHT_FINI_ARRAY)
    return LD_DESTRUCTORS;
  return output->type == SHT_NOBITS ? LD_ZEROS : LD_CONTENTS;
}

/* --- order within an output section --- */

/* ".init_array.100" runs before ".init_array.200", plain ".init_array" last. Hot code is placed together, away from
   code that runs once or hardly ever: an instruction cache is small. */
static uint32_t section_order(const ld_section *section) {
  static const char *const text_order[] = {".text.hot", ".text", ".text.startup", ".text.exit", ".text.unlikely"};
  const size_t plain = 1;
  uint32_t priority;
  if (section->type == SHT_INIT_ARRAY || section->type == SHT_FINI_ARRAY) {
    const char *dot = strrchr(section->name, '.');
    if (dot && dot != section->name) {
      while (dot[1] == '0' && dot[2] != '\0')
        dot++; /* decimal in spite of leading zeros */
      if (ld_parse_number(dot + 1, &priority))
        return priority;
    }
    return UINT32_MAX;
  }
  for (uint32_t i = 0; i < sizeof text_order / sizeof text_order[0]; i++) {
    size_t length = strlen(text_order[i]);
    if (i != plain && strncmp(section->name, text_order[i], length) == 0 &&
        (section->name[length] == '.' || section->name[length] == '\0'))
      return i;
  }
  return plain;
}

typedef struct ordered {
  ld_section *section;
  uint64_t order; /* the class of the name, then the place in --symbol-ordering-file */
  size_t index;
} ordered;

static int compare_ordered(const void *left, const void *right) {
  const ordered *a = left, *b = right;
  if (a->order != b->order)
    return a->order < b->order ? -1 : 1;
  return a->index < b->index ? -1 : 1;
}

static void order_sections(ld_context *ctx, ld_output *output) {
  size_t count = output->sections.count;
  ordered *list = ld_alloc_array(ctx, count, sizeof *list);
  for (size_t i = 0; i < count; i++)
    list[i] = (ordered){output->sections.items[i], section_order(output->sections.items[i]), i};
  bool is_array = output->type == SHT_INIT_ARRAY || output->type == SHT_FINI_ARRAY; /* priorities come first */
  for (size_t i = 0; i < count; i++) {
    uint32_t place = list[i].section->wanted_place;
    list[i].order = place && !is_array ? place : list[i].order + (UINT64_C(1) << 32); /* after all that have a place */
  }
  qsort(list, count, sizeof *list, compare_ordered);
  for (size_t i = 0; i < count; i++)
    output->sections.items[i] = list[i].section;
}

int ld_compare_outputs(const void *left, const void *right) {
  const ld_output *a = *(ld_output *const *)left, *b = *(ld_output *const *)right;
  if (a->class != b->class)
    return a->class < b->class ? -1 : 1;
  if (a->order != b->order)
    return a->order < b->order ? -1 : 1;
  return a->header_index < b->header_index ? -1 : 1; /* first mention, for now */
}

static void place_sections(ld_context *ctx, ld_output *output) {
  uint64_t size = 0;
  output->alignment = 1;
  for (size_t i = 0; i < output->sections.count; i++) {
    ld_section *section = output->sections.items[i];
    section->output = output;
    size = ld_align(size, section->alignment);
    section->output_offset = (uint32_t)size;
    size += section->size;
    if (section->alignment > output->alignment)
      output->alignment = section->alignment;
    if (size > UINT32_MAX) {
      ld_error(ctx, "section %s is larger than the address space", output->name);
      return;
    }
  }
  output->size = (uint32_t)size;
}

/* Names in the order that --symbol-ordering-file wants; their sections come first in their output sections. */
static void read_order(ld_context *ctx) {
  const char *path = ctx->options.ordering_path;
  const uint8_t *bytes;
  size_t size;
  if (!path || !ld_read_file(ctx, path, &bytes, &size))
    return;
  ld_map places = {0}; /* name -> its line */
  uintptr_t line = 0;
  for (const char *at = (const char *)bytes, *end = at + size; at < end;) {
    const char *stop = memchr(at, '\n', (size_t)(end - at));
    size_t length = (size_t)((stop ? stop : end) - at);
    line++;
    while (length > 0 && isspace((unsigned char)at[length - 1]))
      length--;
    while (length > 0 && isspace((unsigned char)*at)) {
      at++;
      length--;
    }
    if (length > 0 && *at != '#') {
      uintptr_t *place = ld_map_at(ctx, &places, at, length);
      if (!*place)
        *place = line;
      const ld_symbol *symbol = ld_symbol_find(ctx, ld_format(ctx, "%.*s", (int)length, at));
      if (symbol && symbol->kind == LD_DEFINED && !symbol->section->wanted_place)
        symbol->section->wanted_place = (uint32_t)line;
    }
    if (!stop)
      break;
    at = stop + 1;
  }
  for (size_t o = 0; o < ctx->objects.count; o++) { /* local functions of that name, too */
    const ld_object *object = ctx->objects.items[o];
    for (size_t i = 1; i < object->symbol_count && i < object->first_global; i++) {
      const ld_symbol *symbol = object->symbols[i];
      uintptr_t place = symbol->kind == LD_DEFINED ? ld_map_find(&places, symbol->name, strlen(symbol->name)) : 0;
      if (place && !symbol->section->wanted_place)
        symbol->section->wanted_place = (uint32_t)place;
    }
  }
}

void ld_gather(ld_context *ctx) {
  read_order(ctx);
  ld_map by_name = {0};
  for (size_t i = 0; i < ctx->sections.count; i++)
    if (ctx->sections.items[i]->live)
      add_to_output(ctx, &by_name, ctx->sections.items[i]);
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    ld_output *output = ctx->outputs.items[i];
    output->class = class_of(output);
    output->order = order_of(output);
    output->header_index = (uint32_t)i;
    order_sections(ctx, output);
    ld_merge_output(ctx, output);
    place_sections(ctx, output);
  }
  if (ctx->outputs.count)
    qsort(ctx->outputs.items, ctx->outputs.count, sizeof *ctx->outputs.items, ld_compare_outputs);
  uint32_t headers = 1;
  for (size_t i = 0; i < ctx->outputs.count; i++) /* empty sections have an address but no header */
    ctx->outputs.items[i]->header_index = ctx->outputs.items[i]->size ? headers++ : 0;
}
