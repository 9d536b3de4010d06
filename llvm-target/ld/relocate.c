/* Relocations: the table of docs/abi.md. S is the symbol's address, A the addend, P the place's own address. */
#include "ld.h"

#include <dwarf.h>
#include <string.h>

static const char *const reloc_names[] = {
#define NAME(name, number) [number] = #name,
    TRAX_RELOCATIONS(NAME)
#undef NAME
};
#define RELOC_COUNT (sizeof reloc_names / sizeof reloc_names[0])

static uint32_t field_bytes(uint32_t type) {
  return type == R_TRAX_NONE || type == R_TRAX_JUMP ? 0 : type == R_TRAX_8 ? 1 : type == R_TRAX_16 ? 2 : 4;
}

/* --- places in words --- */

const char *ld_place(ld_context *ctx, const ld_section *section, uint32_t offset) {
  return ld_format(ctx, "%s:(%s+0x%x)", section->object ? section->object->name : "<linker>", section->name, offset);
}

/* The function around a place, or NULL. */
static const char *enclosing_function(const ld_section *section, uint32_t offset) {
  const ld_object *object = section->object;
  for (size_t i = 1; i < object->symbol_count; i++) {
    const ld_symbol *symbol = object->symbols[i];
    if (symbol->kind == LD_DEFINED && symbol->section == section && symbol->type == STT_FUNC &&
        offset >= symbol->value && offset - symbol->value < symbol->size)
      return symbol->name;
  }
  return NULL;
}

/* " (in function 'f')" or nothing. */
const char *ld_in_function(ld_context *ctx, const ld_section *section, uint32_t offset) {
  const char *function = enclosing_function(section, offset);
  return function ? ld_format(ctx, " (in function '%s')", function) : "";
}

/* "f", ".data+0x4", ... */
static const char *describe_target(ld_context *ctx, const ld_reloc *reloc) {
  const ld_symbol *symbol = reloc->symbol;
  const char *name = symbol->type == STT_SECTION && symbol->kind == LD_DEFINED ? symbol->section->name : symbol->name;
  if (reloc->addend == 0)
    return name;
  uint32_t magnitude = reloc->addend < 0 ? 0 - (uint32_t)reloc->addend : (uint32_t)reloc->addend;
  return ld_format(ctx, "%s%s0x%x", name, reloc->addend < 0 ? "-" : *name ? "+" : "", magnitude);
}

/* --- applying --- */

typedef struct place {
  ld_context *ctx;
  const ld_section *section;
  const ld_reloc *reloc;
  uint8_t *bytes;
} place;

static void store(uint8_t *bytes, uint32_t value, uint32_t width) {
  for (uint32_t i = 0; i < width; i++)
    bytes[i] = (uint8_t)(value >> (8 * i));
}

/* Replaces the low bits of an instruction. */
static void store_field(uint8_t *bytes, uint32_t value, unsigned bits) {
  uint32_t mask = (1u << bits) - 1;
  store(bytes, (ld_load32(bytes) & ~mask) | (value & mask), 4);
}

static const char *target_place(ld_context *ctx, const ld_symbol *symbol) {
  if (symbol->kind != LD_DEFINED || symbol->type == STT_SECTION)
    return "";
  return ld_format(ctx, "; '%s' is at 0x%x, %s", symbol->name, ld_symbol_address(ctx, symbol),
                   ld_place(ctx, symbol->section, symbol->value));
}

static bool check_range(const place *place, int64_t value, int64_t low, int64_t high) {
  if (value >= low && value <= high)
    return true;
  ld_context *ctx = place->ctx;
  ld_error(ctx, "%s: relocation %s to '%s' out of range: %lld is not in [%lld, %lld]%s%s",
           ld_place(ctx, place->section, place->reloc->offset), reloc_names[place->reloc->type],
           describe_target(ctx, place->reloc), (long long)value, (long long)low, (long long)high,
           target_place(ctx, place->reloc->symbol), ld_in_function(ctx, place->section, place->reloc->offset));
  return false;
}

/* A distance in instructions, as a signed number of `bits` bits. */
static void store_distance(const place *place, uint32_t distance, unsigned bits) {
  ld_context *ctx = place->ctx;
  int64_t limit = (int64_t)4 << (bits - 1), value = (int32_t)distance;
  if (place->reloc->symbol->kind == LD_UNDEFINED) /* a call of an undefined weak function does nothing */
    value = 4;
  if (value % 4 != 0)
    ld_error(ctx, "%s: relocation %s to '%s': the distance %lld is not a multiple of 4%s",
             ld_place(ctx, place->section, place->reloc->offset), reloc_names[place->reloc->type],
             describe_target(ctx, place->reloc), (long long)value,
             ld_in_function(ctx, place->section, place->reloc->offset));
  else if (check_range(place, value, -limit, limit - 4))
    store_field(place->bytes, (uint32_t)(value / 4), bits);
}

/* The location of a thread-local variable is an address and a look-up of a thread's copy. All copies have one address,
   in the threads' local memories: no debugger has to look anything up. */
