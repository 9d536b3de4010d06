#include "program/unwind.h"

#include <dwarf.h>
#include <string.h>

#include "program/image_internal.h"

enum { RA = 1, SP = 2, SAVED_STATES = 8 };

/* Reads a LEB128 number and truncates it to the 32 bits of an address or offset. */
static uint32_t leb(trax_dwarf_reader *reader, bool is_signed) {
  return (uint32_t)trax_dwarf_leb(reader, is_signed);
}

/* Returns the register with this number in debug information. */
static unsigned register_of(uint64_t number, trax_dwarf_reader *reader) {
  static const uint8_t registers[TRAX_NUM_REGISTERS] = TRAX_DWARF_REGISTERS;
  if (number < TRAX_NUM_REGISTERS)
    return registers[number];
  reader->bad = true;
  return 0;
}

static unsigned register_number(trax_dwarf_reader *reader) {
  return register_of(trax_dwarf_leb(reader, false), reader);
}

struct rule {
  enum { RULE_SAME, RULE_UNDEFINED, RULE_AT, RULE_IS, RULE_REGISTER } kind; /* AT, IS: CFA + value */
  uint32_t value;
};

struct row {
  unsigned cfa_register;
  uint32_t cfa_offset;
  struct rule rules[TRAX_NUM_REGISTERS];
};

struct frame_entry {
  uint32_t begin, bytes, code_factor, data_factor;
  unsigned return_column;
  trax_dwarf_reader common, own; /* instructions of the CIE and of the FDE */
};

/* --- finding --- */

bool trax_image_section(const trax_image *image, const char *wanted, trax_dwarf_reader *reader) {
  size_t names;
  if (elf_getshdrstrndx(image->elf, &names) != 0)
    return false;
  for (Elf_Scn *section = NULL; (section = elf_nextscn(image->elf, section));) {
    const Elf32_Shdr *header = elf32_getshdr(section);
    const char *name = header ? elf_strptr(image->elf, names, header->sh_name) : NULL;
    if (name && strcmp(name, wanted) == 0 && header->sh_type != SHT_NOBITS) { /* image.c has checked its range */
      const uint8_t *begin = image->bytes + header->sh_offset;
      *reader = (trax_dwarf_reader){begin, begin + header->sh_size, false};
      return true;
    }
  }
  return false;
}

/* Returns a reader of the next entry and moves past the entry. */
static trax_dwarf_reader take_entry(trax_dwarf_reader *reader) {
  const uint32_t length = trax_dwarf_fixed(reader, 4);
  const uint8_t *at = trax_dwarf_take(reader, length);
  return at ? (trax_dwarf_reader){at, at + length, false} : (trax_dwarf_reader){.bad = true};
}

static bool read_common(trax_dwarf_reader section, uint32_t offset, struct frame_entry *entry) {
  if (!trax_dwarf_take(&section, offset))
    return false;
  trax_dwarf_reader cie = take_entry(&section);
  if (cie.bad || trax_dwarf_fixed(&cie, 4) != DW_CIE_ID_32)
    return false;
  const uint32_t version = trax_dwarf_fixed(&cie, 1);
  if (version != 1 && version != 3 && version != 4)
    return false;
  if (trax_dwarf_fixed(&cie, 1) != 0) /* an augmentation, which our compiler does not write */
    return false;
  if (version >= 4)
    trax_dwarf_take(&cie, 2); /* sizes of addresses and segments */
  entry->code_factor = leb(&cie, false);
  entry->data_factor = leb(&cie, true);
  entry->return_column = register_number(&cie);
  entry->common = cie;
  return !cie.bad;
}

static bool find_entry(const trax_image *image, uint32_t pc, struct frame_entry *entry) {
  trax_dwarf_reader section, whole;
  if (!trax_image_section(image, ".debug_frame", &section))
    return false;
  whole = section;
  while (section.at < section.end) {
    trax_dwarf_reader fde = take_entry(&section);
    if (fde.bad)
      return false;
    if (fde.at == fde.end) /* a terminator: the end of an object's entries, or padding */
      continue;
    const uint32_t common = trax_dwarf_fixed(&fde, 4);
    if (fde.bad)
      return false;
    if (common == DW_CIE_ID_32)
      continue;
    entry->begin = trax_dwarf_fixed(&fde, 4);
    entry->bytes = trax_dwarf_fixed(&fde, 4);
    entry->own = fde;
    if (!fde.bad && pc - entry->begin < entry->bytes)
      return read_common(whole, common, entry);
  }
  return false;
}

/* --- reading --- */

struct interpreter {
  const struct frame_entry *entry;
  struct row row, initial, saved[SAVED_STATES];
  unsigned saved_count;
  uint32_t pc;    /* the row for this pc is wanted */
  uint32_t place; /* the first pc of the current row */
};

static void set_rule(struct interpreter *it, unsigned number, int kind, uint32_t value) {
  it->row.rules[number].kind = kind;
  it->row.rules[number].value = value;
}

static void advance(struct interpreter *it, uint32_t units) {
  it->place += units * it->entry->code_factor;
}

