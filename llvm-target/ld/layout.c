/* The image's layout (docs/abi.md): output sections in three segments, R-X, R-- and RW-, in ascending addresses from
   options.text_start; thread-local data in local memory; the rest has no address. */
#include "ld.h"

#include <stdlib.h>
#include <string.h>

ld_output *ld_output_find(const ld_context *ctx, const char *name) {
  for (size_t i = 0; i < ctx->outputs.count; i++)
    if (strcmp(ctx->outputs.items[i]->name, name) == 0)
      return ctx->outputs.items[i];
  return NULL;
}

/* Places the initial values of thread-local data after the constants, from at on; each thread copies them into its
   local memory. Returns their end, 0 if there are none. */
static uint64_t place_initial_values(ld_context *ctx, uint64_t at) {
  bool any = false;
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    ld_output *output = ctx->outputs.items[i];
    if (output->class != LD_THREAD_LOCAL || output->type == SHT_NOBITS || output->size == 0)
      continue;
    at = ld_align(at, output->alignment < 4 ? 4 : output->alignment);
    output->load_address = (uint32_t)at;
    at = ld_align(at + output->size, 4); /* they are copied as words */
    any = true;
  }
  return any ? at : 0;
}

static const ld_section_start *find_start(const ld_context *ctx, const char *name) {
  for (size_t i = ctx->options.section_starts.count; i-- > 0;) /* the last one counts */
    if (strcmp(ctx->options.section_starts.items[i].name, name) == 0)
      return &ctx->options.section_starts.items[i];
  return NULL;
}

/* Ends a segment at the sections that were placed in it. Returns the first free address. */
static uint64_t close_segment(ld_context *ctx, ld_segment segment, uint64_t file_end, uint64_t memory_end) {
  segment.file_size = (uint32_t)(file_end - segment.address);
  segment.memory_size = (uint32_t)(memory_end - segment.address);
  if (segment.memory_size)
    ld_push(ctx, &ctx->segments, segment);
  return memory_end;
}

/* Sections of one class follow each other from *address on, up to one with an address of its own, which begins a new
   segment. */
static void place_segments(ld_context *ctx, ld_class class, uint32_t flags, uint64_t *address) {
  ld_segment segment = {.flags = flags, .address = (uint32_t)ld_align(*address, LD_SEGMENT_ALIGNMENT)};
  uint64_t at = segment.address, file_end = at, memory_end = at;
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    ld_output *output = ctx->outputs.items[i];
    if (output->class != class)
      continue;
    const ld_section_start *start = find_start(ctx, output->name);
    if (start) {
      close_segment(ctx, segment, file_end, memory_end);
      segment.address = start->address;
      at = file_end = memory_end = start->address;
    }
    at = ld_align(at, output->alignment);
    output->address = (uint32_t)at;
    at += output->size;
    if (at > TRAX_LOCAL_BASE) {
      ld_error(ctx, "the image does not fit: section %s would end at 0x%llx, global memory ends at 0x%x", output->name,
               (unsigned long long)at, TRAX_LOCAL_BASE);
      return;
    }
    if (start && output->address != start->address)
      ld_error(ctx, "--section-start=%s=0x%x: the section is aligned to %u", output->name, start->address,
               output->alignment);
    if (output->size)
      memory_end = at;
    if (output->size && output->type != SHT_NOBITS)
      file_end = at;
  }
  if (flags == PF_R) {
    uint64_t initial_end = place_initial_values(ctx, memory_end);
    if (initial_end)
      file_end = memory_end = initial_end;
  }
  bool is_empty = memory_end == segment.address && segment.address == ld_align(*address, LD_SEGMENT_ALIGNMENT);
  memory_end = close_segment(ctx, segment, file_end, memory_end);
  if (!is_empty)
    *address = memory_end;
}

static int compare_addresses(const void *left, const void *right) {
  const ld_output *a = *(ld_output *const *)left, *b = *(ld_output *const *)right;
  if (a->address != b->address)
    return a->address < b->address ? -1 : 1;
  return ld_compare_outputs(left, right);
}

