/* The heap as the check of memory sees it: by the calls of its functions, which are known by their names. Blocks that
   were not freed and to which no pointer is left are lost. */
#include "explain/memory_check.h"
#include "trax/grow.h"

#include <stdlib.h>
#include <string.h>

enum { RA = 1, SP = 2, FP = 3, A0 = 4, S0 = 20, S11 = 31 };

/* Returns the live block that a call frees; 0: none, which is reported. */
static uint32_t freed_block(struct trax_memory_check *check, const struct trax_memory_thread *thread,
                            const struct trax_memory_event *event) {
  const struct trax_memory_value pointer = thread->arguments[0];
  uint32_t block = pointer.tag;
  if (block < MEMORY_FIRST_OBJECT || check->objects[block].kind == MEMORY_HALF)
    block = trax_memory_block_at(check, pointer.bits);
  const struct trax_memory_object *it = block ? &check->objects[block] : NULL;
  if (it && it->kind == MEMORY_BLOCK && it->begin == pointer.bits && !it->freed)
    return block;
  trax_memory_note(check, it && it->freed ? MEMORY_DOUBLE_FREE : MEMORY_INVALID_FREE, event, pointer.bits, 0, true,
                   block);
  return MEMORY_NO_TAG;
}

static void release(struct trax_memory_check *check, uint32_t block, const struct trax_memory_event *event) {
  if (!block)
    return;
  check->objects[block].freed = true;
  check->objects[block].release = *event;
}

void trax_memory_heap_enter(struct trax_memory_check *check, uint32_t thread, enum trax_memory_function function,
                            const struct trax_memory_event *event) {
  struct trax_memory_thread *it = &check->threads[thread];
  it->function = function;
  it->return_pc = it->reg[RA].bits;
  it->stack_pointer = it->reg[SP].bits;
  it->arguments[0] = it->reg[A0];
  it->arguments[1] = it->reg[A0 + 1];
  it->event = *event;
  it->block = MEMORY_NO_TAG;
  if ((function == MEMORY_FREE || function == MEMORY_REALLOC) && it->arguments[0].bits)
    it->block = freed_block(check, it, event);
  if (function == MEMORY_FREE)
    release(check, it->block, event);
}

/* Adds a block that the heap has returned. Its bytes before `defined` have values. */
static void add_block(struct trax_memory_check *check, uint32_t thread, uint32_t address, uint32_t bytes,
                      uint32_t defined) {
  struct trax_memory_thread *it = &check->threads[thread];
  if (bytes > check->heap_end - address)
    return;
  const uint32_t block = trax_memory_object_add(check, &(struct trax_memory_object){.kind = MEMORY_BLOCK,
                                                                                    .begin = address,
                                                                                    .end = address + bytes,
                                                                                    .own_begin = address,
                                                                                    .own_end = address + bytes,
                                                                                    .allocation = it->event});
  if (block)
    trax_memory_set_block(check, block, address, address + (defined < bytes ? defined : bytes), address + bytes);
  it->reg[A0].tag = block;
}

/* A program may use what malloc_usable_size says of a block. */
static void extend(struct trax_memory_check *check, uint32_t begin, uint32_t bytes) {
  const uint32_t block = trax_memory_block_at(check, begin);
  struct trax_memory_object *it = block ? &check->objects[block] : NULL;
  if (!it || it->freed || it->begin != begin || bytes <= it->end - begin || bytes > check->heap_end - begin)
    return;
  const uint32_t end = it->end;
  it->end = it->own_end = begin + bytes;
  trax_memory_set_block(check, block, begin, end, it->end);
}

void trax_memory_heap_leave(struct trax_memory_check *check, uint32_t thread) {
  struct trax_memory_thread *it = &check->threads[thread];
  const enum trax_memory_function function = it->function;
  const uint32_t result = it->reg[A0].bits, first = it->arguments[0].bits, second = it->arguments[1].bits;
  it->function = MEMORY_OTHER;
  if (function == MEMORY_FREE)
    return;
  it->reg[A0].undefined = 0;
  it->reg[A0].tag = MEMORY_NO_TAG;
  if (function == MEMORY_USABLE) {
    extend(check, first, result);
    return;
  }
  if (result < check->heap_begin || result >= check->heap_end)
    return;
  if (function == MEMORY_REALLOC && first) {
    const uint32_t kept = it->block ? check->objects[it->block].end - check->objects[it->block].begin : second;
    release(check, it->block, &it->event);
    add_block(check, thread, result, second, kept);
  } else {
    const bool one = function == MEMORY_MALLOC, cleared = function == MEMORY_CALLOC;
    const uint32_t bytes = one ? first : cleared ? first * second : second;
    add_block(check, thread, result, bytes, cleared ? bytes : 0);
  }
}

