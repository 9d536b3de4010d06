/* The program's buffers to which nothing is bound, for the report of a fault. */
#include <dwarf.h>
#include <string.h>

#include "machine/address_space.h"
#include "program/image_internal.h"
#include "program/program.h"

/* Whether a variable is a struct trax_buffer. */
static bool is_buffer_type(Dwarf_Die *variable) {
  Dwarf_Attribute attribute;
  Dwarf_Die type;
  if (!dwarf_formref_die(dwarf_attr_integrate(variable, DW_AT_type, &attribute), &type) ||
      dwarf_peel_type(&type, &type) != 0)
    return false;
  const char *name = dwarf_diename(&type);
  return name && strcmp(name, "trax_buffer") == 0;
}

/* Finds a global variable in the debug information. */
static bool find_variable(Dwarf *dwarf, const char *name, Dwarf_Die *variable) {
  Dwarf_CU *cu = NULL;
  Dwarf_Die unit;
  while (dwarf && dwarf_get_units(dwarf, cu, &cu, NULL, NULL, &unit, NULL) == 0) {
    if (dwarf_child(&unit, variable) != 0)
      continue;
    do {
      const char *its = dwarf_tag(variable) == DW_TAG_variable ? dwarf_diename(variable) : NULL;
      if (its && strcmp(its, name) == 0)
        return true;
    } while (dwarf_siblingof(variable, variable) == 0);
  }
  return false;
}

/* A variable without debug information may be a buffer if it has its size and is empty. */
static bool may_be_buffer(const struct trax_machine *machine, const struct trax_symbol *symbol) {
  static const uint8_t zeros[sizeof(uint32_t) * 2];
  trax_error ignored;
  return symbol->type == TRAX_SYMBOL_OBJECT && symbol->bytes == sizeof zeros && strncmp(symbol->name, "__", 2) != 0 &&
         trax_loaded_object(machine, symbol->name, sizeof zeros, &ignored) == symbol &&
         !(machine->space.restrictions[symbol->address / TRAX_GRANULE] & TRAX_RESTRICT_WRITE) &&
         memcmp(machine->space.bytes + symbol->address, zeros, sizeof zeros) == 0;
}

const char *trax_loaded_unbound(const struct trax_machine *machine, size_t *from) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  size_t count;
  const struct trax_symbol *symbols = loaded ? trax_image_symbols(loaded->image, &count) : NULL;
  while (symbols && *from < count) {
    const struct trax_symbol *symbol = &symbols[(*from)++];
    Dwarf_Die variable;
    bool bound = false;
    for (size_t i = 0; i < loaded->buffer_count; i++)
      bound |= strcmp(loaded->buffers[i].symbol, symbol->name) == 0;
    if (!bound && may_be_buffer(machine, symbol) &&
        (!find_variable(trax_image_dwarf(loaded->image), symbol->name, &variable) || is_buffer_type(&variable)))
      return symbol->name;
  }
  return NULL;
}
