/* How large a program for the TPs is. */
#include "core/machine.h"
#include "render.h"

#include <fcntl.h>
#include <gelf.h>
#include <string.h>
#include <unistd.h>

/* Records of an address and a frame's size in LEB128, as -fstack-size-section has them. False if they are cut off. */
static bool add_frames(const Elf_Data *data, uint32_t *bytes) {
  const uint8_t *at = data->d_buf, *end = at + data->d_size;
  while (at < end) {
    if (end - at < 5)
      return false;
    at += 4;
    uint32_t size = 0;
    for (unsigned shift = 0;; shift += 7) {
      if (at == end || shift > 28)
        return false;
      size |= (uint32_t)(*at & 0x7F) << shift;
      if (!(*at++ & 0x80))
        break;
    }
    *bytes += size;
  }
  return true;
}

trax_status trax_program_measure(struct trax_program_size *size, const char *path, trax_error *error) {
  *size = (struct trax_program_size){0};
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
  elf_version(EV_CURRENT);
  Elf *elf = descriptor < 0 ? NULL : elf_begin(descriptor, ELF_C_READ, NULL);
  size_t names;
  bool good = elf && elf_getshdrstrndx(elf, &names) == 0;
  for (Elf_Scn *section = NULL; good && (section = elf_nextscn(elf, section));) {
    GElf_Shdr header;
    good = gelf_getshdr(section, &header) != NULL;
    const char *name = good ? elf_strptr(elf, names, header.sh_name) : NULL;
    if (good && header.sh_type == SHT_PROGBITS && header.sh_flags & SHF_EXECINSTR)
      size->code_bytes += (uint32_t)header.sh_size;
    else if (name && strcmp(name, ".stack_sizes") == 0) {
      const Elf_Data *data = elf_getdata(section, NULL);
      good = data && add_frames(data, &size->stack_bytes);
    }
  }
  elf_end(elf);
  if (descriptor >= 0)
    close(descriptor);
  return good ? TRAX_OK : trax_fail(error, "%s: not a readable program", path);
}
