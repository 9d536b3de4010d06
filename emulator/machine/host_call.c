#include "machine/host_call.h"

#include "machine/machine.h"

#include <string.h>

static const uint64_t granules_end = (uint64_t)1 << 32;

uint8_t *trax_host_call_bytes(const struct trax_host_call *call, uint32_t address, uint32_t bytes, bool write) {
  static uint8_t nothing[1];
  const struct trax_space *space = &call->machine->space;
  if (!bytes)
    return nothing;
  if (address >= TRAX_LOCAL_BASE)
    return address + (uint64_t)bytes <= granules_end ? call->local + (address - TRAX_LOCAL_BASE) : NULL;
  if (address < TRAX_NULL_END || address + (uint64_t)bytes > space->size ||
      trax_space_in_hole(space, address, bytes, write))
    return NULL;
  for (uint32_t granule = address / TRAX_GRANULE; write && granule <= (address + bytes - 1) / TRAX_GRANULE; granule++)
    if (space->restrictions[granule] & TRAX_RESTRICT_WRITE)
      return NULL;
  if (write && call->machine->calls.before_write)
    call->machine->calls.before_write(call->machine->calls.engine, address, bytes);
  return space->bytes + address;
}

void trax_host_print(const struct trax_machine *machine, FILE *output, const char *bytes, size_t count) {
  if (machine->calls.print)
    machine->calls.print(machine->calls.context, (const uint8_t *)bytes, count);
  else if (output)
    fwrite(bytes, 1, count, output);
}

trax_fault_kind trax_host_trap(const struct trax_machine *machine, uint8_t *local, uint32_t block) {
  struct trax_host_call call = {.machine = machine, .local = local};
  if (block < TRAX_LOCAL_BASE) {
    trax_fault_kind kind = trax_space_check(&machine->space, block, 4, true);
    if (!kind)
      kind = trax_space_check(&machine->space, block + (uint32_t)sizeof call.words - 4, 4, true);
    if (kind)
      return kind;
  } else if (block % 4) {
    return TRAX_FAULT_MISALIGNED;
  }
  const uint8_t *words = trax_host_call_bytes(&call, block, sizeof call.words, false);
  if (!words)
    return TRAX_FAULT_UNMAPPED;
  memcpy(call.words, words, sizeof call.words);
  const int32_t result =
      machine->calls.serve ? machine->calls.serve(machine->calls.context, &call) : -TRAX_HOST_NO_CALL;
  uint8_t *answer = trax_host_call_bytes(&call, block, sizeof result, true);
  if (!answer)
    return TRAX_FAULT_READ_ONLY;
  memcpy(answer, &result, sizeof result);
  return TRAX_FAULT_NONE;
}
