/* The objects of addresses: the program's symbols, buffers, blocks of the heap and stacks. */
#include "explain/memory_check.h"
#include "trax/grow.h"

#include <stdlib.h>
#include <string.h>

enum {
  LOOK_BACK = 64,  /* words in which the block before an address is searched */
  FAR_IMM = 0x1000 /* an immediate that is an address rather than the offset of a member */
};

uint32_t trax_memory_object_add(struct trax_memory_check *check, const struct trax_memory_object *object) {
  if (!trax_grow((void **)&check->objects, check->object_count, &check->object_capacity, sizeof *check->objects)) {
    check->reader.explain->out_of_memory = true;
    return MEMORY_NO_TAG;
  }
  check->objects[check->object_count] = *object;
  return (uint32_t)check->object_count++;
}

/* --- places --- */

void trax_memory_stack_of(const struct trax_memory_check *check, uint32_t thread, uint32_t *begin, uint32_t *end) {
  const uint32_t bytes = check->loaded ? check->loaded->stack_bytes : 0;
  *end = bytes ? (uint32_t)check->machine->space.size - thread * (bytes + TRAX_STACK_GUARD) : 0;
  *begin = bytes ? *end - bytes : check->thread_local_end;
}

/* Whether an access may have been meant for an object that was known by a constant only, which may also be a number. */
static bool is_plausible(const struct trax_memory_check *check, uint32_t thread,
                         const struct trax_memory_object *object, uint32_t address) {
  uint32_t begin, end;
  if (object->kind == MEMORY_GLOBAL)
    return address >= check->image_begin && address < check->image_end;
  trax_memory_stack_of(check, thread, &begin, &end);
  return object->kind != MEMORY_LOCAL || (object->begin >= begin && address >= begin && address - 1 < end - 1);
}

/* In a stack in global memory, which other threads may use too: whether the frame of its thread has ended. */
static bool is_below_frame(const struct trax_memory_check *check, uint32_t thread, uint32_t address) {
  const uint32_t bytes = check->loaded ? check->loaded->stack_bytes : 0;
  if (bytes && address >= check->loaded->memory_end && address < check->machine->space.size)
    thread = ((uint32_t)check->machine->space.size - 1 - address) / (bytes + TRAX_STACK_GUARD);
  else if (bytes || address < check->thread_local_end)
    return false;
  return address - 1 < check->threads[thread].low - 1;
}

static uint32_t block_before(const struct trax_memory_check *check, uint32_t address) {
  for (uint32_t word = address / 4, i = 0; i < LOOK_BACK && word * 4 >= check->heap_begin; word--, i++) {
    const uint32_t block = trax_memory_block_at(check, word * 4);
    if (block)
      return block;
  }
  return MEMORY_NO_TAG;
}

static enum trax_memory_finding check_byte(const struct trax_memory_check *check, uint32_t thread, uint32_t address,
                                           uint32_t *object) {
  if (is_below_frame(check, thread, address))
    return MEMORY_FRAME;
  if (address >= check->heap_begin && address < check->heap_end) {
    const uint32_t block = trax_memory_block_at(check, address);
    *object = block ? block : block_before(check, address);
    if (!block)
      return *object ? MEMORY_OUTSIDE : MEMORY_NOWHERE;
    const struct trax_memory_object *it = &check->objects[block];
    return address - it->begin >= it->end - it->begin ? MEMORY_OUTSIDE : it->freed ? MEMORY_FREED : MEMORY_NOTHING;
  }
  const uint32_t at = address - check->image_begin;
  return at < check->image_end - check->image_begin && check->padding[at / 8] >> at % 8 & 1 ? MEMORY_NOWHERE
                                                                                            : MEMORY_NOTHING;
}

