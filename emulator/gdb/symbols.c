/* Writes a copy of an executable for a debugger that does not know the machine. */
#include "gdb/dwarf_registers.h"
#include "gdb/gdb.h"
#include "gdb/registers.h"
#include "program/program.h"
#include "trax/output.h"

#include <dwarf.h>
#include <elfutils/libdw.h>
#include <stdlib.h>
#include <string.h>

struct copy {
  const char *path;
  uint8_t *bytes;
  size_t size;
  uint8_t map[TRAX_NUM_REGISTERS]; /* to the debugger's numbers */
  bool has_units;
};

static trax_status fail(const struct copy *copy, const char *what, trax_error *error) {
  return trax_fail(error, "%s: %s: its registers cannot be renumbered", copy->path, what);
}

/* --- expressions in .debug_info --- */

/* The context of renumber_attribute. */
struct entry {
  const struct copy *copy;
  Dwarf_Half version; /* of the unit */
};

/* Whether a value is an expression. Before DWARF 4 these were blocks, as some constants and lists still are. */
static bool is_expression(Dwarf_Attribute *attribute, Dwarf_Half version) {
  const unsigned name = dwarf_whatattr(attribute);
  switch (dwarf_whatform(attribute)) {
  case DW_FORM_exprloc:
    return true;
  case DW_FORM_block:
  case DW_FORM_block1:
  case DW_FORM_block2:
  case DW_FORM_block4:
    return version < 4 && name != DW_AT_const_value && name != DW_AT_discr_list;
  default:
    return false;
  }
}

static int renumber_attribute(Dwarf_Attribute *attribute, void *context) {
  const struct entry *entry = context;
  const struct copy *copy = entry->copy;
  Dwarf_Block block;
  if (!is_expression(attribute, entry->version))
    return DWARF_CB_OK;
  if (dwarf_formblock(attribute, &block) != 0)
    return DWARF_CB_ABORT;
  const ptrdiff_t offset = block.data - copy->bytes; /* libelf reads in place */
  if (offset < 0 || (size_t)offset > copy->size || block.length > copy->size - (size_t)offset ||
      !trax_dwarf_renumber_expression(block.data, block.length, copy->map))
    return DWARF_CB_ABORT;
  return DWARF_CB_OK;
}

enum { MAX_DEPTH = 256 }; /* of nested entries */

/* Renumbers an entry and its children. Offsets must increase: in damaged information an entry could be visited twice.
 *last is that of the entry before. */
static bool renumber_entry(Dwarf_Die *die, struct entry *entry, Dwarf_Off *last, unsigned depth) {
  Dwarf_Die child;
  if (depth == MAX_DEPTH || (depth && dwarf_dieoffset(die) <= *last))
    return false;
  *last = dwarf_dieoffset(die);
  if (dwarf_getattrs(die, renumber_attribute, entry, 0) != 1)
    return false;
  int more = dwarf_child(die, &child);
  for (; more == 0; more = dwarf_siblingof(&child, &child))
    if (!renumber_entry(&child, entry, last, depth + 1))
      return false;
  return more == 1;
}

/* Whether a unit's entries are in another file, which stays as it is (-gsplit-dwarf). */
static bool is_split(Dwarf_Die *unit, uint8_t type) {
  Dwarf_Attribute attribute;
  return type == DW_UT_skeleton || dwarf_attr(unit, DW_AT_GNU_dwo_name, &attribute);
}

static trax_status renumber_units(Elf *elf, struct copy *copy, trax_error *error) {
  Dwarf *dwarf = dwarf_begin_elf(elf, DWARF_C_READ, NULL);
  if (!dwarf)
    return fail(copy, ".debug_info", error);
  struct entry entry = {.copy = copy};
  Dwarf_CU *unit = NULL;
  Dwarf_Die root;
  Dwarf_Off last = 0;
  uint8_t type;
  bool good = true, split = false;
  int more;
  while (good && (more = dwarf_get_units(dwarf, unit, &unit, &entry.version, &type, &root, NULL)) == 0) {
    split = split || is_split(&root, type);
    good = !split && renumber_entry(&root, &entry, &last, 0);
  }
  dwarf_end(dwarf);
  if (split)
    return trax_fail(error, "%s: its debug information is in other files: compile it without -gsplit-dwarf",
                     copy->path);
  return good && more == 1 ? TRAX_OK : fail(copy, ".debug_info", error);
}