static void drop_lookup(const place *place) {
  const ld_section *section = place->section;
  uint8_t *next = place->bytes + 4;
  if (place->reloc->symbol->type == STT_TLS && section->size - place->reloc->offset > 4 &&
      strcmp(section->name, ".debug_info") == 0 &&
      (*next == DW_OP_GNU_push_tls_address || *next == DW_OP_form_tls_address))
    *next = DW_OP_nop;
}

static void apply(const place *place, uint32_t target, uint32_t address) {
  int32_t value = (int32_t)target;
  switch (place->reloc->type) {
  case R_TRAX_32:
    store(place->bytes, target, 4);
    drop_lookup(place);
    break;
  case R_TRAX_16:
    if (check_range(place, value, INT16_MIN, UINT16_MAX))
      store(place->bytes, target, 2);
    break;
  case R_TRAX_8:
    if (check_range(place, value, INT8_MIN, UINT8_MAX))
      store(place->bytes, target, 1);
    break;
  case R_TRAX_PC32:
    store(place->bytes, target - address, 4);
    break;
  case R_TRAX_HI16:
    store_field(place->bytes, (target + 0x8000) >> 16, 16);
    break;
  case R_TRAX_LO16:
    store_field(place->bytes, target, 16);
    break;
  case R_TRAX_IMM16:
    if (check_range(place, value, INT16_MIN, INT16_MAX))
      store_field(place->bytes, target, 16);
    break;
  case R_TRAX_BR16:
    store_distance(place, target - address, 16);
    break;
  case R_TRAX_JAL21:
    store_distance(place, target - address, 21);
    break;
  }
}

/* The address of dropped code and data in debug information: the highest one, where no code can be. (0, the usual
   choice, is wrong here: a dropped function of more than 4 kB would seem to reach from 0 into the text at 0x1000.) In
   lists of ranges that address would introduce a new base and two zeros would end the list, so there it is 1, an empty
   range. */
static uint32_t tombstone(const ld_section *section) {
  bool is_list = strcmp(section->name, ".debug_loc") == 0 || strcmp(section->name, ".debug_ranges") == 0;
  return is_list ? 1 : UINT32_MAX;
}

/* S + A. False after an error message. */
static bool target_address(const place *place, uint32_t *target) {
  ld_context *ctx = place->ctx;
  const ld_reloc *reloc = place->reloc;
  const ld_symbol *symbol = reloc->symbol;
  bool loaded = place->section->flags & SHF_ALLOC;
  if (!loaded && (symbol->kind == LD_UNDEFINED || ld_symbol_is_dropped(symbol, reloc->addend))) {
    *target = tombstone(place->section);
    return true;
  }
  if (ld_symbol_is_dropped(symbol, reloc->addend)) {
    ld_error(ctx, "%s: relocation refers to '%s' in %s, which is not linked%s",
             ld_place(ctx, place->section, reloc->offset), describe_target(ctx, reloc),
             ld_place(ctx, symbol->section, symbol->value), ld_in_function(ctx, place->section, reloc->offset));
    return false;
  }
  bool from_section = symbol->kind == LD_DEFINED && symbol->type == STT_SECTION && symbol->section->pieces;
  if (!from_section) {
    *target = ld_symbol_address(ctx, symbol) + (uint32_t)reloc->addend;
    return true;
  }
  uint32_t offset = ld_symbol_offset(symbol, reloc->addend); /* the addend chooses the piece */
  if (!ld_find_piece(symbol->section, offset)) {
    ld_error(ctx, "%s: relocation to '%s' leads out of the section, which has 0x%x bytes",
             ld_place(ctx, place->section, reloc->offset), describe_target(ctx, reloc), symbol->section->size);
    return false;
  }
  *target = ld_section_address(symbol->section, offset);
  return true;
}

static void relocate_section(ld_context *ctx, const ld_section *section) {
  uint8_t *bytes = ctx->image + section->output->file_offset + section->output_offset;
  uint32_t start = section->output->address + section->output_offset;
  for (uint32_t r = 0; r < section->reloc_count; r++) {
    const ld_reloc *reloc = &section->relocs[r];
    if (reloc->type >= RELOC_COUNT) {
      ld_error(ctx, "%s: unknown relocation type %u", ld_place(ctx, section, reloc->offset), reloc->type);
      continue;
    }
    uint32_t width = field_bytes(reloc->type);
    if (width > section->size || reloc->offset > section->size - width) {
      ld_error(ctx, "%s: relocation %s lies outside the section, which has 0x%x bytes",
               ld_place(ctx, section, reloc->offset), reloc_names[reloc->type], section->size);
      continue;
    }
    place place = {.ctx = ctx, .section = section, .reloc = reloc, .bytes = bytes + reloc->offset};
    uint32_t target;
    if (field_bytes(reloc->type) && target_address(&place, &target))
      apply(&place, target, start + reloc->offset);
  }
}

bool ld_relocate(ld_context *ctx) {
  for (size_t i = 0; i < ctx->sections.count; i++) {
    const ld_section *section = ctx->sections.items[i];
    if (section->live && section->reloc_count)
      relocate_section(ctx, section);
  }
  return ctx->error_count == 0;
}
