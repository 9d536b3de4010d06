/* The TP ISA as C tables: decoding, encoding, disassembly. Generated from isa/TraxInstructions.td by trax-isa-gen. */
#ifndef TRAX_ISA_H
#define TRAX_ISA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum trax_op {
  TRAX_OP_ILLEGAL = 0,
#define TRAX_INSTRUCTION(NAME, ...) TRAX_OP_##NAME,
#include "trax/instructions.inc"
#undef TRAX_INSTRUCTION
  TRAX_OP_COUNT
} trax_op;

typedef enum trax_unit {
#define TRAX_UNIT(NAME, DESCRIPTION, LATENCY) TRAX_UNIT_##NAME,
#include "trax/units.inc"
#undef TRAX_UNIT
  TRAX_UNIT_COUNT
} trax_unit;

typedef enum trax_format {
  TRAX_FORMAT_R,
  TRAX_FORMAT_R1,
  TRAX_FORMAT_I,
  TRAX_FORMAT_SH,
  TRAX_FORMAT_U,
  TRAX_FORMAT_S,
  TRAX_FORMAT_B,
  TRAX_FORMAT_J,
  TRAX_FORMAT_T,
  TRAX_FORMAT_F,
  TRAX_FORMAT_N
} trax_format;

enum {
  TRAX_READS_RA = 1u << 0,
  TRAX_READS_RB = 1u << 1,
  TRAX_READS_RD = 1u << 2, /* conditional moves */
  TRAX_WRITES_RD = 1u << 3,
  TRAX_IS_LOAD = 1u << 4,  /* ainc too */
  TRAX_IS_STORE = 1u << 5, /* not ainc */
  TRAX_IS_ATOMIC = 1u << 6,
  TRAX_IS_NONTEMPORAL = 1u << 7,
  TRAX_IS_BRANCH = 1u << 8,      /* conditional branches, jal, jalr */
  TRAX_IS_RELATIVE = 1u << 9,    /* of those, the ones that go to pc + imm: all but jalr */
  TRAX_IS_FLOP = 1u << 10,       /* counts in GFLOPS: adds and multiplies (paper, Table 1) */
  TRAX_IS_COMPARE = 1u << 11,    /* floating-point comparison, minimum, maximum */
  TRAX_IS_CONVERSION = 1u << 12, /* between integers and floats */
  TRAX_IS_ROOT = 1u << 13        /* reciprocal square root */
};

/* How many registers an instruction reads from ra and rb on, in its flags: r31 is followed by r0, r1 and so on. */
#define TRAX_GROUP_A(COUNT) (((COUNT) - 1u) << 16)
#define TRAX_GROUP_B(COUNT) (((COUNT) - 1u) << 20)
static inline unsigned trax_group_a(unsigned flags) {
  return flags & TRAX_READS_RA ? (flags >> 16 & 15) + 1 : 0;
}
static inline unsigned trax_group_b(unsigned flags) {
  return flags & TRAX_READS_RB ? (flags >> 20 & 15) + 1 : 0;
}

/* The flags of each instruction as constants: TRAX_FLAGS_ADD. */
enum {
#define TRAX_INSTRUCTION(NAME, MNEMONIC, SYNTAX, FORMAT, UNIT, MASK, MATCH, FLAGS, BYTES) TRAX_FLAGS_##NAME = FLAGS,
#include "trax/instructions.inc"
#undef TRAX_INSTRUCTION
};

typedef struct trax_op_info {
  const char *name;     /* "ADD" */
  const char *mnemonic; /* "add"; "illegal" for TRAX_OP_ILLEGAL */
  const char *syntax;   /* operands in assembler order: d, a, b registers; i u immediates; p target; s t f names */
  trax_format format;
  trax_unit unit;
  uint32_t mask;  /* bits that are fixed */
  uint32_t match; /* and their values */
  unsigned flags; /* TRAX_READS_RA | ... */
  unsigned access_bytes;
} trax_op_info;

extern const trax_op_info trax_op_table[TRAX_OP_COUNT];
extern const unsigned trax_unit_latency[TRAX_UNIT_COUNT];  /* cycles; the machine's defaults */
extern const char *const trax_unit_names[TRAX_UNIT_COUNT]; /* "FP_ADD" */

/* A decoded instruction. imm is sign extended where the operand is signed, in bytes for branches and jumps. Fields that
   the format lacks are 0. */
typedef struct trax_inst {
  trax_op op;
  uint8_t rd, ra, rb;
  int32_t imm;
} trax_inst;

/* Total: every word gives one instruction or TRAX_OP_ILLEGAL. */
trax_inst trax_decode(uint32_t word);
/* The inverse, for legal instructions with operands in range. */
uint32_t trax_encode(trax_inst inst);
/* Assembler syntax; branch targets as absolute addresses given pc. Returns what snprintf would. */
int trax_disassemble(uint32_t word, uint32_t pc, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
