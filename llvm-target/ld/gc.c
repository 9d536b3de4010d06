/* Liveness. Without --gc-sections everything that was not discarded is live. With it, a section of the memory image
   lives if a chain of relocations leads to it from the entry, from -u and --defsym, from constructors and destructors,
   or from a section marked to be retained. Debug information follows along and keeps nothing alive. */
#include "ld.h"

#include <string.h>

typedef struct marker {
  ld_context *ctx;
  LD_VECTOR(ld_section *) work;
} marker;

static void mark_section(marker *marker, ld_section *section) {
  if (!section || section->live || section->discarded)
    return;
  section->live = true;
  ld_push(marker->ctx, &marker->work, section);
}

static void mark_named(marker *marker, const char *name) {
  for (size_t i = 0; i < marker->ctx->sections.count; i++)
    if (strcmp(marker->ctx->sections.items[i]->name, name) == 0)
      mark_section(marker, marker->ctx->sections.items[i]);
}

static void mark_symbol(marker *marker, const ld_symbol *symbol, int32_t addend) {
  ld_context *ctx = marker->ctx;
  if (symbol->kind == LD_DEFSYM) {
    const ld_defsym *defsym = &ctx->options.defsyms.items[symbol->value];
    if (defsym->base)
      mark_symbol(marker, ld_symbol_find(ctx, defsym->base), 0);
  } else if (symbol->kind == LD_BOUNDARY && symbol->value == LD_BOUNDARY_SECTION) {
    mark_named(marker, ld_boundary_section(symbol->name));
  } else if (symbol->kind == LD_DEFINED) {
    ld_section *section = symbol->section;
    if (section->pieces) {
      ld_piece *piece = ld_find_piece(section, ld_symbol_offset(symbol, addend));
      if (piece)
        piece->live = true;
    }
    mark_section(marker, section);
  }
}

static void mark_name(marker *marker, const char *name) {
  const ld_symbol *symbol = ld_symbol_find(marker->ctx, name);
  if (symbol)
    mark_symbol(marker, symbol, 0);
}

static bool is_root(const ld_section *section) {
  if (section->flags & SHF_GNU_RETAIN)
    return true;
  switch (section->type) {
  case SHT_INIT_ARRAY:
  case SHT_FINI_ARRAY:
  case SHT_PREINIT_ARRAY:
  case SHT_NOTE:
    return !section->group_next;
  default:
    return strcmp(section->name, ".init") == 0 || strcmp(section->name, ".fini") == 0;
  }
}

static void keep_all_pieces(ld_section *section) {
  for (uint32_t i = 0; i < section->piece_count; i++)
    section->pieces[i].live = true;
}

static void mark_all(ld_context *ctx) {
  for (size_t i = 0; i < ctx->sections.count; i++) {
    ld_section *section = ctx->sections.items[i];
    section->live = !section->discarded;
    keep_all_pieces(section);
  }
}

static void mark_roots(marker *marker) {
  ld_context *ctx = marker->ctx;
  mark_name(marker, ctx->options.entry);
  for (size_t i = 0; i < ctx->options.undefined.count; i++)
    mark_name(marker, ctx->options.undefined.items[i]);
  for (size_t i = 0; i < ctx->options.defsyms.count; i++)
    mark_name(marker, ctx->options.defsyms.items[i].name);
  for (size_t i = 0; i < ctx->sections.count; i++) {
    ld_section *section = ctx->sections.items[i];
    if (!(section->flags & SHF_ALLOC)) {
      keep_all_pieces(section);
      if (!section->group_next && !(section->flags & SHF_LINK_ORDER) && !section->discarded)
        section->live = true; /* and nothing that it refers to */
    }
    if (is_root(section)) {
      keep_all_pieces(section);
      mark_section(marker, section);
    }
  }
}

static void trace(marker *marker) {
  for (size_t i = 0; i < marker->work.count; i++) {
    ld_section *section = marker->work.items[i];
    if (section->flags & SHF_ALLOC)
      for (uint32_t r = 0; r < section->reloc_count; r++)
        mark_symbol(marker, section->relocs[r].symbol, section->relocs[r].addend);
    mark_section(marker, section->group_next);
    for (ld_section *dependent = section->first_dependent; dependent; dependent = dependent->next_dependent)
      mark_section(marker, dependent);
  }
}

/* Drops the compiler's stack sizes with the debug information. The linker itself still reads them. */
static void drop_stack_sizes(ld_context *ctx) {
  for (size_t i = 0; ctx->options.strip_debug && i < ctx->sections.count; i++)
    if (strcmp(ctx->sections.items[i]->name, ".stack_sizes") == 0)
      ctx->sections.items[i]->live = false;
}

void ld_mark_live(ld_context *ctx) {
  if (!ctx->options.gc_sections) {
    mark_all(ctx);
    drop_stack_sizes(ctx);
    return;
  }
  marker marker = {.ctx = ctx};
  mark_roots(&marker);
  trace(&marker);
  drop_stack_sizes(ctx);
  for (size_t i = 0; ctx->options.print_gc_sections && i < ctx->sections.count; i++) {
    const ld_section *section = ctx->sections.items[i];
    if (!section->live && !section->discarded && (section->flags & SHF_ALLOC))
      printf("removing unused section %s:(%s)\n", section->object->name, section->name);
  }
}
