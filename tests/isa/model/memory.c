/* The address space of docs/abi.md: a null page, global memory, and each thread's local memory at the end. */
#include "model.h"

#include <stdlib.h>
#include <string.h>

#define GRANULE 64u          /* bytes with the same permissions */
#define STACK_REACH 0x10000u /* an access that far below local memory is the stack's overflow */
#define STACK_GUARD 2048u    /* bytes below each stack in global memory */

static uint64_t granules_end(uint32_t address, uint32_t bytes) {
  return ((uint64_t)address + bytes + GRANULE - 1) / GRANULE * GRANULE;
}

bool model_map(struct model_machine *machine, uint32_t address, uint32_t bytes, unsigned permissions, uint8_t **host,
               struct model_error *error) {
  const uint64_t end = (uint64_t)address + bytes;
  if (address < MODEL_NULL_END || address % GRANULE || end > machine->size)
    return model_fail(
        error, "segment 0x%08x..0x%08llx: not at a multiple of %u, or outside of global memory, which ends at 0x%08llx",
        address, (unsigned long long)end, GRANULE, (unsigned long long)machine->size);
  if (permissions & MODEL_WRITE && permissions & MODEL_EXECUTE)
    return model_fail(error, "segment 0x%08x is both writable and executable", address);
  for (size_t i = 0; i < machine->segment_count; i++) {
    const struct model_segment *other = &machine->segments[i];
    if (address < granules_end(other->address, other->bytes) && other->address < granules_end(address, bytes))
      return model_fail(error, "segments 0x%08x and 0x%08x share %u bytes", other->address, address, GRANULE);
  }
  struct model_segment *segments = realloc(machine->segments, (machine->segment_count + 1) * sizeof *segments);
  if (!segments)
    return model_fail(error, "out of memory");
  machine->segments = segments;
  segments[machine->segment_count++] = (struct model_segment){address, bytes, permissions};
  if (host)
    *host = machine->memory + address;
  return true;
}

static bool is_guard(const struct model_machine *machine, uint32_t address) {
  const uint64_t stride = machine->stack_bytes + (uint64_t)STACK_GUARD, depth = machine->size - address - 1;
  return machine->stack_bytes && depth / stride < machine->thread_count && depth % stride >= machine->stack_bytes;
}

/* The memory of a global address. */
static enum model_fault_kind check_write(const struct model_machine *machine, uint32_t address) {
  for (size_t i = 0; i < machine->segment_count; i++) {
    const struct model_segment *segment = &machine->segments[i];
    if (address >= segment->address && address < granules_end(segment->address, segment->bytes) &&
        !(segment->permissions & MODEL_WRITE))
      return MODEL_FAULT_READ_ONLY;
  }
  return is_guard(machine, address) ? MODEL_FAULT_STACK : MODEL_FAULT_NONE;
}

enum model_fault_kind model_check(const struct model_machine *machine, uint32_t address, uint32_t bytes,
                                  enum model_access access) {
  const bool is_local = address >= MODEL_LOCAL_BASE;
  if (address < MODEL_NULL_END)
    return MODEL_FAULT_NULL;
  if (address >= machine->size && !is_local)
    return MODEL_LOCAL_BASE - address <= STACK_REACH ? MODEL_FAULT_STACK : MODEL_FAULT_UNMAPPED;
  if (address % bytes)
    return MODEL_FAULT_MISALIGNED;
  if (is_local)
    return access == MODEL_INCREMENT ? MODEL_FAULT_LOCAL : MODEL_FAULT_NONE;
  return access != MODEL_LOAD ? check_write(machine, address) : MODEL_FAULT_NONE;
}

static uint8_t *place(struct model_machine *machine, struct model_thread *thread, uint32_t address) {
  return address >= MODEL_LOCAL_BASE ? thread->local + (address - MODEL_LOCAL_BASE) : machine->memory + address;
}

uint32_t model_load(struct model_machine *machine, struct model_thread *thread, uint32_t address, uint32_t bytes,
                    bool past_cache) {
  (void)past_cache; /* there is none */
  uint32_t value = 0;
  for (uint32_t i = bytes; i-- > 0;)
    value = value << 8 | *place(machine, thread, address + i);
  return value;
}

void model_store(struct model_machine *machine, struct model_thread *thread, uint32_t address, uint32_t value,
                 uint32_t bytes, bool past_cache) {
  (void)past_cache;
  for (uint32_t i = 0; i < bytes; i++, value >>= 8)
    *place(machine, thread, address + i) = (uint8_t)value;
}

uint32_t model_increment(struct model_machine *machine, struct model_thread *thread, uint32_t address) {
  const uint32_t value = model_load(machine, thread, address, 4, true);
  model_store(machine, thread, address, value + 1, 4, true);
  return value;
}

void model_fence(struct model_machine *machine, struct model_thread *thread, enum model_fence kind) {
  (void)machine; /* everything is performed when it is executed */
  (void)thread;
  (void)kind;
}
