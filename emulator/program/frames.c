/* Frames of functions: their sizes, and the automatic variables in them. */
#include <dwarf.h>
#include <stdlib.h>

#include "program/image_internal.h"
#include "trax/abi.h"
#include "trax/grow.h"

enum { MAX_DEPTH = 64, MAX_FRAME = 1 << 30 }; /* of nested entries; of bytes */

/* --- .stack_sizes: for each function its address, a word, and the size of its frame, ULEB128 --- */

void trax_image_frames(const trax_image *image, void (*visit)(void *context, uint32_t function, uint32_t bytes),
                       void *context) {
  trax_dwarf_reader reader;
  if (!trax_image_section(image, ".stack_sizes", &reader))
    return;
  while (reader.at < reader.end) {
    const uint32_t function = trax_dwarf_fixed(&reader, 4);
    const uint64_t size = trax_dwarf_leb(&reader, false);
    if (!reader.bad)
      visit(context, function, size > INT32_MAX ? INT32_MAX : (uint32_t)size);
  }
}

/* --- variables --- */

struct variables {
  struct trax_frame_variable *items;
  size_t count, capacity;
};

static void add_variable(struct variables *variables, Dwarf_Die *entry) {
  Dwarf_Attribute location, type_attribute, name;
  Dwarf_Die type;
  Dwarf_Op *ops;
  size_t count;
  Dwarf_Word bytes;
  if (dwarf_attr(entry, DW_AT_location, &location) && dwarf_getlocation(&location, &ops, &count) == 0 && count == 1 &&
      ops[0].atom == DW_OP_fbreg &&
      dwarf_formref_die(dwarf_attr_integrate(entry, DW_AT_type, &type_attribute), &type) &&
      dwarf_aggregate_size(&type, &bytes) == 0 && bytes && bytes < MAX_FRAME &&
      ops[0].number + MAX_FRAME < 2 * (Dwarf_Word)MAX_FRAME &&
      trax_grow((void **)&variables->items, variables->count, &variables->capacity, sizeof *variables->items)) {
    const char *text = dwarf_formstring(dwarf_attr_integrate(entry, DW_AT_name, &name));
    const int32_t begin = (int32_t)(Dwarf_Sword)ops[0].number;
    variables->items[variables->count++] =
        (struct trax_frame_variable){text ? text : "a variable", begin, begin + (int32_t)bytes,
                                     dwarf_peel_type(&type, &type) == 0 && dwarf_tag(&type) == DW_TAG_array_type};
  }
}

static void add_variables(struct variables *variables, Dwarf_Die *parent, int depth) {
  Dwarf_Die child;
  if (depth == MAX_DEPTH || dwarf_child(parent, &child) != 0)
    return;
  do {
    const int tag = dwarf_tag(&child);
    if (tag == DW_TAG_variable || tag == DW_TAG_formal_parameter)
      add_variable(variables, &child);
    else if (tag == DW_TAG_lexical_block || tag == DW_TAG_inlined_subroutine)
      add_variables(variables, &child, depth + 1);
  } while (dwarf_siblingof(&child, &child) == 0);
}

/* In C++, unnamed objects share the places of variables that live at other times. */
static bool is_c(Dwarf_Die *function) {
  enum { C17 = 0x2C }; /* a language that older versions of dwarf.h lack */
  Dwarf_Die unit;
  const int language = dwarf_diecu(function, &unit, NULL, NULL) ? dwarf_srclang(&unit) : -1;
  return language == DW_LANG_C89 || language == DW_LANG_C || language == DW_LANG_C99 || language == DW_LANG_C11 ||
         language == C17;
}

size_t trax_image_variables(trax_image *image, uint32_t pc, struct trax_frame_variable **items, unsigned *base) {
  static const uint8_t registers[TRAX_NUM_REGISTERS] = TRAX_DWARF_REGISTERS;
  struct variables variables = {0};
  Dwarf_Die function;
  Dwarf_Attribute attribute;
  Dwarf_Op *ops;
  size_t count;
  *items = NULL;
  if (!trax_image_function(image, pc, &function) || !is_c(&function) ||
      !dwarf_attr(&function, DW_AT_frame_base, &attribute) || dwarf_getlocation(&attribute, &ops, &count) != 0 ||
      count != 1 || ops[0].atom < DW_OP_reg0 || ops[0].atom > DW_OP_reg31)
    return 0;
  *base = registers[ops[0].atom - DW_OP_reg0];
  add_variables(&variables, &function, 0);
  *items = variables.items;
  return variables.count;
}
