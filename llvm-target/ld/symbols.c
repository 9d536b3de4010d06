/* Symbol resolution. A name has one ld_symbol; each mention of it, in link order, can only improve it:

     undefined < lazy < weak definition < common < strong definition

   Two common symbols make one of the larger size and alignment; two strong definitions are an error. A strong reference
   to a lazy symbol takes its archive member, wherever the archive stood on the command line. */
#include "ld.h"

#include <string.h>

ld_symbol *ld_symbol_find(const ld_context *ctx, const char *name) {
  return (ld_symbol *)ld_map_find(&ctx->symbol_map, name, strlen(name));
}

static ld_symbol *intern(ld_context *ctx, const char *name) {
  uintptr_t *slot = ld_map_at(ctx, &ctx->symbol_map, name, strlen(name));
  if (*slot)
    return (ld_symbol *)*slot;
  ld_symbol *symbol = ld_alloc(ctx, sizeof *symbol);
  *slot = (uintptr_t)symbol;
  symbol->name = name;
  symbol->kind = LD_UNDEFINED;
  symbol->binding = STB_WEAK; /* until a reference is strong */
  ld_push(ctx, &ctx->symbols, symbol);
  return symbol;
}

static void extract(ld_context *ctx, ld_symbol *symbol, const ld_object *by) {
  ld_object *object = symbol->object;
  symbol->kind = LD_UNDEFINED;
  symbol->object = NULL;
  if (object->taken)
    return;
  object->taken = true;
  object->taken_for = symbol;
  object->taken_by = by;
  ld_push(ctx, &ctx->pending, object);
}

static void refer(ld_context *ctx, ld_symbol *symbol, ld_object *by, bool weak) {
  symbol->referenced = true;
  if (symbol->kind == LD_LAZY && !weak)
    extract(ctx, symbol, by);
  if (symbol->kind == LD_UNDEFINED && !symbol->object)
    symbol->object = by;
  if ((symbol->kind == LD_UNDEFINED || symbol->kind == LD_LAZY) && !weak)
    symbol->binding = STB_GLOBAL;
}

/* A reference by the command line. */
static void require(ld_context *ctx, const char *name) {
  refer(ctx, intern(ctx, name), NULL, false);
}

void ld_symbols_offer(ld_context *ctx, const char *name) {
  ld_symbol *symbol = ld_symbol_find(ctx, name);
  if (symbol && symbol->kind == LD_LAZY)
    extract(ctx, symbol, NULL);
}

void ld_symbols_add_lazy(ld_context *ctx, ld_object *object) {
  for (size_t i = object->first_global; i < object->symbol_count && !object->taken; i++) {
    const Elf32_Sym *raw = &object->raw_symbols[i];
    if (raw->st_shndx == SHN_UNDEF)
      continue;
    const char *name = ld_object_symbol_name(ctx, object, i);
    if (!name)
      return;
    ld_symbol *symbol = intern(ctx, name);
    if (symbol->kind != LD_UNDEFINED)
      continue;
    const ld_object *referrer = symbol->object;
    bool needed = symbol->referenced && symbol->binding != STB_WEAK;
    symbol->kind = LD_LAZY;
    symbol->object = object;
    if (needed)
      extract(ctx, symbol, referrer);
  }
}

static int strength(const ld_symbol *symbol) {
  switch (symbol->kind) {
  case LD_UNDEFINED:
  case LD_LAZY:
    return 0;
  case LD_COMMON:
    return 2;
  default:
    return symbol->binding == STB_WEAK ? 1 : 3;
  }
}

static const char *definition_place(ld_context *ctx, const ld_symbol *symbol) {
  if (symbol->kind == LD_DEFINED)
    return ld_place(ctx, symbol->section, symbol->value);
  return ld_format(ctx, "%s:(absolute)", symbol->object->name);
}

/* The most constraining of the visibilities wins: internal, hidden, protected, default (the gABI, "Symbol Table"). But
   for default, which is 0, their numbers are in that order. */
static void constrain(ld_symbol *symbol, uint8_t visibility) {
  if (symbol->visibility == STV_DEFAULT || (visibility != STV_DEFAULT && visibility < symbol->visibility))
    symbol->visibility = visibility;
}

