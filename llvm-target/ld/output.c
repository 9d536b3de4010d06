/* The executable: file header, program headers, contents, symbol table, section headers, in this order. */
#include "ld.h"

#include <string.h>

typedef struct string_table {
  char *bytes;
  size_t size, capacity;
  ld_map offsets; /* name -> offset + 1 */
} string_table;

typedef struct symbol_table {
  LD_VECTOR(Elf32_Sym) entries;
  size_t local_count; /* the null symbol among them */
  string_table names;
} symbol_table;

/* --- string tables --- */

static uint32_t add_string(ld_context *ctx, string_table *table, const char *text) {
  size_t length = strlen(text);
  uintptr_t *known = ld_map_at(ctx, &table->offsets, text, length);
  if (!*known) {
    while (table->size + length + 1 > table->capacity)
      table->bytes = ld_grow(ctx, table->bytes, table->size, &table->capacity, 1);
    memcpy(table->bytes + table->size, text, length + 1);
    *known = table->size + 1;
    table->size += length + 1;
  }
  return (uint32_t)(*known - 1);
}

/* --- symbols --- */

/* Whether the loader reads or fills in what the symbol names (docs/abi.md), so that --strip-all keeps it. */
static bool is_loaders(const ld_symbol *symbol) {
  return ld_starts_with(symbol->name, "__trax_") &&
         (symbol->type != STT_FUNC || strcmp(symbol->name, "__trax_others") == 0);
}

static bool is_wanted(const ld_context *ctx, const ld_symbol *symbol) {
  if (symbol->kind == LD_UNDEFINED || symbol->kind == LD_LAZY || symbol->type == STT_SECTION ||
      ld_symbol_is_dropped(symbol, 0))
    return false;
  if (ctx->options.strip_all && !is_loaders(symbol))
    return false;
  if (symbol->binding == STB_LOCAL && ld_starts_with(symbol->name, ".L"))
    return false;
  return !ctx->options.strip_debug || symbol->type != STT_FILE;
}

/* Hidden and internal symbols are local in an executable (the gABI, "Symbol Table"). */
static bool becomes_local(const ld_symbol *symbol) {
  return symbol->visibility == STV_HIDDEN || symbol->visibility == STV_INTERNAL;
}

static void add_symbol(ld_context *ctx, symbol_table *table, const ld_symbol *symbol) {
  /* Thread-local objects have plain addresses here. */
  uint8_t type = symbol->type == STT_TLS ? STT_OBJECT : symbol->type;
  uint8_t binding = becomes_local(symbol) ? STB_LOCAL : symbol->binding;
  uint32_t header = symbol->kind == LD_DEFINED ? symbol->section->output->header_index : 0;
  Elf32_Sym entry = {.st_name = add_string(ctx, &table->names, symbol->name),
                     .st_value = ld_symbol_address(ctx, symbol),
                     .st_size = symbol->kind == LD_DEFSYM ? 0 : symbol->size,
                     .st_info = ELF32_ST_INFO(binding, type),
                     .st_other = symbol->visibility,
                     .st_shndx = header ? (Elf32_Half)header : (Elf32_Half)SHN_ABS};
  ld_push(ctx, &table->entries, entry);
}

static void add_globals(ld_context *ctx, symbol_table *table, bool local) {
  for (size_t i = 0; i < ctx->symbols.count; i++)
    if (is_wanted(ctx, ctx->symbols.items[i]) && becomes_local(ctx->symbols.items[i]) == local)
      add_symbol(ctx, table, ctx->symbols.items[i]);
}

static void collect_symbols(ld_context *ctx, symbol_table *table) {
  Elf32_Sym null = {0};
  add_string(ctx, &table->names, "");
  ld_push(ctx, &table->entries, null);
  add_globals(ctx, table, true); /* first: after the symbol of a file they would belong to that file */
  for (size_t o = 0; o < ctx->objects.count; o++) {
    const ld_object *object = ctx->objects.items[o];
    for (size_t i = 1; i < object->symbol_count && i < object->first_global; i++)
      if (is_wanted(ctx, object->symbols[i]))
        add_symbol(ctx, table, object->symbols[i]);
  }
  table->local_count = table->entries.count;
  add_globals(ctx, table, false);
}

/* --- headers --- */

typedef LD_VECTOR(Elf32_Shdr) header_list;

static void collect_headers(ld_context *ctx, header_list *headers, string_table *names) {
  Elf32_Shdr null = {0};
  add_string(ctx, names, "");
  ld_push(ctx, headers, null);
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    const ld_output *output = ctx->outputs.items[i];
    if (!output->header_index)
      continue;
    Elf32_Shdr header = {.sh_name = add_string(ctx, names, output->name),
                         .sh_type = output->type,
                         .sh_flags = output->flags & ~(uint32_t)SHF_TLS, /* its addresses are plain ones */
                         .sh_addr = output->address,
                         .sh_offset = output->file_offset,
                         .sh_size = output->size,
                         .sh_addralign = output->alignment,
                         .sh_entsize = output->entry_size};
    ld_push(ctx, headers, header);
  }
}

/* Appends a table to the image. The caller copies its bytes. */
static Elf32_Shdr *add_table(ld_context *ctx, header_list *headers, string_table *names, const char *name,
                             uint32_t type, size_t size, uint32_t alignment) {
  uint64_t offset = ld_align(ctx->image_size, alignment);
  Elf32_Shdr header = {.sh_name = add_string(ctx, names, name),
                       .sh_type = type,
                       .sh_offset = (uint32_t)offset,
                       .sh_size = (uint32_t)size,
                       .sh_addralign = alignment};
  ctx->image_size = (size_t)(offset + size);
  ld_push(ctx, headers, header);
  return &headers->items[headers->count - 1];
}