static void check_overlap(ld_context *ctx) {
  ld_output **sorted = ld_alloc_array(ctx, ctx->outputs.count + 1, sizeof(ld_output *));
  size_t count = 0;
  for (size_t i = 0; i < ctx->outputs.count; i++)
    if (ctx->outputs.items[i]->class < LD_THREAD_LOCAL && ctx->outputs.items[i]->size)
      sorted[count++] = ctx->outputs.items[i];
  qsort(sorted, count, sizeof(ld_output *), compare_addresses);
  for (size_t i = 1; i < count; i++) {
    const ld_output *before = sorted[i - 1], *after = sorted[i];
    if (after->address - before->address < before->size)
      ld_error(ctx, "section %s, at 0x%x, overlaps section %s, at 0x%x to 0x%x", after->name, after->address,
               before->name, before->address, before->address + before->size);
  }
}

/* The initialised data first: the rest of local memory is zero at start. */
static void place_thread_local(ld_context *ctx) {
  uint64_t at = TRAX_LOCAL_BASE;
  ld_bounds *bounds = &ctx->bounds;
  bounds->tdata_start = bounds->tdata_end = TRAX_LOCAL_BASE;
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    ld_output *output = ctx->outputs.items[i];
    if (output->class != LD_THREAD_LOCAL)
      continue;
    at = ld_align(at, output->alignment);
    output->address = (uint32_t)at;
    at += output->size;
    if (!output->load_address)
      continue;
    if (bounds->tdata_load)
      ld_error(ctx, "section %s: initialised thread-local data is in .tdata already", output->name);
    bounds->tdata_start = output->address;
    bounds->tdata_end = (uint32_t)at;
    bounds->tdata_load = output->load_address;
  }
  bounds->tbss_start = bounds->tdata_end;
  bounds->tbss_end = (uint32_t)at;
  uint64_t size = at - TRAX_LOCAL_BASE;
  ctx->local_size = (uint32_t)size;
  if (size > TRAX_LOCAL_SIZE)
    ld_error(ctx, "thread-local data takes %llu bytes; local memory has %u, and -mstack=global moves the stack alone",
             (unsigned long long)size, TRAX_LOCAL_SIZE);
  else if (size == TRAX_LOCAL_SIZE && !ld_symbol_find(ctx, "__trax_stack_size"))
    ld_error(ctx,
             "thread-local data takes %llu bytes; local memory has %u, and holds the stack too without -mstack=global",
             (unsigned long long)size, TRAX_LOCAL_SIZE);
}

static void set_range(const ld_context *ctx, const char *name, uint32_t otherwise, uint32_t *start, uint32_t *end) {
  const ld_output *output = ld_output_find(ctx, name);
  *start = output ? output->address : otherwise;
  *end = output ? output->address + output->size : otherwise;
}

static void set_bounds(ld_context *ctx, uint32_t text_end, uint32_t end) {
  ld_bounds *bounds = &ctx->bounds;
  bounds->executable_start = ctx->options.text_start;
  bounds->text_start = ctx->options.text_start;
  bounds->text_end = text_end;
  bounds->end = (uint32_t)ld_align(end, LD_SEGMENT_ALIGNMENT);
  set_range(ctx, ".init_array", end, &bounds->init_array_start, &bounds->init_array_end);
  set_range(ctx, ".fini_array", end, &bounds->fini_array_start, &bounds->fini_array_end);
  bounds->bss_start = bounds->bss_end = end;
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    const ld_output *output = ctx->outputs.items[i];
    if (output->class != LD_DATA || output->order != LD_ZEROS || !output->size)
      continue;
    if (bounds->bss_start == end)
      bounds->bss_start = output->address;
    bounds->bss_end = output->address + output->size;
  }
}

static void find_entry(ld_context *ctx) {
  const char *name = ctx->options.entry;
  if (!ld_parse_number(name, &ctx->entry)) {
    const ld_symbol *symbol = ld_symbol_find(ctx, name);
    if (symbol->kind == LD_UNDEFINED || symbol->kind == LD_LAZY) {
      ld_error(ctx, "the entry symbol '%s' is undefined (-e chooses another)", name);
      return;
    }
    ctx->entry = ld_symbol_address(ctx, symbol);
  }
  for (size_t i = 0; i < ctx->segments.count; i++) {
    const ld_segment *segment = &ctx->segments.items[i];
    if ((segment->flags & PF_X) && ctx->entry - segment->address < segment->memory_size && ctx->entry % 4 == 0)
      return;
  }
  ld_error(ctx, "the entry '%s' (0x%x) is not an instruction's address in the text, 0x%x to 0x%x", name, ctx->entry,
           ctx->bounds.text_start, ctx->bounds.text_end);
}