/* fresh is a definition; name and reference counts stay those of symbol. */
static void define(ld_context *ctx, ld_symbol *symbol, ld_symbol fresh) {
  constrain(symbol, fresh.visibility); /* even if another definition counts */
  if (symbol->kind == LD_DEFSYM)
    return; /* the command line takes precedence */
  int old_strength = strength(symbol), new_strength = strength(&fresh);
  if (old_strength == 3 && new_strength == 3) {
    if (ctx->options.allow_multiple_definition)
      return;
    ld_error(ctx, "%s: duplicate symbol '%s', first defined at %s", definition_place(ctx, &fresh), symbol->name,
             definition_place(ctx, symbol));
    return;
  }
  if (old_strength == 2 && new_strength == 2) {
    if (fresh.value > symbol->value)
      symbol->value = fresh.value;
    if (fresh.size > symbol->size)
      symbol->size = fresh.size;
    return;
  }
  if (new_strength <= old_strength)
    return;
  fresh.name = symbol->name;
  fresh.referenced = symbol->referenced;
  fresh.visibility = symbol->visibility;
  *symbol = fresh;
}

/* A symbol's kind, section and value from its entry; false after an error message. An undefined one has LD_UNDEFINED,
   one defined in a section that is not linked has it too, with that section. */
static bool read_symbol(ld_context *ctx, ld_object *object, size_t index, ld_symbol *symbol) {
  const Elf32_Sym *raw = &object->raw_symbols[index];
  *symbol = (ld_symbol){.name = ld_object_symbol_name(ctx, object, index),
                        .kind = LD_UNDEFINED,
                        .binding = ELF32_ST_BIND(raw->st_info),
                        .type = ELF32_ST_TYPE(raw->st_info),
                        .visibility = ELF32_ST_VISIBILITY(raw->st_other),
                        .object = object,
                        .value = raw->st_value,
                        .size = raw->st_size};
  if (!symbol->name)
    return false;
  if (symbol->type == STT_GNU_IFUNC) {
    ld_error(ctx, "%s: '%s' is an indirect function, which nothing resolves at start", object->name, symbol->name);
    return false;
  }
  bool reserved;
  uint32_t section = ld_object_symbol_section(object, index, &reserved);
  if (reserved && section == SHN_ABS) {
    symbol->kind = LD_ABSOLUTE;
  } else if (reserved && section == SHN_COMMON) {
    symbol->kind = LD_COMMON;
    if (symbol->value == 0 || (symbol->value & (symbol->value - 1)) || symbol->value > LD_MAX_ALIGNMENT) {
      ld_error(ctx, "%s: common symbol '%s' has the alignment %u", object->name, symbol->name, symbol->value);
      return false;
    }
  } else if (reserved || section >= object->section_count) {
    ld_error(ctx, "%s: symbol '%s' is in section %u of %zu", object->name, symbol->name, section,
             object->section_count);
    return false;
  } else if (section != SHN_UNDEF) {
    symbol->section = object->sections[section];
    symbol->kind = symbol->section->discarded ? LD_UNDEFINED : LD_DEFINED;
  }
  return true;
}

static bool add_local(ld_context *ctx, ld_object *object, size_t index, ld_symbol *symbol) {
  if (!read_symbol(ctx, object, index, symbol))
    return false;
  if (symbol->binding != STB_LOCAL) {
    ld_error(ctx, "%s: symbol '%s' is global but stands among the local ones", object->name, symbol->name);
    return false;
  }
  if (symbol->kind == LD_COMMON || (symbol->kind == LD_UNDEFINED && !symbol->section)) {
    ld_error(ctx, "%s: local symbol '%s' is %s", object->name, symbol->name,
             symbol->kind == LD_COMMON ? "common" : "undefined");
    return false;
  }
  if (symbol->kind == LD_UNDEFINED)
    symbol->kind = LD_DEFINED; /* and dropped */
  object->symbols[index] = symbol;
  return true;
}

static bool add_global(ld_context *ctx, ld_object *object, size_t index) {
  ld_symbol fresh;
  if (!read_symbol(ctx, object, index, &fresh))
    return false;
  if (fresh.binding == STB_GNU_UNIQUE)
    fresh.binding = STB_GLOBAL;
  if (fresh.binding != STB_GLOBAL && fresh.binding != STB_WEAK) {
    ld_error(ctx, "%s: symbol '%s' has the binding %u, not global or weak", object->name, fresh.name, fresh.binding);
    return false;
  }
  bool weak = fresh.binding == STB_WEAK;
  if (fresh.kind != LD_UNDEFINED) {
    ld_symbol *symbol = object->symbols[index] = intern(ctx, fresh.name);
    define(ctx, symbol, fresh);
    return true;
  }
  const char *name = (const char *)ld_map_find(&ctx->wrapped, fresh.name, strlen(fresh.name));
  ld_symbol *symbol = object->symbols[index] = intern(ctx, name ? name : fresh.name);
  refer(ctx, symbol, object, weak);
  constrain(symbol, fresh.visibility);
  return true;
}