/* Writes structures into the image, in the file's byte order. */
static void put(const ld_context *ctx, size_t offset, const void *items, size_t size, Elf_Type type) {
  Elf_Data from = {.d_buf = (void *)items, .d_type = type, .d_size = size, .d_version = EV_CURRENT};
  Elf_Data to = {.d_buf = ctx->image + offset, .d_type = type, .d_size = size, .d_version = EV_CURRENT};
  elf32_xlatetof(&to, &from, ELFDATA2LSB);
}

static void put_file_header(const ld_context *ctx, size_t section_headers, size_t section_count) {
  Elf32_Ehdr header = {.e_ident = {ELFMAG0, ELFMAG1, ELFMAG2, ELFMAG3, ELFCLASS32, ELFDATA2LSB, EV_CURRENT},
                       .e_type = ET_EXEC,
                       .e_machine = TRAX_EM,
                       .e_version = EV_CURRENT,
                       .e_entry = ctx->entry,
                       .e_phoff = sizeof(Elf32_Ehdr),
                       .e_shoff = (uint32_t)section_headers,
                       .e_flags = ctx->stack,
                       .e_ehsize = sizeof(Elf32_Ehdr),
                       .e_phentsize = sizeof(Elf32_Phdr),
                       .e_phnum = (Elf32_Half)ctx->segments.count,
                       .e_shentsize = sizeof(Elf32_Shdr),
                       .e_shnum = (Elf32_Half)section_count,
                       .e_shstrndx = (Elf32_Half)(section_count - 1)};
  put(ctx, 0, &header, sizeof header, ELF_T_EHDR);
}

static void put_program_headers(const ld_context *ctx) {
  for (size_t i = 0; i < ctx->segments.count; i++) {
    const ld_segment *segment = &ctx->segments.items[i];
    Elf32_Phdr header = {.p_type = PT_LOAD,
                         .p_offset = segment->file_offset,
                         .p_vaddr = segment->address,
                         .p_paddr = segment->address,
                         .p_filesz = segment->file_size,
                         .p_memsz = segment->memory_size,
                         .p_flags = segment->flags,
                         .p_align = LD_SEGMENT_ALIGNMENT};
    put(ctx, sizeof(Elf32_Ehdr) + i * sizeof header, &header, sizeof header, ELF_T_PHDR);
  }
}

static void put_contents(const ld_context *ctx) {
  for (size_t i = 0; i < ctx->outputs.count; i++) {
    const ld_output *output = ctx->outputs.items[i];
    if (output->type == SHT_NOBITS)
      continue;
    for (size_t s = 0; s < output->sections.count; s++) {
      const ld_section *section = output->sections.items[s];
      if (section->data && section->size)
        memcpy(ctx->image + output->file_offset + section->output_offset, section->data, section->size);
    }
  }
}

bool ld_build_image(ld_context *ctx) {
  header_list headers = {0};
  string_table header_names = {0};
  symbol_table symbols = {0};
  size_t symbols_offset = 0, names_offset = 0;
  collect_headers(ctx, &headers, &header_names);
  if (headers.count + 3 >= SHN_LORESERVE) {
    ld_error(ctx, "more than %d output sections", SHN_LORESERVE - 4);
    return false;
  }
  collect_symbols(ctx, &symbols);
  bool strip = ctx->options.strip_all && symbols.entries.count == 1;
  if (!strip) {
    Elf32_Shdr *header = add_table(ctx, &headers, &header_names, ".symtab", SHT_SYMTAB,
                                   symbols.entries.count * sizeof(Elf32_Sym), sizeof(Elf32_Word));
    header->sh_link = (Elf32_Word)headers.count; /* the next section, .strtab */
    header->sh_info = (Elf32_Word)symbols.local_count;
    header->sh_entsize = sizeof(Elf32_Sym);
    symbols_offset = header->sh_offset;
    names_offset = add_table(ctx, &headers, &header_names, ".strtab", SHT_STRTAB, symbols.names.size, 1)->sh_offset;
  }
  add_string(ctx, &header_names, ".shstrtab"); /* before the size is taken */
  size_t header_names_offset =
      add_table(ctx, &headers, &header_names, ".shstrtab", SHT_STRTAB, header_names.size, 1)->sh_offset;
  size_t headers_offset = (size_t)ld_align(ctx->image_size, sizeof(Elf32_Word));
  ctx->image_size = headers_offset + headers.count * sizeof(Elf32_Shdr);

  ctx->image = ld_alloc(ctx, ctx->image_size);
  put_file_header(ctx, headers_offset, headers.count);
  put_program_headers(ctx);
  put_contents(ctx);
  if (!strip) {
    put(ctx, symbols_offset, symbols.entries.items, symbols.entries.count * sizeof(Elf32_Sym), ELF_T_SYM);
    memcpy(ctx->image + names_offset, symbols.names.bytes, symbols.names.size);
  }
  memcpy(ctx->image + header_names_offset, header_names.bytes, header_names.size);
  put(ctx, headers_offset, headers.items, headers.count * sizeof(Elf32_Shdr), ELF_T_SHDR);
  return true;
}

bool ld_write_image(ld_context *ctx) {
  return ld_write_file(ctx, ctx->options.output, ctx->image, ctx->image_size, /*executable=*/true);
}