static uint32_t minimum(uint32_t a, uint32_t b) {
  return a < b ? a : b;
}

static void place_in_file(ld_context *ctx) {
  uint64_t offset = sizeof(Elf32_Ehdr) + ctx->segments.count * sizeof(Elf32_Phdr);
  for (size_t i = 0; i < ctx->segments.count; i++) {
    ld_segment *segment = &ctx->segments.items[i];
    offset = ld_align(offset, LD_SEGMENT_ALIGNMENT); /* as addresses are */
    segment->file_offset = (uint32_t)offset;
    for (size_t o = 0; o < ctx->outputs.count; o++) {
      ld_output *output = ctx->outputs.items[o];
      if (output->class < LD_THREAD_LOCAL && output->size && output->address >= segment->address &&
          output->address - segment->address < segment->memory_size)
        output->file_offset = segment->file_offset + minimum(output->address - segment->address, segment->file_size);
    }
    for (size_t o = 0; o < ctx->outputs.count; o++) {
      ld_output *output = ctx->outputs.items[o];
      if (output->load_address && output->load_address - segment->address < segment->file_size)
        output->file_offset = segment->file_offset + (output->load_address - segment->address);
    }
    offset += segment->file_size;
  }
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    ld_output *output = ctx->outputs.items[i];
    if (output->class < LD_THREAD_LOCAL || output->load_address)
      continue;
    offset = ld_align(offset, output->class == LD_THREAD_LOCAL ? 1 : output->alignment);
    output->file_offset = (uint32_t)offset;
    if (output->type != SHT_NOBITS)
      offset += output->size;
  }
  if (offset > LD_MAX_FILE)
    ld_error(ctx, "the executable would have %llu bytes, more than the linker's limit, %u", (unsigned long long)offset,
             LD_MAX_FILE);
  ctx->image_size = (size_t)offset; /* what follows is output.c's */
}

/* ELF wants them in the order of their addresses. */
static int compare_segments(const void *left, const void *right) {
  const ld_segment *a = left, *b = right;
  return a->address < b->address ? -1 : a->address > b->address;
}

bool ld_layout(ld_context *ctx) {
  ld_gather(ctx);
  if (ctx->error_count)
    return false;
  uint64_t address = ctx->options.text_start;
  place_segments(ctx, LD_CODE, PF_R | PF_X, &address);
  uint32_t text_end = (uint32_t)address;
  place_segments(ctx, LD_CONSTANTS, PF_R, &address);
  place_segments(ctx, LD_DATA, PF_R | PF_W, &address);
  check_overlap(ctx);
  place_thread_local(ctx);
  if (ctx->error_count)
    return false;
  if (ctx->segments.count)
    qsort(ctx->segments.items, ctx->segments.count, sizeof *ctx->segments.items, compare_segments);
  for (size_t i = 0; i < ctx->segments.count; i++) { /* sections with given addresses may be anywhere */
    const ld_segment *segment = &ctx->segments.items[i];
    if (i > 0 && segment->address - segment[-1].address < segment[-1].memory_size && !ctx->error_count)
      ld_error(ctx, "the segments at 0x%x and 0x%x overlap", segment[-1].address, segment->address);
    if (segment->address + segment->memory_size > address)
      address = segment->address + segment->memory_size;
  }
  set_bounds(ctx, text_end, (uint32_t)address);
  ld_place_boundaries(ctx);
  find_entry(ctx);
  place_in_file(ctx);
  return ctx->error_count == 0;
}

uint32_t ld_section_address(const ld_section *section, uint32_t offset) {
  if (!section->merged_into)
    return section->output->address + section->output_offset + offset;
  const ld_piece *piece = ld_find_piece(section, offset);
  const ld_section *merged = section->merged_into;
  return merged->output->address + merged->output_offset +
         (piece ? piece->output_offset + (offset - piece->offset) : merged->size);
}
