/* Source lines from DWARF. Damaged debug information is never an error: the line is then unknown. */
#include <dwarf.h>

#include "program/image_internal.h"

/* Finds the unit that contains pc. .debug_aranges is optional and compilers omit it, so all units are searched. */
static bool unit_at(Dwarf *dwarf, uint32_t pc, Dwarf_Die *unit) {
  Dwarf_CU *cu = NULL;
  while (dwarf_get_units(dwarf, cu, &cu, NULL, NULL, unit, NULL) == 0)
    if (dwarf_haspc(unit, pc) == 1)
      return true;
  return false;
}

static const char *name_of(Dwarf_Die *die) {
  Dwarf_Attribute attribute;
  return dwarf_formstring(dwarf_attr_integrate(die, DW_AT_name, &attribute));
}

/* Returns the name to the linker; without one of its own, a function has its name in C. */
static const char *linkage_of(Dwarf_Die *die) {
  Dwarf_Attribute attribute;
  const char *linkage = dwarf_formstring(dwarf_attr_integrate(die, DW_AT_linkage_name, &attribute));
  return linkage ? linkage : name_of(die);
}

static int number_of(Dwarf_Die *die, unsigned attribute_name) {
  Dwarf_Attribute attribute;
  Dwarf_Word value;
  if (dwarf_formudata(dwarf_attr_integrate(die, attribute_name, &attribute), &value) != 0 || value > INT32_MAX)
    return 0;
  return (int)value;
}

/* Returns the file of a DW_AT_call_file number. */
static const char *file_of(Dwarf_Die *unit, int number) {
  Dwarf_Files *files;
  size_t count;
  if (dwarf_getsrcfiles(unit, &files, &count) != 0 || number < 0 || (size_t)number >= count)
    return NULL;
  return dwarf_filesrc(files, (size_t)number, NULL, NULL);
}

enum { GNU_DISCRIMINATOR = 0x2136 }; /* an attribute of calls, which dwarf.h lacks */
enum { MAX_DEPTH = 64 }; /* of nested scopes */

/* The functions that contain a pc, outermost first. */
struct scopes {
  Dwarf_Die functions[MAX_DEPTH];
  size_t count;
};

/* Adds the functions within parent that contain pc, inlined ones included. dwarf_getscopes is no use: from an inlined
   function it continues to its definition, not to its call. Offsets must increase, so that damaged information cannot
   form a cycle. */
static bool add_scopes(Dwarf_Die *parent, uint32_t pc, int depth, struct scopes *scopes) {
  Dwarf_Die child;
  if (depth == MAX_DEPTH || dwarf_child(parent, &child) != 0)
    return false;
  for (Dwarf_Off last = dwarf_dieoffset(parent);;) {
    Dwarf_Off offset = dwarf_dieoffset(&child);
    if (offset <= last)
      return false;
    last = offset;
    switch (dwarf_tag(&child)) {
    case DW_TAG_subprogram:
    case DW_TAG_inlined_subroutine:
      if (dwarf_haspc(&child, pc) == 1) {
        scopes->functions[scopes->count++] = child;
        add_scopes(&child, pc, depth + 1, scopes);
        return true;
      }
      break;
    case DW_TAG_lexical_block:
      if (dwarf_haspc(&child, pc) == 1)
        return add_scopes(&child, pc, depth + 1, scopes);
      break;
    case DW_TAG_namespace: /* these have no addresses */
    case DW_TAG_structure_type:
    case DW_TAG_class_type:
      if (add_scopes(&child, pc, depth + 1, scopes))
        return true;
      break;
    default:
      break;
    }
    if (dwarf_siblingof(&child, &child) != 0)
      return false;
  }
}

size_t trax_image_lines(trax_image *image, uint32_t pc, struct trax_source_line *lines, size_t capacity) {
  if (!image->dwarf_tried) {
    image->dwarf_tried = true;
    image->dwarf = dwarf_begin_elf(image->elf, DWARF_C_READ, NULL);
  }
  Dwarf_Die unit;
  if (!image->dwarf || capacity == 0 || !unit_at(image->dwarf, pc, &unit))
    return 0;
  Dwarf_Line *row = dwarf_getsrc_die(&unit, pc);
  const char *file = row ? dwarf_linesrc(row, NULL, NULL) : NULL;
  if (!file)
    return 0;
  lines[0] = (struct trax_source_line){.file = file};
  dwarf_lineno(row, &lines[0].line);
  dwarf_linecol(row, &lines[0].column);
  unsigned discriminator;
  if (dwarf_linediscriminator(row, &discriminator) == 0)
    lines[0].discriminator = (int)discriminator;
  size_t count = 1;

  struct scopes scopes = {.count = 0};
  add_scopes(&unit, pc, 0, &scopes);
  while (scopes.count) {
    Dwarf_Die *function = &scopes.functions[--scopes.count];
    lines[count - 1].function = name_of(function);
    lines[count - 1].linkage = linkage_of(function);
    lines[count - 1].function_line = number_of(function, DW_AT_decl_line);
    if (dwarf_tag(function) == DW_TAG_subprogram || count == capacity)
      break;
    const char *caller = file_of(&unit, number_of(function, DW_AT_call_file));
    if (!caller)
      break;
    lines[count++] = (struct trax_source_line){.file = caller,
                                               .line = number_of(function, DW_AT_call_line),
                                               .column = number_of(function, DW_AT_call_column),
                                               .discriminator = number_of(function, GNU_DISCRIMINATOR)};
  }
  return count;
}

void trax_image_forget_lines(trax_image *image) {
  dwarf_end(image->dwarf);
  image->dwarf = NULL;
}
