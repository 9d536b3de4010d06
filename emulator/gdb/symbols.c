/* Writes a copy of an executable for a debugger that does not know the machine. */
#include "gdb/dwarf_registers.h"
#include "gdb/gdb.h"
#include "gdb/registers.h"
#include "program/image.h"
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
};

static trax_status fail(const struct copy *copy, const char *what, trax_error *error) {
  return trax_fail(error, "%s: %s: its registers cannot be renumbered", copy->path, what);
}

/* --- expressions in .debug_info --- */

static int renumber_attribute(Dwarf_Attribute *attribute, void *context) {
  const struct copy *copy = context;
  Dwarf_Block block;
  if (dwarf_whatform(attribute) != DW_FORM_exprloc)
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

/* Renumbers an entry and its children. In damaged information, offsets that do not increase could form a cycle. */
static bool renumber_entry(Dwarf_Die *entry, struct copy *copy, unsigned depth) {
  Dwarf_Die child;
  if (depth == MAX_DEPTH || dwarf_getattrs(entry, renumber_attribute, copy, 0) != 1)
    return false;
  Dwarf_Off last = dwarf_dieoffset(entry);
  int more = dwarf_child(entry, &child);
  for (; more == 0; more = dwarf_siblingof(&child, &child)) {
    const Dwarf_Off offset = dwarf_dieoffset(&child);
    if (offset <= last || !renumber_entry(&child, copy, depth + 1))
      return false;
    last = offset;
  }
  return more == 1;
}

static bool renumber_units(Elf *elf, struct copy *copy) {
  Dwarf *dwarf = dwarf_begin_elf(elf, DWARF_C_READ, NULL);
  if (!dwarf)
    return true; /* no debug information */
  Dwarf_CU *unit = NULL;
  Dwarf_Die root;
  bool good = true;
  int more;
  while (good && (more = dwarf_get_units(dwarf, unit, &unit, NULL, NULL, &root, NULL)) == 0)
    good = renumber_entry(&root, copy, 0);
  dwarf_end(dwarf);
  return good && more == 1;
}

/* --- other sections --- */

static trax_status renumber_sections(Elf *elf, struct copy *copy, trax_error *error) {
  static const struct {
    const char *name;
    bool (*renumber)(uint8_t *bytes, size_t size, trax_register_map map);
  } kinds[] = {{".debug_frame", trax_dwarf_renumber_frames},
               {".debug_loc", trax_dwarf_renumber_locations},
               {".debug_loclists", trax_dwarf_renumber_lists}};
  size_t names;
  if (elf_getshdrstrndx(elf, &names) != 0)
    return TRAX_OK;
  for (Elf_Scn *section = NULL; (section = elf_nextscn(elf, section));) {
    const Elf32_Shdr *header = elf32_getshdr(section);
    const char *name = header ? elf_strptr(elf, names, header->sh_name) : NULL;
    for (size_t i = 0; name && header->sh_type != SHT_NOBITS && i < sizeof kinds / sizeof *kinds; i++)
      if (strcmp(name, kinds[i].name) == 0 &&
          !kinds[i].renumber(copy->bytes + header->sh_offset, header->sh_size, copy->map))
        return fail(copy, name, error);
  }
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
  trax_status status = TRAX_OK;
  if (!renumber_units(elf, copy)) /* precedes the change of location lists, which libdw may read */
    status = fail(copy, ".debug_info", error);
  if (status == TRAX_OK)
    status = renumber_sections(elf, copy, error);
  elf_end(elf);
  return status;
}

trax_status trax_gdb_write_symbols(const char *executable, const char *path, trax_error *error) {
  struct copy copy = {.path = executable};
  trax_image *image = trax_image_open(executable, error); /* checks the headers */
  if (!image)
    return TRAX_ERROR;
  trax_image_close(image);
  if (trax_image_read(executable, &copy.bytes, &copy.size, error) != TRAX_OK)
    return TRAX_ERROR;
  trax_output output;
  trax_status status = renumber(&copy, error);
  if (status == TRAX_OK)
    status = trax_output_open(&output, path, error);
  if (status == TRAX_OK) {
    const uint16_t machine = EM_RISCV;
    memcpy(copy.bytes + offsetof(Elf32_Ehdr, e_machine), &machine, sizeof machine);
    fwrite(copy.bytes, 1, copy.size, output.file); /* trax_output_commit reports a failure */
    status = trax_output_commit(&output, error);
  }
  free(copy.bytes);
  return status;
}