static void interpret_long(struct interpreter *it, uint8_t opcode, trax_dwarf_reader *reader) {
  const uint32_t factor = it->entry->data_factor;
  unsigned number;
  switch (opcode) {
  case DW_CFA_nop:
    break;
  case DW_CFA_set_loc:
    it->place = trax_dwarf_fixed(reader, 4);
    break;
  case DW_CFA_advance_loc1:
    advance(it, trax_dwarf_fixed(reader, 1));
    break;
  case DW_CFA_advance_loc2:
    advance(it, trax_dwarf_fixed(reader, 2));
    break;
  case DW_CFA_advance_loc4:
    advance(it, trax_dwarf_fixed(reader, 4));
    break;
  case DW_CFA_offset_extended:
    number = register_number(reader);
    set_rule(it, number, RULE_AT, leb(reader, false) * factor);
    break;
  case DW_CFA_offset_extended_sf:
    number = register_number(reader);
    set_rule(it, number, RULE_AT, leb(reader, true) * factor);
    break;
  case DW_CFA_val_offset:
    number = register_number(reader);
    set_rule(it, number, RULE_IS, leb(reader, false) * factor);
    break;
  case DW_CFA_val_offset_sf:
    number = register_number(reader);
    set_rule(it, number, RULE_IS, leb(reader, true) * factor);
    break;
  case DW_CFA_register:
    number = register_number(reader);
    set_rule(it, number, RULE_REGISTER, register_number(reader));
    break;
  case DW_CFA_restore_extended:
    number = register_number(reader);
    it->row.rules[number] = it->initial.rules[number];
    break;
  case DW_CFA_undefined:
    set_rule(it, register_number(reader), RULE_UNDEFINED, 0);
    break;
  case DW_CFA_same_value:
    set_rule(it, register_number(reader), RULE_SAME, 0);
    break;
  case DW_CFA_remember_state:
    if (it->saved_count == SAVED_STATES)
      reader->bad = true;
    else
      it->saved[it->saved_count++] = it->row;
    break;
  case DW_CFA_restore_state:
    if (it->saved_count == 0)
      reader->bad = true;
    else
      it->row = it->saved[--it->saved_count];
    break;
  case DW_CFA_def_cfa:
    it->row.cfa_register = register_number(reader);
    it->row.cfa_offset = leb(reader, false);
    break;
  case DW_CFA_def_cfa_register:
    it->row.cfa_register = register_number(reader);
    break;
  case DW_CFA_def_cfa_offset:
    it->row.cfa_offset = leb(reader, false);
    break;
  case DW_CFA_def_cfa_sf:
    it->row.cfa_register = register_number(reader);
    it->row.cfa_offset = leb(reader, true) * factor;
    break;
  case DW_CFA_def_cfa_offset_sf:
    it->row.cfa_offset = leb(reader, true) * factor;
    break;
  default: /* an expression, which our compiler does not write */
    reader->bad = true;
    break;
  }
}

/* Interprets instructions up to the row for it->pc. */
static bool interpret(struct interpreter *it, trax_dwarf_reader reader) {
  while (reader.at < reader.end && !reader.bad) {
    const uint8_t opcode = (uint8_t)trax_dwarf_fixed(&reader, 1), low = opcode & 0x3F;
    unsigned number;
    switch (opcode & 0xC0) {
    case DW_CFA_advance_loc:
      advance(it, low);
      break;
    case DW_CFA_offset:
      number = register_of(low, &reader);
      set_rule(it, number, RULE_AT, leb(&reader, false) * it->entry->data_factor);
      break;
    case DW_CFA_restore:
      number = register_of(low, &reader);
      it->row.rules[number] = it->initial.rules[number];
      break;
    default:
      interpret_long(it, opcode, &reader);
      break;
    }
    if (it->place > it->pc)
      break;
  }
  return !reader.bad;
}

/* --- applying --- */

static bool value_of(const struct rule *rule, unsigned number, const struct trax_frame *frame, uint32_t cfa,
                     bool (*read)(void *context, uint32_t address, uint32_t *word), void *context, uint32_t *value) {
  switch (rule->kind) {
  case RULE_SAME:
    *value = number == SP ? cfa : frame->registers[number];
    return true;
  case RULE_AT:
    return read(context, cfa + rule->value, value);
  case RULE_IS:
    *value = cfa + rule->value;
    return true;
  case RULE_REGISTER:
    *value = frame->registers[rule->value];
    return true;
  case RULE_UNDEFINED:
    break;
  }
  *value = 0;
  return true;
}

enum trax_unwound trax_image_unwind(const trax_image *image, struct trax_frame *frame,
                                    bool (*read)(void *context, uint32_t address, uint32_t *word), void *context) {
  struct frame_entry entry;
  struct interpreter it = {.entry = &entry, .pc = trax_frame_place(frame)};
  if (!find_entry(image, it.pc, &entry))
    return TRAX_NO_FRAME_INFO;
  it.place = entry.begin;
  if (!interpret(&it, entry.common))
    return TRAX_NO_FRAME_INFO;
  it.initial = it.row;
  if (!interpret(&it, entry.own))
    return TRAX_NO_FRAME_INFO;
  if (it.row.rules[entry.return_column].kind == RULE_UNDEFINED)
    return TRAX_OUTERMOST;
  const uint32_t cfa = frame->registers[it.row.cfa_register] + it.row.cfa_offset;
  struct trax_frame caller = {.is_caller = true};
  for (unsigned i = 0; i < TRAX_NUM_REGISTERS; ++i)
    if (!value_of(&it.row.rules[i], i, frame, cfa, read, context, &caller.registers[i]))
      return TRAX_NO_FRAME_INFO;
  caller.pc = caller.registers[entry.return_column];
  /* A frame that is its own caller would never end the chain. */
  if (caller.pc == frame->pc && caller.registers[SP] == frame->registers[SP] && frame->is_caller)
    return TRAX_NO_FRAME_INFO;
  *frame = caller;
  return TRAX_UNWOUND;
}
