/* Loads programs and buffers into a machine (docs/abi.md, "ELF" and "Buffers"). */
#include <stdlib.h>
#include <string.h>

#include "program/program.h"
#include "trax/abi.h"
#include "trax/input.h"

static void destroy_loaded(void *context) {
  struct trax_loaded *loaded = context;
  for (size_t i = 0; i < loaded->buffer_count; ++i)
    free(loaded->buffers[i].symbol);
  free(loaded->buffers);
  trax_image_close(loaded->image);
  free(loaded);
}

static uint64_t align_up(uint64_t value, uint64_t alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

void trax_loaded_store_word(struct trax_machine *machine, uint32_t address, uint32_t value) {
  for (unsigned i = 0; i < 4; ++i)
    machine->space.bytes[address + i] = (uint8_t)(value >> 8 * i);
}

const struct trax_symbol *trax_loaded_object(const struct trax_machine *machine, const char *name, uint32_t bytes,
                                             trax_error *error) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  const char *path = trax_image_path(loaded->image);
  const struct trax_symbol *symbol = trax_image_symbol(loaded->image, name);
  if (!symbol) {
    trax_fail(error, "%s: the program has no symbol %s", path, name);
    return NULL;
  }
  size_t count;
  const struct trax_load_segment *segments = trax_image_segments(loaded->image, &count);
  bool placed = false;
  for (size_t i = 0; i < count && !placed; ++i)
    placed = symbol->address >= segments[i].address && symbol->address % 4 == 0 &&
             !(segments[i].permissions & TRAX_PERMIT_EXECUTE) &&
             (uint64_t)symbol->address + bytes <= (uint64_t)segments[i].address + segments[i].memory_bytes;
  bool data = symbol->type == TRAX_SYMBOL_OBJECT || symbol->type == TRAX_SYMBOL_PLAIN;
  if (!placed || !data || symbol->absolute || (symbol->bytes && symbol->bytes < bytes)) {
    trax_fail(error, "%s: symbol %s (0x%08x, %u bytes) is not an object of %u bytes in the program's data", path, name,
              symbol->address, symbol->bytes, bytes);
    return NULL;
  }
  return symbol;
}

/* Reads the size of each thread's stack in global memory (-mstack=global); 0: stacks are in local memory. */
static trax_status stack_size(const trax_image *image, uint32_t *bytes, trax_error *error) {
  const struct trax_symbol *size = trax_image_symbol(image, "__trax_stack_size");
  *bytes = size ? size->address : 0;
  if (size && (!size->absolute || size->address == 0 || size->address % TRAX_GRANULE))
    return trax_fail(error, "%s: __trax_stack_size is not a number of bytes that is a multiple of %u",
                     trax_image_path(image), TRAX_GRANULE);
  return TRAX_OK;
}

/* Stacks lie at the end of memory, thread 0's topmost, each above a guard that must not be written. */
static void place_stacks(struct trax_machine *machine) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  if (!loaded->stack_bytes)
    return;
  const uint64_t stride = (uint64_t)loaded->stack_bytes + TRAX_STACK_GUARD;
  for (uint64_t below = machine->space.size; below > loaded->memory_end; below -= stride)
    trax_space_guard(&machine->space, (uint32_t)(below - stride), TRAX_STACK_GUARD);
}

/* Fills in the words that tell a program about its machine; each word is optional. */
static trax_status fill_words(struct trax_machine *machine, trax_error *error) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  const struct {
    const char *name;
    uint64_t value;
  } words[] = {{"__trax_heap", loaded->free_address},
               {"__trax_heap_end", loaded->memory_end},
               {"__trax_stack_top", machine->space.size},
               {"__trax_clock_mhz", machine->config.chip.clock_mhz}};
  for (size_t i = 0; i < sizeof words / sizeof *words; ++i) {
    if (!trax_image_symbol(loaded->image, words[i].name))
      continue;
    const struct trax_symbol *symbol = trax_loaded_object(machine, words[i].name, 4, error);
    if (!symbol)
      return TRAX_ERROR;
    trax_loaded_store_word(machine, symbol->address, (uint32_t)words[i].value);
  }
  return TRAX_OK;
}

