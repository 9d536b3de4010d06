/* extract-templates OBJECT: writes the templates of an object file (templates.c) as tables in C (template.h). It
   refuses everything that it does not understand. So the build fails if a compiler writes other code. */
#define _GNU_SOURCE /* open_memstream */
#include "translate/template.h"

#include <fcntl.h>
#include <gelf.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The beginnings of the sections' names: of templates, and of those of bursts. */
static const char *const prefix[] = {".text.trax_template_", ".text.trax_burst_"}, *const cold_prefix[] = {
                                                                                       ".text.cold_trax_template_",
                                                                                       ".text.cold_trax_burst_"};

static _Noreturn void fail(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  fputs("extract-templates: error: ", stderr);
  vfprintf(stderr, format, arguments);
  fputs("\nThe emulator can be built without translation: cmake -DTRAX_TRANSLATE=OFF\n", stderr);
  exit(1);
}

static const struct {
  const char *symbol;
  enum trax_hole_kind kind;
  bool is_absolute;
} known[] = {{"trax_goes_on", TRAX_HOLE_GOES_ON, false},
             {"trax_goes_on_int", TRAX_HOLE_GOES_ON, false},
             {"trax_goes_on_float", TRAX_HOLE_GOES_ON, false},
             {"trax_jumps", TRAX_HOLE_JUMPS, false},
             {"trax_links_int", TRAX_HOLE_JUMPS, false},
             {"trax_links_float", TRAX_HOLE_JUMPS, false},
             {"trax_jumps_to_int", TRAX_HOLE_JUMPS, false},
             {"trax_jumps_to_float", TRAX_HOLE_JUMPS, false},
             {"trax_is_slow", TRAX_HOLE_SLOW, false},
             {"trax_imm", TRAX_HOLE_IMM, true},
             {"trax_pc", TRAX_HOLE_PC, true},
             {"trax_precision", TRAX_HOLE_PRECISION, true},
             {"trax_minus_input", TRAX_HOLE_MINUS_INPUT, true},
             {"trax_input_bytes", TRAX_HOLE_INPUT_BYTES, true},
             {"trax_step_at", TRAX_HOLE_STEP_AT, true},
             {"trax_step", TRAX_HOLE_STEP, true},
             {"trax_bank_mask", TRAX_HOLE_BANK_MASK, true},
             {"trax_local_step", TRAX_HOLE_LOCAL_STEP, true}};

struct object {
  Elf *elf;
  size_t names, sections;
  Elf_Data *symbols;
  size_t symbol_names, symbol_count;
  size_t *pool_at; /* [section]: where its constants are in the pool, if is_pool */
  bool *is_pool;   /* [section] */
};

static Elf_Data *data_of(const struct object *object, size_t section, GElf_Shdr *header) {
  Elf_Scn *scn = elf_getscn(object->elf, section);
  if (!scn || !gelf_getshdr(scn, header))
    fail("%s", elf_errmsg(-1));
  return elf_getdata(scn, NULL);
}

/* Returns the rest of a section's name after the prefix; NULL: the section is no code, or has another name. */
static const char *name_behind(const struct object *object, size_t section, const char *prefix_text) {
  GElf_Shdr header;
  data_of(object, section, &header);
  const char *const name = elf_strptr(object->elf, object->names, header.sh_name);
  const size_t length = strlen(prefix_text);
  return name && header.sh_type == SHT_PROGBITS && header.sh_size && strncmp(name, prefix_text, length) == 0
             ? name + length
             : NULL;
}

/* Writes the constants of all sections that have some. */
static void write_pool(struct object *object) {
  size_t bytes = 0;
  printf("_Alignas(64) const uint8_t trax_template_pool[] = {");
  for (size_t i = 1; i < object->sections; i++) {
    GElf_Shdr header;
    const Elf_Data *data = data_of(object, i, &header);
    if (header.sh_type != SHT_PROGBITS || !(header.sh_flags & SHF_ALLOC) || (header.sh_flags & SHF_EXECINSTR) ||
        !header.sh_size)
      continue;
    if (header.sh_flags & SHF_WRITE)
      fail("a template has data");
    for (; bytes % header.sh_addralign; bytes++)
      printf("0,");
    object->pool_at[i] = bytes;
    object->is_pool[i] = true;
    for (size_t n = 0; n < header.sh_size; n++, bytes++)
      printf("%u,", ((const uint8_t *)data->d_buf)[n]);
  }
  printf("0};\nconst unsigned trax_template_pool_bytes = %zu;\n", bytes);
}