enum trax_memory_finding trax_memory_check_access(struct trax_memory_check *check, uint32_t thread, uint32_t tag,
                                                  int32_t imm, uint32_t address, uint32_t bytes, uint32_t *object) {
  *object = MEMORY_NO_TAG;
  if (tag >= MEMORY_FIRST_OBJECT && check->objects[tag].kind == MEMORY_HALF)
    tag = trax_memory_tag_of_address(check, check->objects[tag].begin + (uint32_t)imm);
  else if (tag >= MEMORY_FIRST_OBJECT && check->objects[tag].kind == MEMORY_GLOBAL && imm >= FAR_IMM)
    tag = MEMORY_NO_TAG;
  if (tag >= MEMORY_FIRST_OBJECT) {
    struct trax_memory_object *it = &check->objects[tag];
    *object = tag;
    if (it->freed)
      return MEMORY_FREED;
    if (it->unnamed && address >= it->own_begin && address < it->own_end)
      it->end = it->own_end;
    if ((address - it->begin > it->end - it->begin || it->end - address < bytes) &&
        is_plausible(check, thread, it, address))
      return MEMORY_OUTSIDE;
  }
  for (uint32_t i = 0; i < bytes; i++) {
    const enum trax_memory_finding finding = check_byte(check, thread, address + i, object);
    if (finding)
      return finding;
  }
  return MEMORY_NOTHING;
}

/* --- the program's objects --- */

static int by_address(const void *a, const void *b) {
  const struct trax_memory_symbol *one = a, *other = b;
  if (one->begin != other->begin)
    return one->begin < other->begin ? -1 : 1;
  return (one->end > other->end) - (one->end < other->end);
}

static trax_status add_symbols(struct trax_memory_check *check, trax_error *error) {
  size_t count, kept = 0;
  const struct trax_symbol *symbols = trax_image_symbols(check->loaded->image, &count);
  if (!(check->symbols = trax_explain_array(count, sizeof *check->symbols, error)))
    return TRAX_ERROR;
  for (size_t i = 0; i < count; i++) {
    const struct trax_symbol *it = &symbols[i];
    if (!it->absolute && it->address >= TRAX_LOCAL_BASE && it->address + it->bytes > check->thread_local_end)
      check->thread_local_end = it->address + it->bytes;
    uint32_t end = it->address + it->bytes;
    const bool is_section = strncmp(it->name, "__start_", 8) == 0; /* whose objects are one array to the program */
    if ((it->absolute && !is_section) || it->address < check->image_begin || it->address >= check->image_end)
      continue;
    if (is_section) {
      char stop[256];
      snprintf(stop, sizeof stop, "__stop_%s", it->name + 8);
      const struct trax_symbol *last = trax_image_symbol(check->loaded->image, stop);
      end = last ? last->address : it->address;
    } else if (it->type != TRAX_SYMBOL_OBJECT) {
      continue;
    }
    if (end > it->address && end <= check->image_end)
      check->symbols[kept++] = (struct trax_memory_symbol){it->address, end, it->name};
  }
  if (kept)
    qsort(check->symbols, kept, sizeof *check->symbols, by_address);
  for (size_t i = 0; i < kept; i++) /* of those that overlap, such as aliases, the whole */
    if (check->symbol_count && check->symbols[i].begin < check->symbols[check->symbol_count - 1].end) {
      struct trax_memory_symbol *last = &check->symbols[check->symbol_count - 1];
      last->end = check->symbols[i].end > last->end ? check->symbols[i].end : last->end;
    } else {
      check->symbols[check->symbol_count++] = check->symbols[i];
    }
  return TRAX_OK;
}

/* Whether all objects have symbols. A stripped program has those that the loader needs. */
static bool has_all_symbols(const struct trax_memory_check *check) {
  size_t count;
  const struct trax_symbol *symbols = trax_image_symbols(check->loaded->image, &count);
  for (size_t i = 0; i < count; i++)
    if (symbols[i].type == TRAX_SYMBOL_FUNCTION)
      return true;
  return false;
}

