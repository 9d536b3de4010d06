/* The size of a program for the TPs. */
#include "render.h"

#include <fcntl.h>
#include <gelf.h>
#include <stdlib.h>
#include <string.h>
#include <trax/isa.h>
#include <unistd.h>

enum { MOST_FUNCTIONS = 4096 };

struct function {
  uint32_t address, frame; /* bytes */
  uint32_t depth;          /* with what it calls */
  enum { UNSEEN, UNDER_WAY, SEEN } state;
};

/* The parts of a program that are read. */
struct contents {
  struct function *functions; /* by address */
  size_t count;
  const Elf_Data *code;
  uint32_t code_address;
};

static int by_address(const void *a, const void *b) {
  const struct function *f = a, *g = b;
  return f->address < g->address ? -1 : f->address > g->address;
}

/* Records of an address and a frame's size in LEB128, as -fstack-size-section has them. False if they are cut off. */
static bool read_frames(const Elf_Data *data, struct contents *contents) {
  const uint8_t *at = data->d_buf, *end = at + data->d_size;
  while (at < end) {
    if (end - at < 5 || contents->count == MOST_FUNCTIONS)
      return false;
    struct function *function = &contents->functions[contents->count++];
    *function = (struct function){0};
    memcpy(&function->address, at, sizeof function->address);
    at += 4;
    for (unsigned shift = 0;; shift += 7) {
      if (at == end || shift > 28)
        return false;
      function->frame |= (uint32_t)(*at & 0x7F) << shift;
      if (!(*at++ & 0x80))
        break;
    }
  }
  qsort(contents->functions, contents->count, sizeof *contents->functions, by_address);
  return true;
}

/* The stack of a function and its callees. Recursion counts once and indirect calls not at all; the device program has
   neither. */
static uint32_t stack_depth(const struct contents *contents, struct function *function) {
  if (function->state != UNSEEN)
    return function->depth;
  function->state = UNDER_WAY;
  const struct function *next = function + 1;
  const uint32_t code_end = contents->code_address + (uint32_t)contents->code->d_size;
  const uint32_t end = next < contents->functions + contents->count ? next->address : code_end;
  uint32_t depth = function->frame;
  for (uint32_t pc = function->address; pc + 4 <= end && pc >= contents->code_address && pc + 4 <= code_end; pc += 4) {
    uint32_t word;
    memcpy(&word, (const char *)contents->code->d_buf + (pc - contents->code_address), sizeof word);
    const trax_inst inst = trax_decode(word);
    if (inst.op != TRAX_OP_JAL)
      continue;
    const struct function key = {.address = pc + (uint32_t)inst.imm};
    struct function *callee =
        bsearch(&key, contents->functions, contents->count, sizeof *contents->functions, by_address);
    if (!callee || callee == function)
      continue;
    const uint32_t total = (inst.rd ? function->frame : 0) + stack_depth(contents, callee);
    depth = total > depth ? total : depth;
  }
  function->depth = depth;
  function->state = SEEN;
  return depth;
}

trax_status trax_program_measure(struct trax_program_size *size, const char *path, trax_error *error) {
  *size = (struct trax_program_size){0};
  struct contents contents = {.functions = malloc(MOST_FUNCTIONS * sizeof *contents.functions)};
  if (!contents.functions)
    return trax_fail(error, "out of memory");
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
  elf_version(EV_CURRENT);
  Elf *elf = descriptor < 0 ? NULL : elf_begin(descriptor, ELF_C_READ, NULL);
  size_t names;
  bool good = elf && elf_getshdrstrndx(elf, &names) == 0;
  for (Elf_Scn *section = NULL; good && (section = elf_nextscn(elf, section));) {
    GElf_Shdr header;
    good = gelf_getshdr(section, &header) != NULL;
    const char *name = good ? elf_strptr(elf, names, header.sh_name) : NULL;
    if (good && header.sh_type == SHT_PROGBITS && header.sh_flags & SHF_EXECINSTR) {
      size->code_bytes += (uint32_t)header.sh_size;
      contents.code = elf_getdata(section, NULL);
      contents.code_address = (uint32_t)header.sh_addr;
    } else if (name && strcmp(name, ".stack_sizes") == 0) {
      const Elf_Data *data = elf_getdata(section, NULL);
      good = data && read_frames(data, &contents);
    }
  }
  for (size_t i = 0; good && contents.code && i < contents.count; i++) {
    const uint32_t depth = stack_depth(&contents, &contents.functions[i]);
    size->stack_bytes = depth > size->stack_bytes ? depth : size->stack_bytes;
  }
  elf_end(elf);
  free(contents.functions);
  if (descriptor >= 0)
    close(descriptor);
  return good ? TRAX_OK : trax_fail(error, "%s: not a readable program", path);
}