static struct trax_template_hole read_hole(const struct object *object, const GElf_Rela *rela) {
  GElf_Sym symbol;
  struct trax_template_hole hole = {(uint16_t)rela->r_offset, TRAX_HOLE_POOL, (int32_t)rela->r_addend};
  const unsigned type = (unsigned)GELF_R_TYPE(rela->r_info);
  const bool is_absolute = type == R_X86_64_32 || type == R_X86_64_32S;
  if (!gelf_getsym(object->symbols, (int)GELF_R_SYM(rela->r_info), &symbol))
    fail("%s", elf_errmsg(-1));
  if (!is_absolute && type != R_X86_64_PC32 && type != R_X86_64_PLT32)
    fail("unknown relocation %u", type);
  if (symbol.st_shndx != SHN_UNDEF) {
    if (is_absolute || symbol.st_shndx >= object->sections)
      fail("a relocation to a place in the object");
    hole.kind = TRAX_HOLE_POOL;
    for (unsigned i = 0; i < 2; i++)
      hole.kind = name_behind(object, symbol.st_shndx, cold_prefix[i]) ? TRAX_HOLE_COLD
                  : name_behind(object, symbol.st_shndx, prefix[i])    ? TRAX_HOLE_HOT
                                                                       : hole.kind;
    if (hole.kind == TRAX_HOLE_POOL && !object->is_pool[symbol.st_shndx])
      fail("a call or jump to another function");
    hole.addend += (int32_t)(object->pool_at[symbol.st_shndx] + symbol.st_value);
    return hole;
  }
  const char *const name = elf_strptr(object->elf, object->symbol_names, symbol.st_name);
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (name && strcmp(name, known[i].symbol) == 0 && known[i].is_absolute == is_absolute) {
      hole.kind = known[i].kind;
      return hole;
    }
  fail("a relocation to %s", name);
}

static size_t relocations_of(const struct object *object, size_t section) {
  for (size_t i = 1; i < object->sections; i++) {
    GElf_Shdr header;
    data_of(object, i, &header);
    if (header.sh_type == SHT_RELA && header.sh_info == section)
      return i;
  }
  return 0;
}

struct totals {
  size_t bytes, holes[TRAX_HOLES];
};

/* Writes the arrays of a section's code, and its part of the template to `row`. */
static void write_part(const struct object *object, bool is_hot, size_t section, struct totals *totals, FILE *row) {
  GElf_Shdr header, rela_header;
  const Elf_Data *data = data_of(object, section, &header);
  const size_t relocations = relocations_of(object, section);
  size_t bytes = header.sh_size, count = 0;
  bool is_lea = false;
  uint8_t *code = malloc(bytes);
  if (!code || bytes > UINT16_MAX)
    fail("a template of %zu bytes", bytes);
  memcpy(code, data->d_buf, bytes);
  Elf_Data *const relas = relocations ? data_of(object, relocations, &rela_header) : NULL;
  if (is_hot && relas && bytes > 8 && code[0] == 0xB8 && code[5] == 0x01 && code[6] == 0xC8 &&
      (code[7] == 0xA8 || code[7] == 0x89)) {
    /* mov eax, imm; add eax, ecx; test or mov: the first two are ds lea eax, [rcx + imm] */
    memcpy(code, "\x3E\x8D\x81", 3);
    is_lea = true;
  }
  printf("static const struct trax_template_hole holes_%zu[] = {", section);
  for (size_t i = relas ? rela_header.sh_size / rela_header.sh_entsize : 0; i-- > 0;) {
    GElf_Rela rela;
    gelf_getrela(relas, (int)i, &rela);
    struct trax_template_hole hole = read_hole(object, &rela);
    if (is_lea && hole.offset == 1)
      hole.offset = 3;
    totals->holes[hole.kind]++;
    if (is_hot && hole.offset + 4u == bytes && code[bytes - 5] == 0xE9) {
      /* The jump at the end: none if it goes on; and a comparison's jump around it becomes its condition. */
      if (hole.kind == TRAX_HOLE_GOES_ON) {
        bytes -= 5;
        continue;
      }
      if (bytes == 9 && (code[2] & 0xF0) == 0x70 && code[3] == 5) {
        code[3] = (uint8_t)(0x80 | ((code[2] & 0xF) ^ 1));
        code[2] = 0x0F;
        hole.offset = 4;
        bytes = 8;
      }
    }
    printf("{%u, %u, %d},", hole.offset, hole.kind, hole.addend);
    count++;
  }
  printf("{0}};\nstatic const uint8_t code_%zu[] = {", section);
  for (size_t i = 0; i < bytes; i++)
    printf("%u,", code[i]);
  printf("0};\n");
  fprintf(row, "{code_%zu, holes_%zu, %zu, %zu}, ", section, section, bytes, count);
  totals->bytes += bytes;
  free(code);
}

