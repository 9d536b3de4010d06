#include "gdb/dwarf_registers.h"

#include "program/dwarf_reader.h"
#include <dwarf.h>

enum { REGISTERS = 32, ADDRESS = 4, OFFSET = 4, DEPTH = 4 /* of nested expressions */ };

struct cursor {
  trax_dwarf_reader in; /* also `bad` after an unknown operation */
  trax_register_map map;
  unsigned depth;
};

/* The reader's bytes are const, but the caller has passed them to be changed (dwarf_registers.h). */
static void put(const uint8_t *at, uint8_t byte) {
  *(uint8_t *)at = byte;
}

static const uint8_t *skip(struct cursor *cursor, uint64_t bytes) {
  return trax_dwarf_take(&cursor->in, bytes);
}

static uint64_t fixed(struct cursor *cursor, unsigned bytes) {
  return trax_dwarf_fixed(&cursor->in, bytes);
}

static uint64_t leb(struct cursor *cursor) { /* also skips signed numbers, whose value is not needed */
  return trax_dwarf_leb(&cursor->in, false);
}

/* Renumbers a register written as ULEB128. */
static void renumber(struct cursor *cursor) {
  const uint8_t *at = cursor->in.at;
  const uint64_t number = leb(cursor);
  if (cursor->in.bad || number >= REGISTERS || cursor->in.at != at + 1)
    cursor->in.bad = true;
  else
    put(at, cursor->map[number]);
}

static void expression(struct cursor *cursor, uint64_t size);

static void operation(struct cursor *cursor) {
  const uint8_t *at = skip(cursor, 1);
  if (!at)
    return;
  if (*at >= DW_OP_reg0 && *at <= DW_OP_reg31) {
    put(at, (uint8_t)(DW_OP_reg0 + cursor->map[*at - DW_OP_reg0]));
    return;
  }
  if (*at >= DW_OP_breg0 && *at <= DW_OP_breg31) {
    put(at, (uint8_t)(DW_OP_breg0 + cursor->map[*at - DW_OP_breg0]));
    leb(cursor);
    return;
  }
  if (*at >= DW_OP_lit0 && *at <= DW_OP_lit31)
    return;
  switch (*at) {
  case DW_OP_addr:
  case DW_OP_const4u:
  case DW_OP_const4s:
  case DW_OP_call4:
  case DW_OP_call_ref:
  case DW_OP_GNU_parameter_ref:
    skip(cursor, 4);
    break;
  case DW_OP_const8u:
  case DW_OP_const8s:
    skip(cursor, 8);
    break;
  case DW_OP_const2u:
  case DW_OP_const2s:
  case DW_OP_bra:
  case DW_OP_skip:
  case DW_OP_call2:
    skip(cursor, 2);
    break;
  case DW_OP_const1u:
  case DW_OP_const1s:
  case DW_OP_pick:
  case DW_OP_deref_size:
  case DW_OP_xderef_size:
    skip(cursor, 1);
    break;
  case DW_OP_constu:
  case DW_OP_consts:
  case DW_OP_plus_uconst:
  case DW_OP_fbreg:
  case DW_OP_piece:
  case DW_OP_addrx:
  case DW_OP_constx:
  case DW_OP_convert:
  case DW_OP_reinterpret:
  case DW_OP_GNU_convert:
  case DW_OP_GNU_reinterpret:
    leb(cursor);
    break;
  case DW_OP_bit_piece:
    leb(cursor);
    leb(cursor);
    break;
  case DW_OP_form_tls_address: /* thread-local objects have addresses of local memory, not offsets (docs/abi.md) */
  case DW_OP_GNU_push_tls_address:
    put(at, DW_OP_nop);
    break;
  case DW_OP_regx:
    renumber(cursor);
    break;
  case DW_OP_bregx:
  case DW_OP_regval_type:
  case DW_OP_GNU_regval_type:
    renumber(cursor);
    leb(cursor);
    break;
  case DW_OP_deref_type:
  case DW_OP_GNU_deref_type:
    skip(cursor, 1);
    leb(cursor);
    break;
  case DW_OP_const_type:
  case DW_OP_GNU_const_type:
    leb(cursor);
    skip(cursor, fixed(cursor, 1));
    break;
  case DW_OP_implicit_value:
    skip(cursor, leb(cursor));
    break;
  case DW_OP_implicit_pointer:
  case DW_OP_GNU_implicit_pointer:
    skip(cursor, OFFSET);
    leb(cursor);
    break;
  case DW_OP_entry_value:
  case DW_OP_GNU_entry_value:
    expression(cursor, leb(cursor));
    break;
  case DW_OP_deref:
  case DW_OP_dup:
  case DW_OP_drop:
  case DW_OP_over:
  case DW_OP_swap:
  case DW_OP_rot:
  case DW_OP_xderef:
  case DW_OP_abs:
  case DW_OP_and:
  case DW_OP_div:
  case DW_OP_minus:
  case DW_OP_mod:
  case DW_OP_mul:
  case DW_OP_neg:
  case DW_OP_not:
  case DW_OP_or:
  case DW_OP_plus:
  case DW_OP_shl:
  case DW_OP_shr:
  case DW_OP_shra:
  case DW_OP_xor:
  case DW_OP_eq:
  case DW_OP_ge:
  case DW_OP_gt:
  case DW_OP_le:
  case DW_OP_lt:
  case DW_OP_ne:
  case DW_OP_nop:
  case DW_OP_push_object_address:
  case DW_OP_call_frame_cfa:
  case DW_OP_stack_value:
    break;
  default:
    cursor->in.bad = true;
    break;
  }
}

