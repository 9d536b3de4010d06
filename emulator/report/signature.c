/* Signatures (docs/isa.md, "Signatures"). */
#include "program/program.h"

#include <inttypes.h>

#include "trax/output.h"

/* Finds the range of the signature's words: [*begin, *end). */
static trax_status find(const trax_machine *machine, uint32_t *begin, uint32_t *end, trax_error *error) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  if (!loaded)
    return trax_fail(error, "signature: no program is loaded");
  const char *path = trax_image_path(loaded->image);
  const struct trax_symbol *first = trax_image_symbol(loaded->image, "begin_signature");
  const struct trax_symbol *last = trax_image_symbol(loaded->image, "end_signature");
  if (!first || !last)
    return trax_fail(error, "%s: the program has no symbol %s, and so no signature", path,
                     first ? "end_signature" : "begin_signature");
  *begin = first->address;
  *end = last->address;
  if (*begin % 4 || *end % 4 || *begin < TRAX_NULL_END || *begin > *end || *end > machine->space.size)
    return trax_fail(error, "%s: begin_signature 0x%08x and end_signature 0x%08x do not enclose words of global memory",
                     path, *begin, *end);
  return TRAX_OK;
}

trax_status trax_machine_check_signature(const trax_machine *machine, trax_error *error) {
  uint32_t begin = 0, end = 0;
  return find(machine, &begin, &end, error);
}

trax_status trax_machine_write_signature(const trax_machine *machine, const char *path, trax_error *error) {
  const struct trax_fault *fault = trax_machine_fault(machine);
  uint32_t begin = 0, end = 0;
  trax_output output;
  if (find(machine, &begin, &end, error) != TRAX_OK || trax_output_open(&output, path, error) != TRAX_OK)
    return TRAX_ERROR;
  for (uint32_t address = begin; address < end; address += 4) {
    const uint8_t *bytes = machine->space.bytes + address;
    fprintf(output.file, "%02x%02x%02x%02x\n", bytes[3], bytes[2], bytes[1], bytes[0]);
  }
  if (fault->kind != TRAX_FAULT_NONE)
    fprintf(output.file, "fault %s pc %08" PRIx32 " address %08" PRIx32 "\n", trax_fault_name(fault->kind), fault->pc,
            fault->address);
  return trax_output_commit(&output, error);
}
