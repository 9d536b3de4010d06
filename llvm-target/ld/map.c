/* Reports on a finished link: the map (-Map) and the sizes (--print-memory-usage). */
#include "ld.h"

#include <stdlib.h>
#include <string.h>

static void print_members(const ld_context *ctx, FILE *out) {
  bool any = false;
  for (size_t i = 0; i < ctx->objects.count; i++) {
    const ld_object *object = ctx->objects.items[i];
    if (!object->taken_for)
      continue;
    if (!any)
      fputs("Archive members and what they were needed for\n\n", out);
    any = true;
    fprintf(out, "%s\n    %s, by %s\n", object->name, object->taken_for->name,
            object->taken_by ? object->taken_by->name : "the command line");
  }
  if (any)
    fputc('\n', out);
}

static void print_removed(const ld_context *ctx, FILE *out) {
  bool any = false;
  for (size_t i = 0; i < ctx->sections.count; i++) {
    const ld_section *section = ctx->sections.items[i];
    if (section->live || !(section->flags & SHF_ALLOC) || section->size == 0)
      continue;
    if (!any)
      fputs("Sections left out\n\n", out);
    any = true;
    fprintf(out, "%18x  %s:(%s)%s\n", section->size, section->object->name, section->name,
            section->discarded ? ", a copy of another" : ", unused");
  }
  if (any)
    fputc('\n', out);
}

typedef struct placed_symbol {
  const ld_symbol *symbol;
  uint32_t section; /* its ordinal in the image */
  uint32_t address;
  size_t index;
} placed_symbol;
typedef LD_VECTOR(placed_symbol) placed_list;

static int compare_placed(const void *left, const void *right) {
  const placed_symbol *a = left, *b = right;
  if (a->section != b->section)
    return a->section < b->section ? -1 : 1;
  if (a->address != b->address)
    return a->address < b->address ? -1 : 1;
  return a->index < b->index ? -1 : 1;
}

static void add_placed(ld_context *ctx, placed_list *list, const ld_symbol *symbol) {
  if (symbol->kind != LD_DEFINED || symbol->type == STT_SECTION || ld_symbol_is_dropped(symbol, 0) ||
      symbol->name[0] == '\0' || (symbol->binding == STB_LOCAL && ld_starts_with(symbol->name, ".L")))
    return;
  const ld_section *section = symbol->section->merged_into ? symbol->section->merged_into : symbol->section;
  placed_symbol placed = {symbol, section->ordinal, ld_symbol_address(ctx, symbol), list->count};
  ld_push(ctx, list, placed);
}

/* Symbols in the order of the image; numbers the sections. */
static void collect_placed(ld_context *ctx, placed_list *list) {
  uint32_t ordinal = 0;
  for (size_t i = 0; i < ctx->outputs.count; i++)
    for (size_t s = 0; s < ctx->outputs.items[i]->sections.count; s++)
      ctx->outputs.items[i]->sections.items[s]->ordinal = ordinal++;
  for (size_t o = 0; o < ctx->objects.count; o++) {
    const ld_object *object = ctx->objects.items[o];
    for (size_t i = 1; i < object->symbol_count && i < object->first_global; i++)
      add_placed(ctx, list, object->symbols[i]);
  }
  for (size_t i = 0; i < ctx->symbols.count; i++)
    add_placed(ctx, list, ctx->symbols.items[i]);
  if (list->count)
    qsort(list->items, list->count, sizeof *list->items, compare_placed);
}

static void print_image(ld_context *ctx, FILE *out) {
  placed_list placed = {0};
  collect_placed(ctx, &placed);
  size_t next = 0;
  fprintf(out, "%8s %8s %5s  %s\n", "Address", "Size", "Align", "Output section, input section, symbol");
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    const ld_output *output = ctx->outputs.items[i];
    if (output->size == 0)
      continue;
    fprintf(out, "%8x %8x %5u  %s\n", output->address, output->size, output->alignment, output->name);
    for (size_t s = 0; s < output->sections.count; s++) {
      const ld_section *section = output->sections.items[s];
      const char *file = section->object ? section->object->name : "(merged)";
      if (section->size)
        fprintf(out, "%8x %8x %5u      %s:(%s)\n", output->address + section->output_offset, section->size,
                section->alignment, file, section->name);
      while (next < placed.count && placed.items[next].section < section->ordinal)
        next++; /* of empty output sections */
      for (; next < placed.count && placed.items[next].section == section->ordinal; next++)
        fprintf(out, "%8x %8x %5s          %s\n", placed.items[next].address, placed.items[next].symbol->size, "",
                placed.items[next].symbol->name);
    }
  }
}

static void print_absolute(const ld_context *ctx, FILE *out) {
  bool any = false;
  for (size_t i = 0; i < ctx->symbols.count; i++) {
    const ld_symbol *symbol = ctx->symbols.items[i];
    if (symbol->kind != LD_ABSOLUTE && symbol->kind != LD_DEFSYM)
      continue;
    if (!any)
      fputs("\nAbsolute symbols and those of the linker\n\n", out);
    any = true;
    fprintf(out, "%8x                 %s\n", ld_symbol_address(ctx, symbol), symbol->name);
  }
}

bool ld_write_map(ld_context *ctx) {
  const char *path = ctx->options.map_path;
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out) {
    ld_error(ctx, "%s: no memory for the map", path);
    return false;
  }
  print_members(ctx, out);
  print_removed(ctx, out);
  print_image(ctx, out);
  print_absolute(ctx, out);
  if (ctx->stack_report)
    fprintf(out, "\n%s", ld_demangle(ctx, ctx->stack_report));
  fclose(out);
  const bool ok = ld_write_file(ctx, path, text, size, false);
  free(text);
  return ok;
}

void ld_print_memory_usage(const ld_context *ctx, FILE *out) {
  static const char *const labels[] = {"text", "read-only data", "data", "zeroed data"};
  uint32_t sizes[4] = {0};
  for (size_t i = 0; i < ctx->segments.count; i++) {
    const ld_segment *segment = &ctx->segments.items[i];
    if (segment->flags & PF_W) {
      sizes[2] += segment->file_size;
      sizes[3] += segment->memory_size - segment->file_size;
    } else {
      sizes[segment->flags & PF_X ? 0 : 1] += segment->memory_size;
    }
  }
  fputs("global memory\n", out);
  for (size_t i = 0; i < 4; i++)
    fprintf(out, "  %-16s %10u bytes\n", labels[i], sizes[i]);
  fprintf(out, "  %-16s %10u bytes, to 0x%x\n", "image", ctx->bounds.end - ctx->bounds.executable_start,
          ctx->bounds.end);
  fprintf(out, "local memory, %u bytes for each thread\n", TRAX_LOCAL_SIZE);
  fprintf(out, "  %-16s %10u bytes\n", "thread-local", ctx->local_size);
  bool global_stack = ld_symbol_find(ctx, "__trax_stack_size") != NULL;
  fprintf(out, "  %-16s %10llu bytes at %s%s\n", "stack", (unsigned long long)ctx->stack_depth,
          ctx->stack_is_bounded ? "most" : "least", global_stack ? ", in global memory" : "");
  int64_t left = (int64_t)TRAX_LOCAL_SIZE - ctx->local_size - (global_stack ? 0 : (int64_t)ctx->stack_depth);
  fprintf(out, "  %-16s %10lld bytes\n", "left", (long long)left);
  fprintf(out, "instruction cache, %u bytes\n  %-16s %10.1f %%\n", LD_INSTRUCTION_CACHE, "text",
          100.0 * sizes[0] / LD_INSTRUCTION_CACHE);
}
