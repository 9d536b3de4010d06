/* Merging of strings and constants: a section with SHF_MERGE is cut into pieces, equal pieces are written once. Offsets
   in the section are translated piece by piece (ld_find_piece). */
#include "ld.h"

#include <string.h>

static bool is_terminator(const uint8_t *bytes, uint32_t width) {
  for (uint32_t i = 0; i < width; i++)
    if (bytes[i])
      return false;
  return true;
}

static uint32_t piece_size(const ld_section *section, size_t index) {
  uint32_t end = index + 1 < section->piece_count ? section->pieces[index + 1].offset : section->size;
  return end - section->pieces[index].offset;
}

/* Whether the contents agree with the flags. If not, they are linked unmerged. */
static bool can_merge(const ld_section *section) {
  uint32_t width = section->entry_size;
  if (section->discarded || !(section->flags & SHF_MERGE) || (section->flags & SHF_WRITE) || !section->data ||
      section->reloc_count || section->size == 0 || width == 0 || section->size % width)
    return false;
  return !(section->flags & SHF_STRINGS) || is_terminator(section->data + section->size - width, width);
}

static void split(ld_context *ctx, ld_section *section) {
  uint32_t width = section->entry_size, count = 0;
  bool strings = section->flags & SHF_STRINGS;
  for (uint32_t at = 0; at < section->size; at += width)
    count += !strings || is_terminator(section->data + at, width);
  section->pieces = ld_alloc_array(ctx, count, sizeof *section->pieces);
  section->piece_count = count;
  uint32_t start = 0, index = 0;
  for (uint32_t at = 0; at < section->size; at += width) {
    if (strings && !is_terminator(section->data + at, width))
      continue;
    section->pieces[index++] = (ld_piece){.offset = start, .output_offset = LD_MERGE_NONE};
    start = at + width;
  }
}

void ld_split_merge_sections(ld_context *ctx) {
  for (size_t i = 0; i < ctx->sections.count; i++)
    if (can_merge(ctx->sections.items[i]))
      split(ctx, ctx->sections.items[i]);
}

ld_piece *ld_find_piece(const ld_section *section, uint32_t offset) {
  if (offset > section->size)
    return NULL;
  size_t low = 0, high = section->piece_count;
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    if (section->pieces[middle].offset <= offset)
      low = middle;
    else
      high = middle;
  }
  return &section->pieces[low];
}

/* The merged contents of sections with the same flags, entry size and alignment. */
typedef struct pool {
  ld_section *section; /* represents them in the output */
  ld_map offsets;      /* piece -> its offset + 1 */
  uint8_t *bytes;
  size_t capacity;
} pool;

static void add_piece(ld_context *ctx, pool *pool, ld_section *from, size_t index) {
  ld_piece *piece = &from->pieces[index];
  ld_section *to = pool->section;
  const uint8_t *bytes = from->data + piece->offset;
  uint32_t size = piece_size(from, index);
  uintptr_t *known = ld_map_at(ctx, &pool->offsets, bytes, size);
  if (!*known) {
    uint32_t offset = (uint32_t)ld_align(to->size, to->alignment);
    while (offset + size > pool->capacity)
      pool->bytes = ld_grow(ctx, pool->bytes, to->size, &pool->capacity, 1);
    memcpy(pool->bytes + offset, bytes, size);
    to->size = offset + size;
    *known = (uintptr_t)offset + 1;
  }
  piece->output_offset = (uint32_t)(*known - 1);
}

static pool *find_pool(ld_context *ctx, pool *pools, size_t *count, const ld_section *section) {
  for (size_t i = 0; i < *count; i++) {
    const ld_section *other = pools[i].section;
    if (other->flags == section->flags && other->entry_size == section->entry_size &&
        other->alignment == section->alignment)
      return &pools[i];
  }
  ld_section *merged = ld_alloc(ctx, sizeof *merged);
  *merged = (ld_section){.name = section->name,
                         .type = section->type,
                         .flags = section->flags,
                         .alignment = section->alignment,
                         .entry_size = section->entry_size,
                         .live = true};
  pools[*count] = (pool){.section = merged};
  return &pools[(*count)++];
}

void ld_merge_output(ld_context *ctx, ld_output *output) {
  pool *pools = ld_alloc_array(ctx, output->sections.count + 1, sizeof *pools);
  size_t pool_count = 0, kept = 0;
  for (size_t i = 0; i < output->sections.count; i++) {
    ld_section *section = output->sections.items[i];
    if (!section->pieces) {
      output->sections.items[kept++] = section;
      continue;
    }
    size_t known_pools = pool_count;
    pool *pool = find_pool(ctx, pools, &pool_count, section);
    if (pool_count > known_pools)
      output->sections.items[kept++] = pool->section; /* where the first of them was */
    section->merged_into = pool->section;
    for (size_t piece = 0; piece < section->piece_count; piece++)
      if (section->pieces[piece].live)
        add_piece(ctx, pool, section, piece);
  }
  output->sections.count = kept;
  for (size_t i = 0; i < pool_count; i++)
    pools[i].section->data = pools[i].bytes ? pools[i].bytes : (const uint8_t *)"";
}