bool ld_symbols_add(ld_context *ctx, ld_object *object) {
  ld_symbol **symbols = ld_alloc_array(ctx, object->symbol_count + 1, sizeof *symbols);
  ld_symbol *locals = ld_alloc_array(ctx, object->first_global + 1, sizeof *locals);
  object->symbols = symbols;
  symbols[0] = &locals[0];
  locals[0] = (ld_symbol){.name = "", .kind = LD_ABSOLUTE, .object = object};
  bool ok = true;
  for (size_t i = 1; i < object->symbol_count; i++) {
    if (!(i < object->first_global ? add_local(ctx, object, i, &locals[i]) : add_global(ctx, object, i)))
      ok = false;
  }
  return ok;
}

/* --- before the first input --- */

static void add_wrapped(ld_context *ctx, const char *name) {
  const char *real = ld_format(ctx, "__real_%s", name);
  *ld_map_at(ctx, &ctx->wrapped, name, strlen(name)) = (uintptr_t)ld_format(ctx, "__wrap_%s", name);
  *ld_map_at(ctx, &ctx->wrapped, real, strlen(real)) = (uintptr_t)name;
}

void ld_start_symbols(ld_context *ctx) {
  const ld_options *options = &ctx->options;
  uint32_t address;
  for (size_t i = 0; i < options->wrapped.count; i++)
    add_wrapped(ctx, options->wrapped.items[i]);
  for (size_t i = 0; i < options->defsyms.count; i++) {
    ld_symbol *symbol = intern(ctx, options->defsyms.items[i].name);
    *symbol = (ld_symbol){.name = symbol->name, .kind = LD_DEFSYM, .binding = STB_GLOBAL, .value = (uint32_t)i};
  }
  if (!ld_parse_number(options->entry, &address))
    require(ctx, options->entry);
  for (size_t i = 0; i < options->undefined.count; i++)
    require(ctx, options->undefined.items[i]);
  for (size_t i = 0; i < options->defsyms.count; i++)
    if (options->defsyms.items[i].base)
      require(ctx, options->defsyms.items[i].base);
}

/* --- when all inputs are read --- */

/* Sections for common symbols, each of its own, so that garbage collection sees them. */
static void place_common(ld_context *ctx, ld_symbol *symbol) {
  ld_section *section = ld_alloc(ctx, sizeof *section);
  bool local = symbol->type == STT_TLS;
  section->object = symbol->object;
  section->name = local ? ".tcommon" : "COMMON";
  section->type = SHT_NOBITS;
  section->flags = SHF_ALLOC | SHF_WRITE | (local ? SHF_TLS : 0);
  section->alignment = symbol->value;
  section->size = symbol->size;
  ld_push(ctx, &ctx->sections, section);
  symbol->kind = LD_DEFINED;
  symbol->type = local ? STT_TLS : STT_OBJECT;
  symbol->section = section;
  symbol->value = 0;
}

static const struct {
  const char *name;
  size_t offset;
} boundaries[] = {
    {"__executable_start", offsetof(ld_bounds, executable_start)},
    {"_end", offsetof(ld_bounds, end)},
    {"end", offsetof(ld_bounds, end)},
    {"_etext", offsetof(ld_bounds, text_end)},
    {"etext", offsetof(ld_bounds, text_end)},
    {"_edata", offsetof(ld_bounds, bss_start)},
    {"edata", offsetof(ld_bounds, bss_start)},
    {"__text_start", offsetof(ld_bounds, text_start)},
    {"__text_end", offsetof(ld_bounds, text_end)},
    {"__init_array_start", offsetof(ld_bounds, init_array_start)},
    {"__init_array_end", offsetof(ld_bounds, init_array_end)},
    {"__fini_array_start", offsetof(ld_bounds, fini_array_start)},
    {"__fini_array_end", offsetof(ld_bounds, fini_array_end)},
    {"__bss_start", offsetof(ld_bounds, bss_start)},
    {"__bss_end", offsetof(ld_bounds, bss_end)},
    {"__tdata_start", offsetof(ld_bounds, tdata_start)},
    {"__tdata_end", offsetof(ld_bounds, tdata_end)},
    {"__tdata_load", offsetof(ld_bounds, tdata_load)},
    {"__tbss_start", offsetof(ld_bounds, tbss_start)},
    {"__tbss_end", offsetof(ld_bounds, tbss_end)},
};

/* __start_NAME and __stop_NAME exist where a section is called NAME. */
const char *ld_boundary_section(const char *symbol) {
  if (ld_starts_with(symbol, "__start_"))
    return symbol + strlen("__start_");
  return ld_starts_with(symbol, "__stop_") ? symbol + strlen("__stop_") : NULL;
}

static bool section_exists(const ld_context *ctx, const char *name) {
  for (size_t i = 0; i < ctx->sections.count; i++)
    if (!ctx->sections.items[i]->discarded && strcmp(ctx->sections.items[i]->name, name) == 0)
      return true;
  return false;
}

