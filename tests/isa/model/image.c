/* Executables (docs/abi.md, "ELF"), read with libelf. */
#include "model.h"

#include <errno.h>
#include <fcntl.h>
#include <gelf.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EM_TRAX = 0x7472 };

/* Symbols that the loader looks up by name; found: the symbol is defined. */
struct symbols {
  struct {
    bool found;
    uint32_t value;
  } begin_signature, end_signature, stack_size, heap, heap_end, stack_top, clock_mhz;
};

static bool read_symbols(Elf *elf, const char *path, struct symbols *symbols, struct model_error *error) {
  Elf_Scn *section = NULL;
  while ((section = elf_nextscn(elf, section))) {
    GElf_Shdr header;
    if (!gelf_getshdr(section, &header))
      return model_fail(error, "%s: %s", path, elf_errmsg(-1));
    Elf_Data *data = header.sh_type == SHT_SYMTAB ? elf_getdata(section, NULL) : NULL;
    if (header.sh_type == SHT_SYMTAB && !data)
      return model_fail(error, "%s: %s", path, elf_errmsg(-1));
    GElf_Sym symbol;
    for (int i = 1; data && gelf_getsym(data, i, &symbol); i++) {
      const char *name = elf_strptr(elf, header.sh_link, symbol.st_name);
      if (!name || symbol.st_shndx == SHN_UNDEF || GELF_ST_BIND(symbol.st_info) == STB_LOCAL)
        continue;
#define NAMED(TEXT, MEMBER)                                                                                            \
  if (strcmp(name, TEXT) == 0) {                                                                                       \
    symbols->MEMBER.found = true;                                                                                      \
    symbols->MEMBER.value = (uint32_t)symbol.st_value;                                                                 \
  }
      NAMED("begin_signature", begin_signature)
      NAMED("end_signature", end_signature)
      NAMED("__trax_stack_size", stack_size)
      NAMED("__trax_heap", heap)
      NAMED("__trax_heap_end", heap_end)
      NAMED("__trax_stack_top", stack_top)
      NAMED("__trax_clock_mhz", clock_mhz)
#undef NAMED
    }
  }
  return true;
}

static bool map_segments(struct model_machine *machine, Elf *elf, const char *path, uint64_t *end,
                         struct model_error *error) {
  size_t count, file_bytes;
  const char *file = elf_rawfile(elf, &file_bytes);
  if (!file || elf_getphdrnum(elf, &count) != 0)
    return model_fail(error, "%s: %s", path, elf_errmsg(-1));
  for (size_t i = 0; i < count; i++) {
    GElf_Phdr segment;
    struct model_error reason;
    uint8_t *host;
    if (!gelf_getphdr(elf, (int)i, &segment))
      return model_fail(error, "%s: %s", path, elf_errmsg(-1));
    if (segment.p_type != PT_LOAD || segment.p_memsz == 0)
      continue;
    if (segment.p_offset > file_bytes || segment.p_filesz > file_bytes - segment.p_offset ||
        segment.p_filesz > segment.p_memsz)
      return model_fail(error, "%s: segment %zu does not lie within the file", path, i);
    const unsigned permissions = (segment.p_flags & PF_R ? MODEL_READ : 0) |
                                 (segment.p_flags & PF_W ? MODEL_WRITE : 0) |
                                 (segment.p_flags & PF_X ? MODEL_EXECUTE : 0);
    if (!model_map(machine, (uint32_t)segment.p_vaddr, (uint32_t)segment.p_memsz, permissions, &host, &reason))
      return model_fail(error, "%s: %s", path, reason.message);
    memcpy(host, file + segment.p_offset, segment.p_filesz);
    if (segment.p_vaddr + segment.p_memsz > *end)
      *end = segment.p_vaddr + segment.p_memsz;
  }
  return *end ? true : model_fail(error, "%s: nothing to load", path);
}