static void expression(struct cursor *cursor, uint64_t size) {
  const uint8_t *at = skip(cursor, size);
  if (!at || ++cursor->depth > DEPTH) {
    cursor->in.bad = true;
    return;
  }
  struct cursor inner = {.in = {at, at + size, false}, .map = cursor->map, .depth = cursor->depth};
  while (inner.in.at < inner.in.end && !inner.in.bad)
    operation(&inner);
  cursor->in.bad |= inner.in.bad;
  cursor->depth--;
}

bool trax_dwarf_renumber_expression(uint8_t *bytes, size_t size, trax_register_map map) {
  struct cursor cursor = {.in = {bytes, bytes + size, false}, .map = map};
  expression(&cursor, size);
  return !cursor.in.bad;
}

/* --- call frames --- */

static void frame_instruction(struct cursor *cursor) {
  const uint8_t *at = skip(cursor, 1);
  if (!at)
    return;
  const uint8_t low = *at & 0x3F, high = *at & 0xC0;
  if (high == DW_CFA_advance_loc)
    return;
  if (high) { /* offset, restore */
    if (low >= REGISTERS)
      cursor->in.bad = true;
    else
      put(at, high | cursor->map[low]);
    if (high == DW_CFA_offset)
      leb(cursor);
    return;
  }
  switch (*at) {
  case DW_CFA_nop:
  case DW_CFA_remember_state:
  case DW_CFA_restore_state:
    break;
  case DW_CFA_set_loc:
  case DW_CFA_advance_loc4:
    skip(cursor, 4);
    break;
  case DW_CFA_advance_loc1:
    skip(cursor, 1);
    break;
  case DW_CFA_advance_loc2:
    skip(cursor, 2);
    break;
  case DW_CFA_restore_extended:
  case DW_CFA_undefined:
  case DW_CFA_same_value:
  case DW_CFA_def_cfa_register:
    renumber(cursor);
    break;
  case DW_CFA_offset_extended:
  case DW_CFA_offset_extended_sf:
  case DW_CFA_def_cfa:
  case DW_CFA_def_cfa_sf:
  case DW_CFA_val_offset:
  case DW_CFA_val_offset_sf:
    renumber(cursor);
    leb(cursor);
    break;
  case DW_CFA_register:
    renumber(cursor);
    renumber(cursor);
    break;
  case DW_CFA_def_cfa_offset:
  case DW_CFA_def_cfa_offset_sf:
  case DW_CFA_GNU_args_size:
    leb(cursor);
    break;
  case DW_CFA_def_cfa_expression:
    expression(cursor, leb(cursor));
    break;
  case DW_CFA_expression:
  case DW_CFA_val_expression:
    renumber(cursor);
    expression(cursor, leb(cursor));
    break;
  default:
    cursor->in.bad = true;
    break;
  }
}

