/* Source lines from DWARF. Debug information is only ever a help: whatever is wrong with it means "unknown". */
#include <dwarf.h>
#include <stdlib.h>
#include <string.h>

#include "image_internal.h"

/* The unit that contains pc; aranges are optional in DWARF and compilers leave them out, so all units are asked. */
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

static int number_of(Dwarf_Die *die, unsigned attribute_name) {
  Dwarf_Attribute attribute;
  Dwarf_Word value;
  if (dwarf_formudata(dwarf_attr(die, attribute_name, &attribute), &value) != 0 || value > INT32_MAX)
    return 0;
  return (int)value;
}

/* The file a DW_AT_call_file number means. */
static const char *file_of(Dwarf_Die *unit, int number) {
  Dwarf_Files *files;
  size_t count;
  if (dwarf_getsrcfiles(unit, &files, &count) != 0 || number < 0 || (size_t)number >= count)
    return NULL;
  return dwarf_filesrc(files, (size_t)number, NULL, NULL);
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
  size_t count = 1;

  /* dwarf_getscopes follows an inlined function to where it was written; its first scope's own parents are the callers.
   */
  Dwarf_Die *at_pc = NULL, *scopes = NULL;
  int depth = 0;
  if (dwarf_getscopes(&unit, pc, &at_pc) > 0)
    depth = dwarf_getscopes_die(&at_pc[0], &scopes);
  free(at_pc);
  for (int i = 0; i < depth; ++i) {
    int tag = dwarf_tag(&scopes[i]);
    if (tag != DW_TAG_inlined_subroutine && tag != DW_TAG_subprogram)
      continue;
    lines[count - 1].function = name_of(&scopes[i]);
    if (tag == DW_TAG_subprogram || count == capacity)
      break;
    const char *caller = file_of(&unit, number_of(&scopes[i], DW_AT_call_file));
    if (!caller)
      break;
    lines[count++] = (struct trax_source_line){.file = caller,
                                               .line = number_of(&scopes[i], DW_AT_call_line),
                                               .column = number_of(&scopes[i], DW_AT_call_column)};
  }
  free(scopes);
  return count;
}

void trax_image_forget_lines(trax_image *image) {
  dwarf_end(image->dwarf);
  image->dwarf = NULL;
}
