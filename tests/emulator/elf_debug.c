/* A compile unit by hand: see elf_writer.h for what it says. */
#undef NDEBUG /* tests check in every build */
#include <assert.h>
#include <dwarf.h>
#include <string.h>

#include "elf_writer.h"

struct bytes {
  uint8_t *begin;
  size_t used, capacity;
};

static void put(struct bytes *bytes, uint32_t value, size_t size) {
  assert(bytes->used + size <= bytes->capacity);
  for (size_t i = 0; i < size; ++i)
    bytes->begin[bytes->used++] = (uint8_t)(value >> 8 * i);
}

static void put_text(struct bytes *bytes, const char *text) {
  for (size_t i = 0; i <= strlen(text); ++i)
    put(bytes, (uint8_t)text[i], 1);
}

static void put_list(struct bytes *bytes, const uint8_t *list, size_t count) {
  for (size_t i = 0; i < count; ++i)
    put(bytes, list[i], 1);
}
#define PUT_LIST(BYTES, ...) put_list(BYTES, (const uint8_t[]){__VA_ARGS__}, sizeof((const uint8_t[]){__VA_ARGS__}))

/* The length field at `at` counts what follows it. */
static void patch_length(struct bytes *bytes, size_t at) {
  uint32_t length = (uint32_t)(bytes->used - at - 4);
  for (size_t i = 0; i < 4; ++i)
    bytes->begin[at + i] = (uint8_t)(length >> 8 * i);
}

enum { UNIT = 1, FUNCTION, ABSTRACT, INLINED };

static void make_abbreviations(struct bytes *out) {
  PUT_LIST(out, UNIT, DW_TAG_compile_unit, DW_CHILDREN_yes, DW_AT_name, DW_FORM_string, DW_AT_comp_dir, DW_FORM_string,
           DW_AT_stmt_list, DW_FORM_sec_offset, DW_AT_low_pc, DW_FORM_addr, DW_AT_high_pc, DW_FORM_data4, 0, 0);
  PUT_LIST(out, FUNCTION, DW_TAG_subprogram, DW_CHILDREN_yes, DW_AT_name, DW_FORM_string, DW_AT_low_pc, DW_FORM_addr,
           DW_AT_high_pc, DW_FORM_data4, 0, 0);
  PUT_LIST(out, ABSTRACT, DW_TAG_subprogram, DW_CHILDREN_no, DW_AT_name, DW_FORM_string, DW_AT_inline, DW_FORM_data1, 0,
           0);
  PUT_LIST(out, INLINED, DW_TAG_inlined_subroutine, DW_CHILDREN_no, DW_AT_abstract_origin, DW_FORM_ref4, DW_AT_low_pc,
           DW_FORM_addr, DW_AT_high_pc, DW_FORM_data4, DW_AT_call_file, DW_FORM_data1, DW_AT_call_line, DW_FORM_data1,
           0, 0);
  put(out, 0, 1);
}

static void make_info(struct bytes *out, uint32_t text, size_t words) {
  put(out, 0, 4);
  put(out, 4, 2); /* DWARF 4 */
  put(out, 0, 4); /* abbreviations */
  put(out, 4, 1); /* bytes of an address */
  put(out, UNIT, 1);
  put_text(out, "source.c");
  put_text(out, "dir");
  put(out, 0, 4); /* lines */
  put(out, text, 4);
  put(out, (uint32_t)words * 4, 4);
  uint32_t abstract = (uint32_t)out->used;
  put(out, ABSTRACT, 1);
  put_text(out, "inner");
  put(out, DW_INL_inlined, 1);
  put(out, FUNCTION, 1);
  put_text(out, "outer");
  put(out, text, 4);
  put(out, (uint32_t)words * 4, 4);
  put(out, INLINED, 1);
  put(out, abstract, 4);
  put(out, text + 8, 4);
  put(out, 4, 4);
  put(out, 1, 1);  /* file */
  put(out, 12, 1); /* line */
  put(out, 0, 1);  /* no more children of outer */
  put(out, 0, 1);  /* nor of the unit */
  patch_length(out, 0);
}

static void make_lines(struct bytes *out, uint32_t text, size_t words) {
  put(out, 0, 4);
  put(out, 4, 2);
  size_t header = out->used;
  put(out, 0, 4);
  /* minimum instruction length, operations per instruction, default is_stmt, line base, line range, opcode base */
  PUT_LIST(out, 4, 1, 1, 0, 1, 13, 0, 1, 1, 1, 1, 0, 0, 0, 1, 0, 0, 1);
  put(out, 0, 1); /* directories */
  put_text(out, "source.c");
  PUT_LIST(out, 0, 0, 0, 0); /* directory, time, length; end of the files */
  patch_length(out, header);
  PUT_LIST(out, 0, 5, DW_LNE_set_address);
  put(out, text, 4);
  PUT_LIST(out, DW_LNS_set_column, 3);
  int line = 1;
  for (size_t i = 0; i < words; ++i) {
    int next = i == 2 ? 5 : 10 + (int)i;
    PUT_LIST(out, DW_LNS_advance_line, (uint8_t)((next - line) & 0x7F), DW_LNS_copy, DW_LNS_advance_pc, 1);
    line = next;
  }
  PUT_LIST(out, 0, 1, DW_LNE_end_sequence);
  patch_length(out, 0);
}

void elf_debug_make(struct elf_debug *debug, uint32_t text, size_t words) {
  struct bytes abbreviations = {debug->abbreviations, 0, sizeof debug->abbreviations};
  struct bytes info = {debug->info, 0, sizeof debug->info}, lines = {debug->lines, 0, sizeof debug->lines};
  make_abbreviations(&abbreviations);
  make_info(&info, text, words);
  make_lines(&lines, text, words);
  debug->abbreviation_bytes = abbreviations.used;
  debug->info_bytes = info.used;
  debug->line_bytes = lines.used;
}
