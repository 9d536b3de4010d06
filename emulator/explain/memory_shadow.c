/* The shadow of memory: undefined bits, tags of pointers, blocks. */
#include "explain/memory_check.h"

#include <stdlib.h>
#include <string.h>

struct trax_memory_page *trax_memory_page_of(struct trax_memory_check *check, uint32_t address) {
  const size_t number = address >> MEMORY_PAGE_SHIFT;
  struct trax_memory_page **page = &check->pages[number];
  const uint32_t block = check->fresh[number];
  if (!*page && !(*page = calloc(1, sizeof **page)))
    check->reader.explain->out_of_memory = true;
  if (*page && block) {
    memset((*page)->undefined, 0xFF, sizeof(*page)->undefined);
    for (uint32_t i = 0; i < MEMORY_PAGE / 4; i++)
      (*page)->blocks[i] = block;
    check->fresh[number] = 0;
  }
  return *page;
}

uint32_t trax_memory_block_at(const struct trax_memory_check *check, uint32_t address) {
  if (address < check->heap_begin || address >= check->heap_end)
    return MEMORY_NO_TAG;
  const struct trax_memory_page *page = check->pages[address >> MEMORY_PAGE_SHIFT];
  return page ? page->blocks[address % MEMORY_PAGE / 4] : check->fresh[address >> MEMORY_PAGE_SHIFT];
}

void trax_memory_set_block(struct trax_memory_check *check, uint32_t block, uint32_t begin, uint32_t undefined,
                           uint32_t end) {
  const uint32_t last = end > begin ? end - 1 : begin; /* an empty block has a word, too */
  for (uint32_t at = begin & ~3u; at <= last; at = (at | (MEMORY_PAGE - 1)) + 1) {
    const size_t number = at >> MEMORY_PAGE_SHIFT;
    if (at % MEMORY_PAGE == 0 && last - at >= MEMORY_PAGE - 1 && (at >= undefined || check->fresh[number])) {
      free(check->pages[number]);
      check->pages[number] = NULL;
      check->fresh[number] = block;
      continue;
    }
    struct trax_memory_page *page = trax_memory_page_of(check, at);
    for (uint32_t word = at / 4; page && word <= last / 4 && word * 4 >> MEMORY_PAGE_SHIFT == number; word++)
      page->blocks[word % (MEMORY_PAGE / 4)] = block;
    const uint32_t from = at > undefined ? at : undefined,
                   to = (at | (MEMORY_PAGE - 1)) < last ? (at | (MEMORY_PAGE - 1)) + 1 : end;
    if (page && from < to)
      memset(page->undefined + from % MEMORY_PAGE, 0xFF, to - from);
  }
}

uint32_t trax_memory_tag_at(const struct trax_memory_check *check, uint32_t thread, uint32_t address) {
  if (address >= TRAX_LOCAL_BASE)
    return check->threads[thread].local_tags[address % TRAX_LOCAL_SIZE / 4];
  const struct trax_memory_page *page =
      address < check->machine->space.size ? check->pages[address >> MEMORY_PAGE_SHIFT] : NULL;
  return page ? page->tags[address % MEMORY_PAGE / 4] : MEMORY_NO_TAG;
}

void trax_memory_define(struct trax_memory_check *check, uint32_t thread, uint32_t address, uint32_t bytes,
                        bool undefined) {
  const int bits = undefined ? 0xFF : 0;
  if (address >= TRAX_LOCAL_BASE) {
    memset(check->threads[thread].local_undefined + (address - TRAX_LOCAL_BASE), bits,
           bytes < -address ? bytes : -address);
    return;
  }
  for (uint32_t part; bytes && address < check->machine->space.size; address += part, bytes -= part) {
    const uint32_t at = address % MEMORY_PAGE;
    const size_t number = address >> MEMORY_PAGE_SHIFT;
    struct trax_memory_page *page =
        undefined || check->fresh[number] ? trax_memory_page_of(check, address) : check->pages[number];
    part = bytes < MEMORY_PAGE - at ? bytes : MEMORY_PAGE - at;
    if (page)
      memset(page->undefined + at, bits, part);
  }
}

uint8_t trax_memory_undefined_byte(const struct trax_memory_check *check, uint32_t thread, uint32_t address) {
  if (address >= TRAX_LOCAL_BASE)
    return check->threads[thread].local_undefined[address - TRAX_LOCAL_BASE];
  if (address >= check->machine->space.size)
    return 0;
  const struct trax_memory_page *page = check->pages[address >> MEMORY_PAGE_SHIFT];
  return page ? page->undefined[address % MEMORY_PAGE] : check->fresh[address >> MEMORY_PAGE_SHIFT] ? 0xFF : 0;
}

bool trax_memory_byte(const struct trax_memory_check *check, uint32_t thread, uint32_t address, uint8_t *byte) {
  if (address < TRAX_LOCAL_BASE && trax_space_check(&check->machine->space, address, 1, false) != TRAX_FAULT_NONE)
    return false;
  *byte = address >= TRAX_LOCAL_BASE ? check->threads[thread].local[address - TRAX_LOCAL_BASE]
                                     : check->machine->space.bytes[address];
  return true;
}

bool trax_memory_word(const struct trax_memory_check *check, uint32_t thread, uint32_t address, uint32_t *word) {
  uint8_t bytes[4];
  for (uint32_t i = 0; i < 4; i++)
    if (!trax_memory_byte(check, thread, address + i, &bytes[i]))
      return false;
  memcpy(word, bytes, sizeof *word);
  return true;
}
