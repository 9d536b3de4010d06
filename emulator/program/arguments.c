/* The start of a program: the arguments of main, and the threads that call it (docs/abi.md, "Program start"). */
#include <string.h>

#include "program/program.h"
#include "trax/abi.h"
#include "trax/isa.h"

trax_status trax_machine_set_arguments(trax_machine *machine, const char *const *arguments, size_t count,
                                       trax_error *error) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  if (!loaded || machine->has_run)
    return trax_fail(error, loaded ? "the program has run already" : "no program is loaded");
  if (!trax_image_symbol(loaded->image, TRAX_ARGUMENTS_SYMBOL))
    return count <= 1 ? TRAX_OK
                      : trax_fail(error,
                                  "%s: the program takes no arguments, as '%s': its main has no parameters or does "
                                  "not use them, or its symbol table was removed",
                                  trax_image_path(loaded->image), arguments[1]);
  const struct trax_symbol *object = trax_loaded_object(machine, TRAX_ARGUMENTS_SYMBOL, 8, error);
  if (!object)
    return TRAX_ERROR;
  uint64_t bytes = 4 * (count + 1);
  for (size_t i = 0; i < count; i++)
    bytes += strlen(arguments[i]) + 1;
  uint32_t pointer;
  trax_error reason;
  if (bytes > UINT32_MAX || trax_loaded_take(machine, (uint32_t)bytes, &pointer, &reason) != TRAX_OK)
    return trax_fail(error, "%s: its arguments do not fit into memory", trax_image_path(loaded->image));
  trax_loaded_store_word(machine, object->address, (uint32_t)count);
  trax_loaded_store_word(machine, object->address + 4, pointer);
  uint32_t text = pointer + 4 * ((uint32_t)count + 1);
  for (size_t i = 0; i < count; i++, pointer += 4) {
    const size_t size = strlen(arguments[i]) + 1;
    trax_loaded_store_word(machine, pointer, text);
    memcpy(machine->space.bytes + text, arguments[i], size);
    text += (uint32_t)size;
  }
  trax_loaded_store_word(machine, pointer, 0);
  return TRAX_OK;
}

trax_status trax_loaded_set_name(struct trax_machine *machine, trax_error *error) {
  const char *path = trax_image_path(trax_loaded_of(machine)->image), *slash = strrchr(path, '/');
  const char *name = slash ? slash + 1 : path;
  return trax_machine_set_arguments(machine, &name, 1, error);
}

/* Whether an instruction lies at an address. A symbol table may name any other. */
static bool is_text(const struct trax_machine *machine, uint32_t pc) {
  for (size_t i = 0; i < machine->space.segment_count; i++) {
    const struct trax_segment *segment = &machine->space.segments[i];
    if (segment->permissions & TRAX_PERMIT_EXECUTE && pc % 4 == 0 && pc >= segment->address &&
        pc - segment->address < segment->bytes / 4 * 4)
      return true;
  }
  return false;
}

/* Finds the instruction after the start code's call of main, where a thread ends. */
static bool find_end(const struct trax_machine *machine, uint32_t *end) {
  const trax_image *image = trax_loaded_of(machine)->image;
  const struct trax_symbol *start = trax_image_symbol(image, "_start"), *main = trax_image_symbol(image, "main");
  if (!start || !main || start->address != machine->entry)
    return false;
  for (uint32_t pc = start->address; pc - start->address < start->bytes && is_text(machine, pc); pc += 4) {
    uint32_t word;
    memcpy(&word, machine->space.bytes + pc, sizeof word);
    const trax_inst inst = trax_decode(word);
    if (inst.op == TRAX_OP_JAL && pc + (uint32_t)inst.imm == main->address && is_text(machine, pc + 4)) {
      *end = pc + 4;
      return true;
    }
  }
  return false;
}

trax_status trax_machine_main_on_thread_0(trax_machine *machine, trax_error *error) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  if (!loaded || machine->has_run)
    return trax_fail(error, loaded ? "the program has run already" : "no program is loaded");
  const struct trax_symbol *others = trax_image_symbol(loaded->image, "__trax_others");
  uint32_t entry;
  if (others) {
    const struct trax_symbol *waiting = trax_loaded_object(machine, "__trax_waiting", 4, error);
    if (!waiting)
      return TRAX_ERROR;
    trax_loaded_store_word(machine, waiting->address, (uint32_t)machine->stats.threads - 1);
    if (!is_text(machine, others->address))
      return trax_fail(error, "%s: its start code for other threads is at 0x%08x, where no instruction is",
                       trax_image_path(loaded->image), others->address);
    entry = others->address;
  } else if (!find_end(machine, &entry)) {
    return trax_fail(error,
                     "%s: main cannot be called on one thread: it has not the library's start code, or its symbol "
                     "table was removed",
                     trax_image_path(loaded->image));
  }
  machine->other_entry = entry;
  return TRAX_OK;
}