/* --- other sections --- */

static trax_status renumber_section(struct copy *copy, const Elf32_Shdr *header, const char *name, trax_error *error) {
  static const struct {
    const char *name;
    bool (*renumber)(uint8_t *bytes, size_t size, trax_register_map map);
  } kinds[] = {{".debug_frame", trax_dwarf_renumber_frames},
               {".debug_loc", trax_dwarf_renumber_locations},
               {".debug_loclists", trax_dwarf_renumber_lists}};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
    if (strcmp(name, kinds[i].name) == 0 && /* image.c has checked its range */
        !kinds[i].renumber(copy->bytes + header->sh_offset, header->sh_size, copy->map))
      return fail(copy, name, error);
  return TRAX_OK;
}

/* Calls visit for each section of debug information. */
static trax_status visit_sections(Elf *elf, struct copy *copy,
                                  trax_status (*visit)(struct copy *copy, const Elf32_Shdr *header, const char *name,
                                                       trax_error *error),
                                  trax_error *error) {
  size_t names;
  trax_status status = TRAX_OK;
  if (elf_getshdrstrndx(elf, &names) != 0)
    return TRAX_OK;
  for (Elf_Scn *section = NULL; status == TRAX_OK && (section = elf_nextscn(elf, section));) {
    const Elf32_Shdr *header = elf32_getshdr(section);
    const char *name = header ? elf_strptr(elf, names, header->sh_name) : NULL;
    if (name && header->sh_type != SHT_NOBITS &&
        (strncmp(name, ".debug_", 7) == 0 || strncmp(name, ".zdebug_", 8) == 0))
      status = visit(copy, header, name, error);
  }
  return status;
}

/* Notes whether there are units. Packed sections cannot be changed in place. */
static trax_status check_section(struct copy *copy, const Elf32_Shdr *header, const char *name, trax_error *error) {
  if (header->sh_flags & SHF_COMPRESSED || name[1] == 'z')
    return trax_fail(error, "%s: %s is compressed: link it without --compress-debug-sections", copy->path, name);
  copy->has_units |= (strcmp(name, ".debug_info") == 0 || strcmp(name, ".debug_types") == 0) && header->sh_size;
  return TRAX_OK;
}

static trax_status renumber(struct copy *copy, trax_error *error) {
#define ROLE(NUMBER, NAME) NUMBER,
  static const uint8_t roles[] = {TRAX_GDB_ROLES(ROLE)};
  for (unsigned i = 0; i < TRAX_NUM_REGISTERS; i++)
    copy->map[roles[i]] = (uint8_t)i;
  elf_version(EV_CURRENT);
  Elf *elf = elf_memory((char *)copy->bytes, copy->size);
  if (!elf)
    return trax_fail(error, "%s: %s", copy->path, elf_errmsg(-1));
  trax_status status = visit_sections(elf, copy, check_section, error);
  if (status == TRAX_OK && copy->has_units) /* precedes the change of location lists, which libdw may read */
    status = renumber_units(elf, copy, error);
  if (status == TRAX_OK)
    status = visit_sections(elf, copy, renumber_section, error);
  elf_end(elf);
  return status;
}

trax_status trax_gdb_write_symbols(const trax_machine *machine, const char *path, trax_error *error) {
  const struct trax_loaded *loaded = trax_loaded_of(machine);
  struct copy copy = {.path = trax_image_path(loaded->image)};
  const uint8_t *bytes = trax_image_bytes(loaded->image, &copy.size);
  if (!(copy.bytes = malloc(copy.size)))
    return trax_fail(error, "%s: out of memory", copy.path);
  memcpy(copy.bytes, bytes, copy.size);
  trax_output output;
  trax_status status = renumber(&copy, error);
  if (status == TRAX_OK)
    status = trax_output_open(&output, path, error);
  if (status == TRAX_OK) {
    const uint16_t riscv = EM_RISCV;
    memcpy(copy.bytes + offsetof(Elf32_Ehdr, e_machine), &riscv, sizeof riscv);
    fwrite(copy.bytes, 1, copy.size, output.file); /* trax_output_commit reports a failure */
    status = trax_output_commit(&output, error);
  }
  free(copy.bytes);
  return status;
}