static uint64_t stacks_bytes(const struct trax_machine *machine, uint32_t stack_bytes) {
  const uint64_t threads = (uint64_t)machine->config.chip.tms * machine->config.chip.tps_per_tm;
  return stack_bytes ? threads * (stack_bytes + (uint64_t)TRAX_STACK_GUARD) : 0;
}

static trax_status check_fit(const struct trax_machine *machine, const trax_image *image, uint64_t end,
                             uint32_t *stack_bytes, trax_error *error) {
  const char *path = trax_image_path(image);
  const unsigned long long memory = machine->space.size;
  if (end > memory)
    return trax_fail(error, "%s: the program ends at 0x%08llx, but memory ends at 0x%08llx: raise memory.size_mib",
                     path, (unsigned long long)end, memory);
  if (stack_size(image, stack_bytes, error) != TRAX_OK)
    return TRAX_ERROR;
  const unsigned long long stacks = stacks_bytes(machine, *stack_bytes);
  if (stacks > memory - end)
    return trax_fail(error,
                     "%s: the threads' stacks take %llu bytes, %u each, but only %llu are free after the program: "
                     "raise memory.size_mib or lower -mstack-size",
                     path, stacks, *stack_bytes, memory - end);
  return TRAX_OK;
}

/* The machine takes the image. */
static trax_status load(struct trax_machine *machine, trax_image *image, trax_error *error) {
  const char *path = trax_image_path(image);
  size_t count;
  const struct trax_load_segment *segments = trax_image_segments(image, &count);
  const struct trax_load_segment *last = &segments[count - 1];
  uint64_t end = align_up((uint64_t)last->address + last->memory_bytes, TRAX_GRANULE);
  /* This precedes all mapping, so that a program that does not fit leaves the machine unchanged. */
  uint32_t stack_bytes = 0;
  if (check_fit(machine, image, end, &stack_bytes, error) != TRAX_OK) {
    trax_image_close(image);
    return TRAX_ERROR;
  }
  struct trax_loaded *loaded = calloc(1, sizeof *loaded);
  if (!loaded) {
    trax_image_close(image);
    return trax_fail(error, "%s: out of memory", path);
  }
  loaded->image = image;
  loaded->free_address = end;
  loaded->stack_bytes = stack_bytes;
  loaded->memory_end = machine->space.size - stacks_bytes(machine, stack_bytes);
  machine->loaded = loaded;
  machine->loaded_destroy = destroy_loaded;

  trax_error reason = {.message = ""};
  for (size_t i = 0; i < count; ++i) {
    uint8_t *bytes;
    if (trax_machine_map(machine, segments[i].address, segments[i].memory_bytes, segments[i].permissions, &bytes,
                         &reason) != TRAX_OK)
      return trax_fail(error, "%s: %s", path, reason.message);
    memcpy(bytes, segments[i].bytes, segments[i].file_bytes);
  }
  if (trax_machine_set_entry(machine, trax_image_entry(image), &reason) != TRAX_OK)
    return trax_fail(error, "%s: %s", path, reason.message);
  place_stacks(machine);
  return fill_words(machine, error) == TRAX_OK ? trax_loaded_set_name(machine, error) : TRAX_ERROR;
}

static bool is_new(const struct trax_machine *machine, const char *path, trax_error *error) {
  if (!machine->loaded && !machine->has_program && !machine->has_run)
    return true;
  trax_fail(error, "%s: the machine has a program already", path);
  return false;
}

trax_status trax_machine_load_elf(trax_machine *machine, const char *path, trax_error *error) {
  trax_image *image = is_new(machine, path, error) ? trax_image_open(path, error) : NULL;
  return image ? load(machine, image, error) : TRAX_ERROR;
}

trax_status trax_machine_load_bytes(trax_machine *machine, const char *path, const void *bytes, size_t size,
                                    trax_error *error) {
  trax_image *image = is_new(machine, path, error) ? trax_image_of(path, bytes, size, error) : NULL;
  return image ? load(machine, image, error) : TRAX_ERROR;
}

