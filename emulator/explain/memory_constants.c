/* Pointers that code makes of constants: to global objects, by addresses in two halves, and to arrays in its frame, by
   distances from a register. Which object is meant follows from the constant, as far as it can be known. */
#include "explain/memory_check.h"
#include "trax/grow.h"

enum { NEAR = 16 }; /* A compiler may count from a constant that lies so far outside of an object. */

/* Returns the entry of a key, whose value is the tag; UINT32_MAX: it is new. NULL: out of memory. */
static struct trax_map_entry *entry_of(struct trax_memory_check *check, uint32_t kind, uint32_t value) {
  struct trax_map_entry *entry =
      trax_map_put(&check->object_of, sizeof *entry, (uint64_t)kind << 32 | value, UINT32_MAX);
  if (!entry)
    check->reader.explain->out_of_memory = true;
  return entry;
}

uint32_t trax_memory_tag_of_half(struct trax_memory_check *check, uint32_t half) {
  if (half > check->image_end + 0x8000 || half + 0x8000 < check->image_begin)
    return MEMORY_NO_TAG;
  struct trax_map_entry *entry = entry_of(check, UINT32_MAX, half);
  if (entry && entry->value == UINT32_MAX)
    entry->value = trax_memory_object_add(check, &(struct trax_memory_object){.kind = MEMORY_HALF, .begin = half});
  return entry ? entry->value : MEMORY_NO_TAG;
}

static bool is_read_only(const struct trax_memory_check *check, uint32_t address) {
  return check->machine->space.restrictions[address / TRAX_GRANULE] & TRAX_RESTRICT_WRITE;
}

/* Finds the object that an address in code may mean: the object that begins there, or one that it lies in or near to.
   An object that ends there may be meant as well. */
static bool find_global(const struct trax_memory_check *check, uint32_t address, struct trax_memory_object *object) {
  const struct trax_memory_symbol *symbols = check->symbols;
  size_t after = 0, high = check->symbol_count; /* the first that begins behind the address */
  while (after < high) {
    const size_t middle = (after + high) / 2;
    if (symbols[middle].begin <= address)
      after = middle + 1;
    else
      high = middle;
  }
  if (!after || address >= symbols[after - 1].end)
    return false;
  const struct trax_memory_symbol *main = &symbols[after - 1], *before = main;
  *object = (struct trax_memory_object){.kind = MEMORY_GLOBAL,
                                        .begin = main->begin,
                                        .end = main->end,
                                        .name = main->name,
                                        .own_begin = main->begin,
                                        .own_end = main->end};
  const bool exact = address == main->begin;
  if (is_read_only(check, address)) { /* with constants between objects that have no names */
    object->begin = exact ? 0 : object->begin;
    return exact;
  }
  const uint32_t near = exact ? 0 : NEAR;
  for (; before > symbols && before[-1].end + near >= address; before--)
    object->begin = before[-1].begin;
  if (exact && before == main) /* what lies between, if it is no padding, has no name */
    object->begin = before > symbols ? before[-1].end : check->image_begin;
  for (; !exact && after < check->symbol_count && symbols[after].begin <= address + near; after++)
    object->end = symbols[after].end;
  return true;
}

uint32_t trax_memory_tag_of_address(struct trax_memory_check *check, uint32_t address) {
  struct trax_memory_object object;
  if (address - check->image_begin >= check->image_end - check->image_begin)
    return MEMORY_NO_TAG;
  struct trax_map_entry *entry = entry_of(check, 0, address);
  if (entry && entry->value == UINT32_MAX)
    entry->value = find_global(check, address, &object) ? trax_memory_object_add(check, &object) : MEMORY_NO_TAG;
  return entry ? entry->value : MEMORY_NO_TAG;
}

/* --- automatic variables --- */

static const struct trax_memory_variables *variables_at(struct trax_memory_check *check, uint32_t pc) {
  const struct trax_symbol *symbol = check->loaded ? trax_image_symbol_at(check->loaded->image, pc) : NULL;
  if (!symbol)
    return NULL;
  struct trax_map_entry *entry =
      trax_map_put(&check->variables_of, sizeof *entry, symbol->address, (uint32_t)check->variables_count);
  if (!entry)
    return NULL;
  if (entry->value == check->variables_count) {
    if (!trax_grow((void **)&check->variables, check->variables_count, &check->variables_capacity,
                   sizeof *check->variables))
      return NULL;
    struct trax_memory_variables *variables = &check->variables[check->variables_count++];
    variables->count = trax_image_variables(check->loaded->image, pc, &variables->items, &variables->base);
  }
  return &check->variables[entry->value];
}

