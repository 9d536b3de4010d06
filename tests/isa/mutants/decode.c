/* Mutants of decoding: the right trax_decode (isa/src/isa.c, compiled under another name) with one thing wrong. */
#include "mutants.h"
#include "trax/abi.h"
#include "trax/isa.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

trax_inst trax_true_decode(uint32_t word);

typedef enum kind {
  FIELD_BIT,     /* bit `bit` of a field reads as 0; fields are counted from the top */
  RESERVED_BIT,  /* bit `bit` of the word need not be zero */
  FREE_FUNCTION, /* function `bit` of opcode `op` is a nop */
  FREE_OPCODE,   /* opcode `op` is a nop */
  UNSIGNED_IMM,  /* the immediate is not sign extended */
  UNSCALED_IMM,  /* the immediate counts bytes */
  LIMIT,         /* a number from the limit on is taken modulo 8, */
  LIMIT_BYTE,    /* of 256 and more modulo 256 */
  LIMIT_NOP      /* does nothing */
} kind;

typedef struct decoding {
  kind kind;
  unsigned op, bit;
  uint32_t field; /* mask within the word */
} decoding;

static decoding *mutants;
static unsigned count;

static void add(decoding mutant) {
  if (count % 256 == 0) {
    mutants = realloc(mutants, (count + 256) * sizeof *mutants);
    if (!mutants)
      abort();
  }
  mutants[count++] = mutant;
}

/* The immediate's field; 0: none. */
static uint32_t immediate_of(const trax_op_info *info) {
  switch (info->format) {
  case TRAX_FORMAT_I:
  case TRAX_FORMAT_U:
  case TRAX_FORMAT_S:
  case TRAX_FORMAT_B:
  case TRAX_FORMAT_T:
  case TRAX_FORMAT_F:
    return 0xFFFFu;
  case TRAX_FORMAT_SH:
    return 0x1Fu;
  case TRAX_FORMAT_J:
    return 0x1FFFFFu;
  default:
    return 0;
  }
}

static bool has_limit(trax_op op) {
  return op == TRAX_OP_RDSR || op == TRAX_OP_TRAP || op == TRAX_OP_FENCE;
}

/* Bits of the field that a legal number can have. */
static unsigned number_bits(trax_op op) {
  return op == TRAX_OP_FENCE ? 2 : 3;
}

static bool is_signed(const trax_op_info *info) {
  return strpbrk(info->syntax, "ip") != NULL && info->format != TRAX_FORMAT_SH;
}

static void add_fields(trax_op op, const trax_op_info *info) {
  const uint32_t immediate = immediate_of(info), opcode = 0xFC000000u;
  /* Function codes are fixed, like zeros, but not reserved. */
  const uint32_t function = info->format <= TRAX_FORMAT_R1 ? 0x3Fu : 0;
  for (unsigned bit = 0; bit < 32; bit++) {
    const uint32_t one = 1u << bit;
    if (info->mask & one & ~opcode & ~function)
      add((decoding){RESERVED_BIT, op, bit, one});
    else if (!(info->mask & one) && !(has_limit(op) && (immediate & one) && bit >= number_bits(op)))
      add((decoding){FIELD_BIT, op, bit, one});
  }
  if (is_signed(info))
    add((decoding){UNSIGNED_IMM, op, 0, immediate});
  if (strchr(info->syntax, 'p'))
    add((decoding){UNSCALED_IMM, op, 0, immediate});
  if (has_limit(op)) {
    add((decoding){LIMIT, op, 0, immediate});
    add((decoding){LIMIT_BYTE, op, 0, immediate});
    add((decoding){LIMIT_NOP, op, 0, immediate});
  }
}

static void add_free(unsigned opcode) {
  bool used = false, functions[64] = {false}, has_functions = false;
  for (unsigned op = 1; op < TRAX_OP_COUNT; op++)
    if (trax_op_table[op].match >> 26 == opcode) {
      used = true;
      functions[trax_op_table[op].match & 0x3F] = true;
      has_functions |= trax_op_table[op].format <= TRAX_FORMAT_R1;
    }
  if (!used)
    add((decoding){FREE_OPCODE, opcode, 0, 0});
  for (unsigned function = 0; has_functions && function < 64; function++)
    if (!functions[function])
      add((decoding){FREE_FUNCTION, opcode, function, 0});
}

unsigned trax_decoding_mutants(void) {
  static_assert(TRAX_FORMAT_R == 0 && TRAX_FORMAT_R1 == 1, "the formats with function codes come first");
  if (!count) {
    for (unsigned op = 1; op < TRAX_OP_COUNT; op++)
      add_fields((trax_op)op, &trax_op_table[op]);
    for (unsigned opcode = 0; opcode < 64; opcode++)
      add_free(opcode);
  }
  return count;
}

static const char *field_name(const trax_op_info *info, unsigned bit) {
  if (immediate_of(info) >> bit & 1)
    return "immediate";
  const bool store = info->format == TRAX_FORMAT_S, branch = info->format == TRAX_FORMAT_B;
  return bit >= 21 ? (store ? "rb" : branch ? "ra" : "rd") : bit >= 16 ? (branch ? "rb" : "ra") : "rb";
}