/* Marks the padding before the objects of a writable segment: fewer bytes than the next object is aligned to. */
static void mark_padding(struct trax_memory_check *check, const struct trax_load_segment *segment) {
  const uint32_t segment_end = segment->address + segment->memory_bytes;
  uint32_t end = 0; /* of the object before; 0: none */
  for (size_t i = 0; i < check->symbol_count; i++) {
    const struct trax_memory_symbol *it = &check->symbols[i];
    if (it->begin < segment->address || it->begin >= segment_end)
      continue;
    if (end && it->begin - end < (it->begin & -it->begin) && it->begin - end < 64)
      for (uint32_t at = end - check->image_begin; at < it->begin - check->image_begin; at++)
        check->padding[at / 8] |= (uint8_t)(1 << at % 8);
    end = it->end;
  }
  const uint32_t rest = (segment_end + TRAX_GRANULE - 1) & ~(TRAX_GRANULE - 1);
  for (uint32_t at = segment_end - check->image_begin; at < rest - check->image_begin; at++)
    check->padding[at / 8] |= (uint8_t)(1 << at % 8);
}

static void find_heap(struct trax_memory_check *check) {
  const struct trax_symbol *begin = trax_image_symbol(check->loaded->image, "__trax_heap"),
                           *end = trax_image_symbol(check->loaded->image, "__trax_heap_end");
  if (begin && end && trax_image_symbol(check->loaded->image, "malloc") &&
      (!trax_memory_word(check, 0, begin->address, &check->heap_begin) ||
       !trax_memory_word(check, 0, end->address, &check->heap_end) || check->heap_begin > check->heap_end ||
       check->heap_end > check->machine->space.size))
    check->heap_begin = check->heap_end = 0;
}

static trax_status add_buffers(struct trax_memory_check *check) {
  for (size_t i = 0; i < check->loaded->buffer_count; i++) {
    const struct trax_bound_buffer *it = &check->loaded->buffers[i];
    const struct trax_symbol *symbol = trax_image_symbol(check->loaded->image, it->symbol);
    struct trax_memory_page *page = symbol ? trax_memory_page_of(check, symbol->address) : NULL;
    if (page)
      page->tags[symbol->address % MEMORY_PAGE / 4] =
          trax_memory_object_add(check, &(struct trax_memory_object){.kind = MEMORY_BUFFER,
                                                                     .begin = it->address,
                                                                     .end = it->address + it->bytes,
                                                                     .name = it->symbol,
                                                                     .own_begin = it->address,
                                                                     .own_end = it->address + it->bytes});
  }
  return TRAX_OK;
}

trax_status trax_memory_objects_open(struct trax_memory_check *check, trax_error *error) {
  for (uint32_t i = 0; i < MEMORY_FIRST_OBJECT; i++)
    trax_memory_object_add(check, &(struct trax_memory_object){0});
  check->thread_local_end = TRAX_LOCAL_BASE;
  if (!check->loaded)
    return TRAX_OK;
  size_t count;
  const struct trax_load_segment *segments = trax_image_segments(check->loaded->image, &count);
  check->image_begin = count ? segments[0].address : 0;
  check->image_end = count ? segments[count - 1].address + segments[count - 1].memory_bytes : 0;
  check->image_end = (check->image_end + TRAX_GRANULE - 1) & ~(TRAX_GRANULE - 1);
  const uint32_t bytes = check->image_end - check->image_begin;
  if (!(check->padding = trax_explain_array(bytes / 8 + TRAX_GRANULE, 1, error)) ||
      add_symbols(check, error) != TRAX_OK)
    return TRAX_ERROR;
  for (size_t i = 0; i < count && has_all_symbols(check); i++)
    if (segments[i].permissions & TRAX_PERMIT_WRITE)
      mark_padding(check, &segments[i]);
  find_heap(check);
  return add_buffers(check);
}

void trax_memory_objects_close(struct trax_memory_check *check) {
  for (size_t i = 0; check->pages && i < check->page_count; i++)
    free(check->pages[i]);
  for (size_t i = 0; i < check->variables_count; i++)
    free(check->variables[i].items);
  free(check->pages);
  free(check->fresh);
  free(check->variables);
  free(check->objects);
  free(check->symbols);
  free(check->padding);
  trax_map_free(&check->object_of);
  trax_map_free(&check->variables_of);
}