/* The beginning of the first variable behind an offset; INT32_MAX: there is none. */
static int32_t next_begin(const struct trax_memory_variables *variables, int32_t offset) {
  int32_t begin = INT32_MAX;
  for (size_t i = 0; i < variables->count; i++)
    if (variables->items[i].begin > offset && variables->items[i].begin < begin)
      begin = variables->items[i].begin;
  return begin;
}

/* Finds memory of a frame that belongs to no variable, such as alloca's of a constant size: it ends at the next
   variable. Where it begins is not known, since variables may lie in its place. As long as none of it is accessed, an
   array near to the address may be meant. */
static bool find_unnamed(const struct trax_memory_variables *variables, int32_t offset, uint32_t address,
                         struct trax_memory_object *object) {
  const int32_t own_end = next_begin(variables, offset);
  int32_t begin = offset, end = INT32_MIN;
  for (size_t i = 0; i < variables->count; i++) {
    const struct trax_frame_variable *it = &variables->items[i];
    begin = it->begin < begin ? it->begin : begin;
    if (it->is_array && it->begin <= offset + NEAR && it->end > end)
      end = it->end;
  }
  if (own_end == INT32_MAX)
    return false;
  *object = (struct trax_memory_object){.kind = MEMORY_LOCAL,
                                        .begin = address + (uint32_t)(begin - offset),
                                        .end = address + (uint32_t)((end > own_end ? end : own_end) - offset),
                                        .name = "memory without a name",
                                        .unnamed = true,
                                        .own_begin = address,
                                        .own_end = address + (uint32_t)(own_end - offset)};
  return true;
}

/* The same as find_global in a frame, whose variables may overlap if they live at different times. What has no name may
   lie in the place of a variable too. It is rarely larger than an array. */
static bool find_local(const struct trax_memory_variables *variables, int32_t offset, uint32_t address,
                       struct trax_memory_object *object) {
  const struct trax_frame_variable *main = NULL;
  for (size_t i = 0; i < variables->count; i++) {
    const struct trax_frame_variable *it = &variables->items[i];
    if (it->begin <= offset && offset < it->end && (!main || it->begin > main->begin))
      main = it;
  }
  if (!main)
    return find_unnamed(variables, offset, address, object);
  if (!main->is_array)
    return false;
  int32_t begin = main->begin, end = main->end;
  const int32_t near = offset == begin ? 0 : NEAR;
  if (near && offset + near >= end) /* what follows may have no variable, and be meant */
    end = next_begin(variables, end - 1);
  for (size_t i = 0; i < variables->count; i++) {
    const struct trax_frame_variable *it = &variables->items[i];
    const bool overlaps = it->begin < main->end && main->begin < it->end;
    if (overlaps || (it->begin <= offset + near - (near == 0) && offset <= it->end + near)) {
      begin = it->begin < begin ? it->begin : begin;
      end = it->end > end ? it->end : end;
    }
  }
  if (end == INT32_MAX) /* where the frame ends is not known */
    return false;
  *object = (struct trax_memory_object){.kind = MEMORY_LOCAL,
                                        .begin = address + (uint32_t)(begin - offset),
                                        .end = address + (uint32_t)(end - offset),
                                        .name = main->name,
                                        .own_begin = address + (uint32_t)(main->begin - offset),
                                        .own_end = address + (uint32_t)(main->end - offset)};
  return true;
}

uint32_t trax_memory_tag_of_frame(struct trax_memory_check *check, uint32_t pc, unsigned base, int32_t offset,
                                  uint32_t address) {
  struct trax_memory_object object;
  struct trax_map_entry *entry = entry_of(check, pc, address);
  if (entry && entry->value == UINT32_MAX) {
    const struct trax_memory_variables *variables = variables_at(check, pc);
    entry->value = variables && variables->base == base && find_local(variables, offset, address, &object)
                       ? trax_memory_object_add(check, &object)
                       : MEMORY_NO_TAG;
  }
  return entry ? entry->value : MEMORY_NO_TAG;
}