static bool store_word(struct model_machine *machine, const char *path, const char *name, bool found, uint32_t address,
                       uint64_t value, struct model_error *error) {
  if (!found)
    return true;
  if (model_check(machine, address, 4, MODEL_INCREMENT))
    return model_fail(error, "%s: %s, 0x%08x, is no writable word", path, name, address);
  for (unsigned i = 0; i < 4; i++)
    machine->memory[address + i] = (uint8_t)(value >> 8 * i);
  return true;
}

/* Stacks in global memory, and the words that say where heap and stacks are, and what the clock is (docs/abi.md,
 * "Buffers"). */
static bool place_stacks(struct model_machine *machine, const char *path, const struct symbols *symbols, uint64_t end,
                         struct model_error *error) {
  const uint64_t heap = (end + 63) / 64 * 64;
  const uint32_t stack_bytes = symbols->stack_size.found ? symbols->stack_size.value : 0;
  const uint64_t stacks = stack_bytes ? (uint64_t)machine->thread_count * (stack_bytes + UINT64_C(2048)) : 0;
  if (stack_bytes % 64 || stacks > machine->size || machine->size - stacks < heap)
    return model_fail(error, "%s: stacks of %u bytes for %u threads do not fit into memory", path, stack_bytes,
                      machine->thread_count);
  const bool good =
      store_word(machine, path, "__trax_heap", symbols->heap.found, symbols->heap.value, heap, error) &&
      store_word(machine, path, "__trax_heap_end", symbols->heap_end.found, symbols->heap_end.value,
                 machine->size - stacks, error) &&
      store_word(machine, path, "__trax_stack_top", symbols->stack_top.found, symbols->stack_top.value, machine->size,
                 error) &&
      store_word(machine, path, "__trax_clock_mhz", symbols->clock_mhz.found, symbols->clock_mhz.value, 500, error);
  machine->stack_bytes = stack_bytes;
  return good;
}

static bool load(struct model_machine *machine, Elf *elf, const char *path, struct model_image *image,
                 struct model_error *error) {
  GElf_Ehdr header;
  uint64_t end = 0;
  struct symbols symbols = {0};
  if (elf_kind(elf) != ELF_K_ELF || !gelf_getehdr(elf, &header))
    return model_fail(error, "%s: not an ELF file", path);
  if (header.e_ident[EI_CLASS] != ELFCLASS32 || header.e_ident[EI_DATA] != ELFDATA2LSB || header.e_type != ET_EXEC ||
      header.e_machine != EM_TRAX || header.e_flags > 2)
    return model_fail(error, "%s: not an executable for the machine (ELF32, little endian, machine 0x%x, flags 0 to 2)",
                      path, EM_TRAX);
  if (!map_segments(machine, elf, path, &end, error) || !read_symbols(elf, path, &symbols, error) ||
      !place_stacks(machine, path, &symbols, end, error))
    return false;
  model_set_entry(machine, (uint32_t)header.e_entry);
  *image = (struct model_image){0};
  if (!symbols.begin_signature.found && !symbols.end_signature.found)
    return true;
  image->begin_signature = symbols.begin_signature.value;
  image->end_signature = symbols.end_signature.value;
  if (!symbols.begin_signature.found || !symbols.end_signature.found || image->begin_signature % 4 ||
      image->end_signature % 4 || image->begin_signature < MODEL_NULL_END ||
      image->begin_signature > image->end_signature || image->end_signature > machine->size)
    return model_fail(error, "%s: begin_signature and end_signature do not enclose words of global memory", path);
  return true;
}

bool model_load_image(struct model_machine *machine, const char *path, struct model_image *image,
                      struct model_error *error) {
  bool good = false;
  elf_version(EV_CURRENT);
  const int file = open(path, O_RDONLY);
  if (file < 0)
    return model_fail(error, "%s: cannot be read: %s", path, strerror(errno));
  Elf *elf = elf_begin(file, ELF_C_READ, NULL);
  if (elf)
    good = load(machine, elf, path, image, error);
  else
    model_fail(error, "%s: %s", path, elf_errmsg(-1));
  elf_end(elf);
  close(file);
  return good;
}