/* Renumbers a CIE; its length and identification have been read. */
static void common_information(struct cursor *cursor) {
  const uint64_t version = fixed(cursor, 1);
  if (version != 1 && version != 3 && version != 4)
    cursor->in.bad = true;
  const uint8_t *augmentation = skip(cursor, 1);
  if (!augmentation || *augmentation) /* our compiler writes no augmentation */
    cursor->in.bad = true;
  if (version >= 4)
    skip(cursor, 2); /* sizes of addresses and segments */
  leb(cursor);
  leb(cursor);
  renumber(cursor); /* the return address's register; one byte in every version */
}

static void frame_head(struct cursor *cursor) {
  if (fixed(cursor, 4) == DW_CIE_ID_32)
    common_information(cursor);
  else
    skip(cursor, 2 * ADDRESS);
}

/* Renumbers a section of parts that begin with their length: a head, and items up to the end. A part of length 0 is a
   terminator or padding. */
static bool renumber_parts(uint8_t *bytes, size_t size, trax_register_map map, void (*head)(struct cursor *cursor),
                           void (*item)(struct cursor *cursor)) {
  struct cursor cursor = {.in = {bytes, bytes + size, false}, .map = map};
  while (cursor.in.at < cursor.in.end && !cursor.in.bad) {
    const uint64_t length = fixed(&cursor, 4);
    const uint8_t *at = skip(&cursor, length);
    if (!at || length == 0)
      continue;
    struct cursor part = {.in = {at, at + length, false}, .map = map};
    head(&part);
    while (part.in.at < part.in.end && !part.in.bad)
      item(&part);
    cursor.in.bad |= part.in.bad;
  }
  return !cursor.in.bad;
}

bool trax_dwarf_renumber_frames(uint8_t *bytes, size_t size, trax_register_map map) {
  return renumber_parts(bytes, size, map, frame_head, frame_instruction);
}

/* --- location lists --- */

bool trax_dwarf_renumber_locations(uint8_t *bytes, size_t size, trax_register_map map) {
  struct cursor cursor = {.in = {bytes, bytes + size, false}, .map = map};
  while (cursor.in.at < cursor.in.end && !cursor.in.bad) {
    const uint64_t begin = fixed(&cursor, ADDRESS), end = fixed(&cursor, ADDRESS);
    if ((begin || end) && begin != UINT32_MAX) /* else the end of a list or a new base */
      expression(&cursor, fixed(&cursor, 2));
  }
  return !cursor.in.bad;
}

static void list_entry(struct cursor *cursor) {
  switch (fixed(cursor, 1)) {
  case DW_LLE_end_of_list:
    return;
  case DW_LLE_base_addressx:
    leb(cursor);
    return;
  case DW_LLE_base_address:
    skip(cursor, ADDRESS);
    return;
  case DW_LLE_startx_endx:
  case DW_LLE_startx_length:
  case DW_LLE_offset_pair:
    leb(cursor);
    leb(cursor);
    break;
  case DW_LLE_default_location:
    break;
  case DW_LLE_start_end:
    skip(cursor, 2 * ADDRESS);
    break;
  case DW_LLE_start_length:
    skip(cursor, ADDRESS);
    leb(cursor);
    break;
  default:
    cursor->in.bad = true;
    return;
  }
  expression(cursor, leb(cursor));
}

static void list_head(struct cursor *cursor) {
  skip(cursor, 4); /* version, sizes */
  skip(cursor, fixed(cursor, 4) * OFFSET);
}

bool trax_dwarf_renumber_lists(uint8_t *bytes, size_t size, trax_register_map map) {
  return renumber_parts(bytes, size, map, list_head, list_entry);
}