/* Writes the row of a template: NAME_A_B_D, each of the last three int or float. */
static void write_template(const struct object *object, unsigned kind, const char *name, size_t section, FILE *row) {
  unsigned variant = 0;
  size_t length = strlen(name), cold = 0;
  for (unsigned bit = TRAX_FLOAT_D; bit; bit >>= 1) {
    const bool is_float = name[length - 2] == 'a';
    variant |= is_float ? bit : 0;
    length -= is_float ? strlen("_float") : strlen("_int");
  }
  for (size_t i = 1; i < object->sections; i++)
    if (name_behind(object, i, cold_prefix[kind]) && strcmp(name_behind(object, i, cold_prefix[kind]), name) == 0)
      cold = i;
  fprintf(row, "  [TRAX_OP_%.*s][%u] = {", (int)length, name, variant);
  struct totals totals = {0};
  write_part(object, true, section, &totals, row);
  if (cold)
    write_part(object, false, cold, &totals, row);
  else
    fprintf(row, "{NULL, NULL, 0, 0}, ");
  const size_t *const holes = totals.holes, stubs = holes[TRAX_HOLE_JUMPS] + holes[TRAX_HOLE_SLOW] + (cold != 0);
  if (totals.bytes > TRAX_MOST_BYTES || stubs > TRAX_MOST_STUBS)
    fail("%s has %zu bytes and %zu exits", name, totals.bytes, stubs);
  if (holes[TRAX_HOLE_JUMPS] && !holes[TRAX_HOLE_GOES_ON] && stubs > 1)
    fail("%s always jumps, but not only at its end", name);
  fprintf(row, "%d},\n", holes[TRAX_HOLE_GOES_ON] != 0);
}

static void open_object(struct object *object, const char *path) {
  const int file = open(path, O_RDONLY);
  elf_version(EV_CURRENT);
  object->elf = file < 0 ? NULL : elf_begin(file, ELF_C_READ, NULL);
  if (!object->elf || elf_getshdrstrndx(object->elf, &object->names) || elf_getshdrnum(object->elf, &object->sections))
    fail("cannot read %s", path);
  object->pool_at = calloc(object->sections, sizeof *object->pool_at);
  object->is_pool = calloc(object->sections, sizeof *object->is_pool);
  for (size_t i = 1; i < object->sections; i++) {
    GElf_Shdr header;
    Elf_Data *data = data_of(object, i, &header);
    if (header.sh_type == SHT_SYMTAB) {
      object->symbols = data;
      object->symbol_names = header.sh_link;
    }
  }
  if (!object->symbols || !object->pool_at || !object->is_pool)
    fail("%s has no symbols", path);
}

/* Writes the table of the templates of a kind. */
static void write_table(const struct object *object, unsigned kind, const char *table) {
  char *rows = NULL;
  size_t bytes = 0;
  FILE *const row = open_memstream(&rows, &bytes);
  for (size_t i = 1; i < object->sections && row; i++) {
    const char *const name = name_behind(object, i, prefix[kind]);
    GElf_Shdr header;
    if (name && (data_of(object, i, &header), kind == 0 || header.sh_size > 5)) /* 5: a jump alone, to trax_is_slow */
      write_template(object, kind, name, i, row);
  }
  if (!row || fclose(row) != 0)
    fail("out of memory");
  printf("\nconst struct trax_template %s[TRAX_OP_COUNT + 1][TRAX_VARIANTS] = {\n%s};\n", table, rows);
  free(rows);
}

int main(int argc, char **argv) {
  struct object object = {0};
  if (argc != 2)
    fail("usage: extract-templates OBJECT");
  open_object(&object, argv[1]);
  printf("/* Made by extract-templates from templates.c. */\n#include \"translate/template.h\"\n\n");
  write_pool(&object);
  write_table(&object, 0, "trax_templates");
  write_table(&object, 1, "trax_burst_templates");
  free(object.pool_at);
  free(object.is_pool);
  elf_end(object.elf);
  return fflush(stdout) || ferror(stdout);
}