trax_status trax_loaded_take(struct trax_machine *machine, uint32_t bytes, uint32_t *address, trax_error *error) {
  struct trax_loaded *loaded = trax_loaded_of(machine);
  if (bytes > loaded->memory_end - loaded->free_address)
    return trax_fail(error, "%llu bytes of memory are free after the program: raise memory.size_mib",
                     (unsigned long long)(loaded->memory_end - loaded->free_address));
  *address = (uint32_t)loaded->free_address;
  loaded->free_address = align_up(loaded->free_address + bytes, TRAX_GRANULE);
  if (loaded->free_address > loaded->memory_end)
    loaded->free_address = loaded->memory_end;
  return fill_words(machine, error);
}

/* --- buffers --- */

static struct trax_bound_buffer *find_buffer(const struct trax_loaded *loaded, const char *symbol) {
  for (size_t i = 0; i < loaded->buffer_count; ++i)
    if (strcmp(loaded->buffers[i].symbol, symbol) == 0)
      return &loaded->buffers[i];
  return NULL;
}

/* Returns the address of the next buffer: after a guard, which it shares with the buffer directly before it. */
static uint64_t buffer_address(const struct trax_loaded *loaded) {
  return loaded->free_address + (loaded->free_address == loaded->guard_end ? 0 : TRAX_BUFFER_GUARD);
}

/* The bytes that the next buffer can have. Its guard may reach beyond the end of memory, but not into stacks. */
static uint64_t room_for_buffer(const struct trax_loaded *loaded) {
  const uint64_t taken = buffer_address(loaded) + (loaded->stack_bytes ? TRAX_BUFFER_GUARD : 0);
  return loaded->memory_end > taken ? loaded->memory_end - taken : 0;
}

/* Makes all checks that do not need the buffer's bytes, and room for one more buffer in the table. */
static trax_status check_bind(struct trax_machine *machine, const char *symbol, trax_error *error) {
  struct trax_loaded *loaded = trax_loaded_of(machine);
  if (!loaded)
    return trax_fail(error, "buffer %s: no program is loaded", symbol);
  if (machine->has_run)
    return trax_fail(error, "buffer %s: the program has run already", symbol);
  if (find_buffer(loaded, symbol))
    return trax_fail(error, "buffer %s is bound twice", symbol);
  if (!trax_loaded_object(machine, symbol, 8, error))
    return TRAX_ERROR;
  struct trax_bound_buffer *buffers = realloc(loaded->buffers, (loaded->buffer_count + 1) * sizeof *buffers);
  if (!buffers)
    return trax_fail(error, "buffer %s: out of memory", symbol);
  loaded->buffers = buffers;
  return TRAX_OK;
}

static trax_status too_large(const struct trax_machine *machine, const char *symbol, trax_error *error) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  return trax_fail(error, "buffer %s does not fit into memory: %llu bytes are free of %llu; raise memory.size_mib",
                   symbol, (unsigned long long)room_for_buffer(loaded), (unsigned long long)machine->space.size);
}

/* Binds the buffer whose bytes have been copied to buffer_address. */
static trax_status finish_bind(struct trax_machine *machine, const char *symbol, uint32_t bytes, bool filled,
                               trax_error *error) {
  struct trax_loaded *loaded = trax_loaded_of(machine);
  const uint64_t address = buffer_address(loaded), end = address + bytes, words_end = align_up(end, 4);
  const uint64_t guard_end = align_up(end, TRAX_GRANULE) + TRAX_BUFFER_GUARD;
  char *name = strdup(symbol);
  if (!name)
    return trax_fail(error, "buffer %s: out of memory", symbol);
  const struct trax_symbol *object = trax_image_symbol(loaded->image, symbol);
  trax_loaded_store_word(machine, object->address, (uint32_t)address);
  trax_loaded_store_word(machine, object->address + 4, bytes);
  loaded->buffers[loaded->buffer_count++] = (struct trax_bound_buffer){name, (uint32_t)address, bytes};
  const uint64_t before = loaded->free_address;
  loaded->free_address = loaded->guard_end = guard_end < loaded->memory_end ? guard_end : loaded->memory_end;
  if (trax_space_dig(&machine->space, before, address, error) != TRAX_OK ||
      trax_space_dig(&machine->space, end, loaded->guard_end, error) != TRAX_OK)
    return TRAX_ERROR;
  if (filled && words_end - address > machine->space.input_bytes) {
    machine->space.input = (uint32_t)address;
    machine->space.input_bytes = (uint32_t)(words_end - address);
  }
  return fill_words(machine, error);
}