static unsigned field_low(const trax_op_info *info, unsigned bit) {
  return immediate_of(info) >> bit & 1 ? 0 : bit >= 21 ? 21 : bit >= 16 ? 16 : 11;
}

void trax_decoding_mutant(unsigned index, struct trax_mutant_text *text) {
  const decoding *mutant = &mutants[index];
  const bool free_word = mutant->kind == FREE_OPCODE || mutant->kind == FREE_FUNCTION;
  const trax_op_info *info = free_word ? NULL : &trax_op_table[mutant->op];
  snprintf(text->mnemonic, sizeof text->mnemonic, "%s", free_word ? "" : info->mnemonic);
  char *const what = text->what;
  char *const image = text->image;
  const size_t size = sizeof text->what;
  switch (mutant->kind) {
  case FIELD_BIT:
    snprintf(what, size, "bit %u of %s reads as 0", mutant->bit - field_low(info, mutant->bit),
             field_name(info, mutant->bit));
    break;
  case RESERVED_BIT:
    snprintf(what, size, "bit %u of the word is not looked at", mutant->bit);
    snprintf(image, sizeof text->image, "%s-illegal-bit%u", info->mnemonic, mutant->bit);
    break;
  case FREE_FUNCTION:
    snprintf(what, size, "opcode %u, function %u is a nop", mutant->op, mutant->bit);
    snprintf(image, sizeof text->image, "unused-functions-%u-function%u", mutant->op, mutant->bit);
    break;
  case FREE_OPCODE:
    snprintf(what, size, "opcode %u is a nop", mutant->op);
    snprintf(image, sizeof text->image, "unused-opcodes-opcode%u_zeros", mutant->op);
    break;
  case UNSIGNED_IMM:
    snprintf(what, size, "the immediate is zero extended");
    break;
  case UNSCALED_IMM:
    snprintf(what, size, "the offset counts bytes");
    break;
  case LIMIT:
    snprintf(what, size, "only the lowest three bits of the number count");
    break;
  case LIMIT_BYTE:
    snprintf(what, size, "only the lowest eight bits of the number count");
    break;
  case LIMIT_NOP:
    snprintf(what, size, "an unknown number is a nop");
    break;
  }
}

static const trax_inst nop = {.op = TRAX_OP_ADDI};

/* Decodes a word of the mutant's instruction. */
static trax_inst decode_wrongly(const decoding *mutant, uint32_t word, trax_inst right) {
  const uint32_t field = mutant->field;
  switch (mutant->kind) {
  case FIELD_BIT:
    return trax_true_decode(word & ~field);
  case UNSIGNED_IMM:
    right.imm = (int32_t)((word & field) * (strchr(trax_op_table[right.op].syntax, 'p') ? 4 : 1));
    return right;
  case UNSCALED_IMM:
    right.imm /= 4;
    return right;
  default:
    return right;
  }
}

/* Decodes a word that is illegal. */
static trax_inst accept_wrongly(const decoding *mutant, uint32_t word) {
  const uint32_t number = word & mutant->field;
  switch (mutant->kind) {
  case RESERVED_BIT: {
    const trax_inst inst = trax_true_decode(word & ~mutant->field);
    return inst.op == mutant->op ? inst : (trax_inst){.op = TRAX_OP_ILLEGAL};
  }
  case FREE_OPCODE:
    return word >> 26 == mutant->op ? nop : (trax_inst){.op = TRAX_OP_ILLEGAL};
  case FREE_FUNCTION:
    return word >> 26 == mutant->op && (word & 0x3F) == mutant->bit ? nop : (trax_inst){.op = TRAX_OP_ILLEGAL};
  case LIMIT:
    return word >> 26 == trax_op_table[mutant->op].match >> 26
               ? trax_true_decode((word & ~mutant->field) | (number & 7))
               : (trax_inst){.op = TRAX_OP_ILLEGAL};
  case LIMIT_BYTE:
    return word >> 26 == trax_op_table[mutant->op].match >> 26
               ? trax_true_decode((word & ~mutant->field) | (number & 255))
               : (trax_inst){.op = TRAX_OP_ILLEGAL};
  case LIMIT_NOP:
    return trax_true_decode((word & ~mutant->field) | 1).op == mutant->op ? nop : (trax_inst){.op = TRAX_OP_ILLEGAL};
  default:
    return (trax_inst){.op = TRAX_OP_ILLEGAL};
  }
}

trax_inst trax_decode(uint32_t word) {
  const trax_inst right = trax_true_decode(word);
  const int index = trax_mutant_index(trax_statement_mutants() + trax_arithmetic_mutants(), trax_decoding_mutants());
  if (index < 0)
    return right;
  const decoding *mutant = &mutants[index];
  if (right.op == TRAX_OP_ILLEGAL)
    return accept_wrongly(mutant, word);
  return right.op == mutant->op && mutant->kind != FREE_OPCODE && mutant->kind != FREE_FUNCTION
             ? decode_wrongly(mutant, word, right)
             : right;
}
