/* Decoding, encoding and disassembly from the generated tables. */
#include "trax/isa.h"
#include "trax/abi.h"

#include <inttypes.h>
#include <stdio.h>

const trax_op_info trax_op_table[TRAX_OP_COUNT] = {
    [TRAX_OP_ILLEGAL] = {.name = "ILLEGAL", .mnemonic = "illegal", .syntax = "", .format = TRAX_FORMAT_N},
#define TRAX_INSTRUCTION(NAME, MNEMONIC, SYNTAX, FORMAT, UNIT, MASK, MATCH, FLAGS, BYTES)                              \
  [TRAX_OP_##NAME] = {#NAME, MNEMONIC, SYNTAX, TRAX_FORMAT_##FORMAT, TRAX_UNIT_##UNIT, MASK, MATCH, FLAGS, BYTES},
#include "trax/instructions.inc"
#undef TRAX_INSTRUCTION
};

const unsigned trax_unit_latency[TRAX_UNIT_COUNT] = {
#define TRAX_UNIT(NAME, DESCRIPTION, LATENCY) LATENCY,
#include "trax/units.inc"
#undef TRAX_UNIT
};

const char *const trax_unit_names[TRAX_UNIT_COUNT] = {
#define TRAX_UNIT(NAME, DESCRIPTION, LATENCY) #NAME,
#include "trax/units.inc"
#undef TRAX_UNIT
};

static int32_t trax_field(uint32_t bits, unsigned width, bool is_signed) {
  return is_signed && bits >> (width - 1) & 1 ? (int32_t)bits - (int32_t)(1u << width) : (int32_t)bits;
}

#include "codec.inc"

trax_inst trax_decode(uint32_t word) {
  trax_inst inst = {.op = trax_classify(word)};
  if (inst.op == TRAX_OP_ILLEGAL)
    return inst;
  trax_get_fields(trax_op_table[inst.op].format, word, trax_imm_signed(inst.op), &inst);
  if (!trax_imm_is_legal(inst.op, (uint32_t)inst.imm))
    return (trax_inst){.op = TRAX_OP_ILLEGAL};
  return inst;
}

uint32_t trax_encode(trax_inst inst) {
  const trax_op_info *info = &trax_op_table[inst.op];
  return info->match | trax_put_fields(info->format, &inst);
}

static const char *special_register_name(int32_t number) {
  switch (number) {
#define NAME(CONSTANT, TEXT, NUMBER)                                                                                   \
  case NUMBER:                                                                                                         \
    return TEXT;
    TRAX_SPECIAL_REGISTERS(NAME)
  }
  return "?";
}

static const char *trap_name(int32_t code) {
  switch (code) { TRAX_TRAPS(NAME) }
  return "?";
}

static const char *fence_name(int32_t kind) {
  switch (kind) { TRAX_FENCES(NAME) }
#undef NAME
  return "?";
}

int trax_disassemble(uint32_t word, uint32_t pc, char *text, size_t size) {
  trax_inst inst = trax_decode(word);
  if (inst.op == TRAX_OP_ILLEGAL)
    return snprintf(text, size, ".word 0x%08" PRIx32, word);
  char operands[64] = "";
  size_t used = 0;
  for (const char *kind = trax_op_table[inst.op].syntax; *kind; kind++) {
    char *at = operands + used;
    size_t room = sizeof operands - used;
    int wrote = 0;
    switch (*kind) {
    case 'd':
      wrote = snprintf(at, room, "r%u", inst.rd);
      break;
    case 'a':
      wrote = snprintf(at, room, "r%u", inst.ra);
      break;
    case 'b':
      wrote = snprintf(at, room, "r%u", inst.rb);
      break;
    case 'i':
    case 'u':
      wrote = snprintf(at, room, "%" PRId32, inst.imm);
      break;
    case 'p':
      wrote = snprintf(at, room, "0x%" PRIx32, pc + (uint32_t)inst.imm);
      break;
    case 's':
      wrote = snprintf(at, room, "%s", special_register_name(inst.imm));
      break;
    case 't':
      wrote = snprintf(at, room, "%s", trap_name(inst.imm));
      break;
    case 'f':
      wrote = snprintf(at, room, "%s", fence_name(inst.imm));
      break;
    case ',':
      wrote = snprintf(at, room, ", ");
      break;
    default:
      wrote = snprintf(at, room, "%c", *kind);
    }
    used += (size_t)wrote;
  }
  return snprintf(text, size, "%s%s%s", trax_op_table[inst.op].mnemonic, used ? " " : "", operands);
}
