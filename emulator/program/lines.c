/* Source lines from DWARF. Damaged debug information is never an error: the line is then unknown. */
#include <dwarf.h>
#include <stdlib.h>

#include "program/image_internal.h"
#include "trax/grow.h"

/* --- scopes: units, functions, and functions that are inlined into these, by address --- */

struct trax_scope {
  Dwarf_Die entry;
  uint32_t parent;       /* 0: of a unit */
  uint32_t first, count; /* the ranges of the scopes within */
};

struct trax_scope_range {
  uint32_t parent, begin, last, scope; /* addresses begin to last */
};

struct trax_scopes {
  struct trax_scope *scopes; /* [0] contains the units */
  size_t count, capacity;
  struct trax_scope_range *ranges; /* in the order of parent and begin */
  size_t range_count, range_capacity;
  size_t most_ranges; /* a range takes a byte of the file at least; damaged entries may share a list of them */
  const char **folders;
  size_t folder_count, folder_capacity;
  Dwarf_Off last; /* offset of the entry visited last */
};

enum { MAX_DEPTH = 64 }; /* of nested entries */

/* Adds a scope. Returns its number; 0: it has no addresses, as a function that is inlined everywhere, or there is no
   memory. */
static uint32_t add_scope(struct trax_scopes *scopes, Dwarf_Die *entry, uint32_t parent) {
  Dwarf_Addr base, begin, end;
  const size_t before = scopes->range_count;
  if (!trax_grow((void **)&scopes->scopes, scopes->count, &scopes->capacity, sizeof *scopes->scopes))
    return 0;
  for (ptrdiff_t at = 0; (at = dwarf_ranges(entry, at, &base, &begin, &end)) > 0;)
    if (begin < end && end <= (Dwarf_Addr)UINT32_MAX + 1) {
      if (scopes->range_count == scopes->most_ranges ||
          !trax_grow((void **)&scopes->ranges, scopes->range_count, &scopes->range_capacity, sizeof *scopes->ranges))
        return 0;
      scopes->ranges[scopes->range_count++] =
          (struct trax_scope_range){parent, (uint32_t)begin, (uint32_t)(end - 1), (uint32_t)scopes->count};
    }
  if (scopes->range_count == before)
    return 0;
  scopes->scopes[scopes->count] = (struct trax_scope){.entry = *entry, .parent = parent};
  return (uint32_t)scopes->count++;
}

/* Adds the scopes within an entry. dwarf_getscopes is no use: from an inlined function it continues to its definition,
   not to its call. Offsets must increase, so that entries of damaged information are visited once. */
static void add_scopes(struct trax_scopes *scopes, Dwarf_Die *parent, uint32_t scope, int depth) {
  Dwarf_Die child;
  if (depth == MAX_DEPTH || dwarf_child(parent, &child) != 0)
    return;
  do {
    const Dwarf_Off offset = dwarf_dieoffset(&child);
    if (offset <= scopes->last)
      return;
    scopes->last = offset;
    uint32_t within = scope;
    switch (dwarf_tag(&child)) {
    case DW_TAG_subprogram:
    case DW_TAG_inlined_subroutine:
      within = add_scope(scopes, &child, scope);
      break;
    case DW_TAG_lexical_block:
    case DW_TAG_namespace:
    case DW_TAG_structure_type:
    case DW_TAG_class_type:
      break;
    default:
      within = 0;
      break;
    }
    if (within)
      add_scopes(scopes, &child, within, depth + 1);
  } while (dwarf_siblingof(&child, &child) == 0);
}

static void add_unit(struct trax_scopes *scopes, Dwarf_Die *unit) {
  Dwarf_Attribute attribute;
  const char *folder = dwarf_formstring(dwarf_attr(unit, DW_AT_comp_dir, &attribute));
  if (folder &&
      trax_grow((void **)&scopes->folders, scopes->folder_count, &scopes->folder_capacity, sizeof *scopes->folders))
    scopes->folders[scopes->folder_count++] = folder;
  const uint32_t scope = add_scope(scopes, unit, 0);
  scopes->last = dwarf_dieoffset(unit);
  if (scope)
    add_scopes(scopes, unit, scope, 0);
}

static int by_begin(const void *a, const void *b) {
  const struct trax_scope_range *one = a, *other = b;
  if (one->parent != other->parent)
    return one->parent < other->parent ? -1 : 1;
  if (one->begin != other->begin)
    return one->begin < other->begin ? -1 : 1;
  return (one->scope > other->scope) - (one->scope < other->scope);
}