static void make_boundary(ld_symbol *symbol, uint32_t value) {
  *symbol = (ld_symbol){.name = symbol->name,
                        .kind = LD_BOUNDARY,
                        .binding = STB_GLOBAL,
                        .visibility = symbol->visibility,
                        .referenced = true,
                        .value = value};
}

static void define_boundaries(ld_context *ctx) {
  for (size_t i = 0; i < sizeof boundaries / sizeof boundaries[0]; i++) {
    ld_symbol *symbol = ld_symbol_find(ctx, boundaries[i].name);
    if (symbol && symbol->kind == LD_UNDEFINED) {
      make_boundary(symbol, (uint32_t)boundaries[i].offset);
    }
  }
  for (size_t i = 0; i < ctx->symbols.count; i++) {
    ld_symbol *symbol = ctx->symbols.items[i];
    const char *section = symbol->kind == LD_UNDEFINED ? ld_boundary_section(symbol->name) : NULL;
    if (section && section_exists(ctx, section))
      make_boundary(symbol, LD_BOUNDARY_SECTION);
  }
}

/* Definitions by the command line must lead to a definition elsewhere. */
static void check_defsyms(ld_context *ctx) {
  const ld_options *options = &ctx->options;
  for (size_t i = 0; i < options->defsyms.count; i++) {
    const ld_defsym *defsym = &options->defsyms.items[i];
    size_t steps = 0;
    while (defsym && defsym->base && steps++ < options->defsyms.count) {
      const ld_symbol *base = ld_symbol_find(ctx, defsym->base);
      if (base->kind == LD_UNDEFINED)
        ld_error(ctx, "--defsym=%s: symbol '%s' is undefined", options->defsyms.items[i].name, defsym->base);
      defsym = base->kind == LD_DEFSYM ? &options->defsyms.items[base->value] : NULL;
    }
    if (defsym && defsym->base)
      ld_error(ctx, "--defsym=%s: is defined by itself", options->defsyms.items[i].name);
  }
}

bool ld_finish_symbols(ld_context *ctx) {
  for (size_t i = 0; i < ctx->symbols.count; i++) {
    ld_symbol *symbol = ctx->symbols.items[i];
    if (symbol->kind == LD_LAZY) { /* at most weak references */
      symbol->kind = LD_UNDEFINED;
      symbol->object = NULL;
      symbol->in_archive = true;
    } else if (symbol->kind == LD_COMMON) {
      place_common(ctx, symbol);
    }
  }
  define_boundaries(ctx);
  check_defsyms(ctx);
  return ctx->error_count == 0;
}

void ld_place_boundaries(ld_context *ctx) {
  for (size_t i = 0; i < ctx->symbols.count; i++) {
    ld_symbol *symbol = ctx->symbols.items[i];
    if (symbol->kind != LD_BOUNDARY)
      continue;
    symbol->kind = LD_ABSOLUTE;
    if (symbol->value != LD_BOUNDARY_SECTION) {
      memcpy(&symbol->value, (const char *)&ctx->bounds + symbol->value, sizeof symbol->value);
      continue;
    }
    const ld_output *output = ld_output_find(ctx, ld_boundary_section(symbol->name));
    symbol->value = !output                                   ? 0
                    : ld_starts_with(symbol->name, "__stop_") ? output->address + output->size
                                                              : output->address;
  }
}

uint32_t ld_symbol_offset(const ld_symbol *symbol, int32_t addend) {
  return symbol->value + (symbol->type == STT_SECTION ? (uint32_t)addend : 0);
}

bool ld_symbol_is_dropped(const ld_symbol *symbol, int32_t addend) {
  if (symbol->kind != LD_DEFINED)
    return false;
  const ld_section *section = symbol->section;
  if (section->discarded || !section->live)
    return true;
  const ld_piece *piece = section->pieces ? ld_find_piece(section, ld_symbol_offset(symbol, addend)) : NULL;
  return piece && !piece->live;
}

uint32_t ld_symbol_address(const ld_context *ctx, const ld_symbol *symbol) {
  switch (symbol->kind) {
  case LD_ABSOLUTE:
    return symbol->value;
  case LD_DEFSYM: {
    const ld_defsym *defsym = &ctx->options.defsyms.items[symbol->value];
    const ld_symbol *base = defsym->base ? ld_symbol_find(ctx, defsym->base) : NULL;
    return (base ? ld_symbol_address(ctx, base) : 0) + defsym->offset;
  }
  case LD_DEFINED:
    return ld_symbol_is_dropped(symbol, 0) ? 0 : ld_section_address(symbol->section, symbol->value);
  default:
    return 0;
  }
}