trax_status trax_machine_bind(trax_machine *machine, const char *symbol, const void *bytes, uint32_t size,
                              trax_error *error) {
  if (check_bind(machine, symbol, error) != TRAX_OK)
    return TRAX_ERROR;
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  const uint64_t address = buffer_address(loaded);
  if (size > room_for_buffer(loaded) || address > loaded->memory_end)
    return too_large(machine, symbol, error);
  if (bytes && size)
    memcpy(machine->space.bytes + address, bytes, size);
  return finish_bind(machine, symbol, size, bytes != NULL, error);
}

trax_status trax_machine_bind_file(trax_machine *machine, const char *symbol, const char *path, trax_error *error) {
  if (check_bind(machine, symbol, error) != TRAX_OK)
    return TRAX_ERROR;
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  const uint64_t room = room_for_buffer(loaded);
  trax_input input;
  trax_error reason;
  trax_status status = trax_input_open(&input, path, &reason);
  if (status == TRAX_OK && input.expected <= room)
    status = trax_input_read(&input, room + 1, &reason); /* one byte more proves that the file is too large */
  if (status != TRAX_OK)
    trax_fail(error, "buffer %s: %s", symbol, reason.message);
  else if (input.expected > room || input.size > room)
    status = too_large(machine, symbol, error);
  else
    status = trax_machine_bind(machine, symbol, input.bytes, (uint32_t)input.size, error);
  trax_input_close(&input);
  return status;
}

trax_status trax_machine_buffer(trax_machine *machine, const char *symbol, uint32_t *address, uint8_t **bytes,
                                uint32_t *size, trax_error *error) {
  const struct trax_bound_buffer *buffer = machine->loaded ? find_buffer(machine->loaded, symbol) : NULL;
  if (!buffer)
    return trax_fail(error, "no buffer %s is bound", symbol);
  *address = buffer->address;
  *bytes = machine->space.bytes + buffer->address;
  *size = buffer->bytes;
  return TRAX_OK;
}

trax_status trax_machine_read_buffer(trax_machine *machine, const char *symbol, const uint8_t **bytes, uint32_t *size,
                                     trax_error *error) {
  uint32_t address;
  uint8_t *found = NULL;
  const trax_status status = trax_machine_buffer(machine, symbol, &address, &found, size, error);
  if (status == TRAX_OK)
    *bytes = found;
  return status;
}

bool trax_machine_find_symbol(const trax_machine *machine, const char *symbol, uint32_t *address, uint32_t *size) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  const struct trax_symbol *found = loaded ? trax_image_symbol(loaded->image, symbol) : NULL;
  if (!found)
    return false;
  *address = found->address;
  *size = found->bytes;
  return true;
}

trax_status trax_machine_read_program(const trax_machine *machine, const uint8_t **bytes, size_t *size,
                                      trax_error *error) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  if (!loaded)
    return trax_fail(error, "no program is loaded");
  *bytes = trax_image_bytes(loaded->image, size);
  return TRAX_OK;
}

trax_status trax_machine_read_symbol(const trax_machine *machine, const char *symbol, const uint8_t **bytes,
                                     uint32_t *size, trax_error *error) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  if (!loaded)
    return trax_fail(error, "no program is loaded");
  const struct trax_symbol *found = trax_image_symbol(loaded->image, symbol);
  if (!found)
    return trax_fail(error, "%s: the program has no symbol %s", trax_image_path(loaded->image), symbol);
  if (found->address < TRAX_NULL_END || (uint64_t)found->address + found->bytes > machine->space.size)
    return trax_fail(error, "%s: %s is not in global memory", trax_image_path(loaded->image), symbol);
  *bytes = machine->space.bytes + found->address;
  *size = found->bytes;
  return TRAX_OK;
}