/* Reads the scopes of all units once: .debug_aranges is optional, and compilers omit it. */
static struct trax_scopes *read_scopes(const trax_image *image) {
  struct trax_scopes *scopes = calloc(1, sizeof *scopes);
  Dwarf_CU *unit = NULL;
  Dwarf_Die entry;
  if (!scopes || !trax_grow((void **)&scopes->scopes, 0, &scopes->capacity, sizeof *scopes->scopes)) {
    free(scopes);
    return NULL;
  }
  scopes->most_ranges = image->size < UINT32_MAX ? image->size : UINT32_MAX;
  scopes->scopes[scopes->count++] = (struct trax_scope){.parent = 0};
  while (dwarf_get_units(image->dwarf, unit, &unit, NULL, NULL, &entry, NULL) == 0)
    add_unit(scopes, &entry);
  if (scopes->range_count)
    qsort(scopes->ranges, scopes->range_count, sizeof *scopes->ranges, by_begin);
  for (uint32_t i = 0; i < scopes->range_count; i++) {
    struct trax_scope *parent = &scopes->scopes[scopes->ranges[i].parent];
    parent->first = parent->count++ ? parent->first : i;
  }
  return scopes;
}

/* Returns the scope in `parent` that contains pc; 0: none. */
static uint32_t scope_within(const struct trax_scopes *scopes, uint32_t parent, uint32_t pc) {
  const struct trax_scope_range *ranges = scopes->ranges + scopes->scopes[parent].first;
  uint32_t low = 0, high = scopes->scopes[parent].count;
  while (low < high) { /* the first range that begins behind pc */
    const uint32_t middle = low + (high - low) / 2;
    if (ranges[middle].begin <= pc)
      low = middle + 1;
    else
      high = middle;
  }
  return low && pc <= ranges[low - 1].last ? ranges[low - 1].scope : 0;
}

Dwarf *trax_image_dwarf(trax_image *image) {
  if (!image->dwarf_tried) {
    image->dwarf_tried = true;
    image->dwarf = dwarf_begin_elf(image->elf, DWARF_C_READ, NULL);
  }
  return image->dwarf;
}

static const struct trax_scopes *scopes_of(trax_image *image) {
  if (!image->scopes && trax_image_dwarf(image))
    image->scopes = read_scopes(image);
  return image->scopes;
}

/* --- lines --- */

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

size_t trax_image_lines(trax_image *image, uint32_t pc, struct trax_source_line *lines, size_t capacity) {
  const struct trax_scopes *scopes = scopes_of(image);
  const uint32_t unit_scope = scopes ? scope_within(scopes, 0, pc) : 0;
  if (!unit_scope || capacity == 0)
    return 0;
  Dwarf_Die *unit = &scopes->scopes[unit_scope].entry;
  Dwarf_Line *row = dwarf_getsrc_die(unit, pc);
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

  uint32_t scope = unit_scope;
  for (uint32_t within; (within = scope_within(scopes, scope, pc));)
    scope = within;
  for (; scope != unit_scope; scope = scopes->scopes[scope].parent) {
    Dwarf_Die *function = &scopes->scopes[scope].entry;
    lines[count - 1].function = name_of(function);
    lines[count - 1].linkage = linkage_of(function);
    lines[count - 1].function_line = number_of(function, DW_AT_decl_line);
    if (dwarf_tag(function) == DW_TAG_subprogram || count == capacity)
      break;
    const char *caller = file_of(unit, number_of(function, DW_AT_call_file));
    if (!caller)
      break;
    lines[count++] = (struct trax_source_line){.file = caller,
                                               .line = number_of(function, DW_AT_call_line),
                                               .column = number_of(function, DW_AT_call_column),
                                               .discriminator = number_of(function, GNU_DISCRIMINATOR)};
  }
  return count;
}

bool trax_image_function(trax_image *image, uint32_t pc, Dwarf_Die *function) {
  const struct trax_scopes *scopes = scopes_of(image);
  for (uint32_t scope = 0; scopes && (scope = scope_within(scopes, scope, pc));)
    if (dwarf_tag(&scopes->scopes[scope].entry) == DW_TAG_subprogram) {
      *function = scopes->scopes[scope].entry;
      return true;
    }
  return false;
}

size_t trax_image_folders(trax_image *image, const char *const **folders) {
  const struct trax_scopes *scopes = scopes_of(image);
  *folders = scopes ? scopes->folders : NULL;
  return scopes ? scopes->folder_count : 0;
}

void trax_image_forget_lines(trax_image *image) {
  if (image->scopes) {
    free(image->scopes->scopes);
    free(image->scopes->ranges);
    free(image->scopes->folders);
  }
  free(image->scopes);
  image->scopes = NULL;
  dwarf_end(image->dwarf);
  image->dwarf = NULL;
}