/* --- leaks --- */

struct search {
  struct trax_memory_check *check;
  uint32_t *found; /* blocks whose contents are still to be searched */
  size_t count, capacity;
  bool exhausted;
};

static void follow(struct search *search, uint32_t word) {
  const uint32_t block = trax_memory_block_at(search->check, word);
  struct trax_memory_object *it = block ? &search->check->objects[block] : NULL;
  if (!it || it->freed || it->reached)
    return;
  it->reached = true;
  if (trax_grow((void **)&search->found, search->count, &search->capacity, sizeof *search->found))
    search->found[search->count++] = block;
  else
    search->exhausted = true;
}

/* Follows the words in [begin, end), where end may be 0 for 2^32. */
static void follow_all(struct search *search, uint32_t thread, uint32_t begin, uint32_t end) {
  const struct trax_memory_check *check = search->check;
  uint32_t word;
  for (uint32_t at = (begin + 3) & ~3u; at - 1 < end - 1 && end - at >= 4; at += 4)
    if (at < check->machine->space.size && check->fresh[at >> MEMORY_PAGE_SHIFT])
      at |= MEMORY_PAGE - 4; /* the page's last word: nothing was written to it */
    else if (trax_memory_tag_at(check, thread, at) != MEMORY_PRIVATE && trax_memory_word(check, thread, at, &word))
      follow(search, word);
}

static void follow_thread(struct search *search, uint32_t thread) {
  const struct trax_memory_thread *it = &search->check->threads[thread];
  uint32_t begin, end;
  trax_memory_stack_of(search->check, thread, &begin, &end);
  follow(search, it->reg[FP].bits);
  for (unsigned reg = S0; reg <= S11; reg++)
    follow(search, it->reg[reg].bits);
  if (search->check->thread_local_end > TRAX_LOCAL_BASE)
    follow_all(search, thread, TRAX_LOCAL_BASE, search->check->thread_local_end);
  if (it->low == MEMORY_NO_FRAME)
    follow_all(search, thread, begin, end);
  else if (it->low != end)
    follow_all(search, thread, it->low, end);
}

trax_status trax_memory_find_leaks(struct trax_memory_check *check, trax_error *error) {
  struct search search = {.check = check};
  size_t count;
  const struct trax_load_segment *segments = trax_image_segments(check->loaded->image, &count);
  for (size_t i = 0; i < count; i++)
    if (segments[i].permissions & TRAX_PERMIT_WRITE)
      follow_all(&search, 0, segments[i].address, segments[i].address + segments[i].memory_bytes);
  for (size_t i = 0; i < check->loaded->buffer_count; i++)
    follow_all(&search, 0, check->loaded->buffers[i].address,
               check->loaded->buffers[i].address + check->loaded->buffers[i].bytes);
  for (uint32_t thread = 0; thread < check->machine->stats.threads; thread++)
    follow_thread(&search, thread);
  while (search.count) {
    const struct trax_memory_object it = check->objects[search.found[--search.count]];
    follow_all(&search, it.allocation.thread, it.begin, it.end);
  }
  free(search.found);
  for (uint32_t i = MEMORY_FIRST_OBJECT; i < check->object_count; i++) {
    const struct trax_memory_object *it = &check->objects[i];
    /* The library's table of functions for the end is not freed. */
    const struct trax_symbol *by = trax_image_symbol_at(check->loaded->image, it->allocation.pc);
    if (it->kind == MEMORY_BLOCK && !it->freed && !it->reached && !(by && strcmp(by->name, "__cxa_atexit") == 0))
      trax_memory_note(check, MEMORY_LEAK, &it->allocation, it->begin, it->end - it->begin, false, i);
  }
  return search.exhausted ? trax_fail(error, "out of memory for the search for leaks") : TRAX_OK;
}
