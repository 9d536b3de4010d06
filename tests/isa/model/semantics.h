/* The language of the manual's semantics: a C statement over RD, RA, RB, IMM, PC and NEXT_PC, and values that it names
   itself (uint32_t x = ...;). Operators have C's precedence, conversions and types (32 and 64 bits, signed and
   unsigned); what C leaves undefined or to the implementation is an error. */
#ifndef TRAX_ISA_MODEL_SEMANTICS_H
#define TRAX_ISA_MODEL_SEMANTICS_H

#include "model.h"

enum { MODEL_MOST_NAMES = 32 };

/* One instruction of one thread, as it is executed. */
struct model_execution {
  struct model_machine *machine;
  struct model_thread *thread;
  const struct model_instruction *instruction;
  uint32_t operand[MODEL_FIELDS]; /* register numbers; IMM's value */
  uint32_t next_pc;
  uint32_t named[MODEL_MOST_NAMES]; /* values, in the order of their statements */
  enum model_fault_kind fault;      /* the rest of the statement does not happen */
  uint32_t fault_address;
  const char *undefined; /* why the statement has no defined result */
};

/* --- functions that a statement may call: functions.c --- */

enum model_type { MODEL_VOID, MODEL_S32, MODEL_U32, MODEL_S64, MODEL_U64 };

struct model_function {
  const char *name;
  unsigned arguments; /* converted to uint32_t */
  enum model_type result;
  uint32_t (*call)(struct model_execution *execution, const uint32_t *argument);
};
enum { MODEL_MAX_ARGUMENTS = 2 };

const struct model_function *model_find_function(const char *name, size_t length);

/* --- trees: parse.c, evaluate.c --- */

enum model_operator { /* of MODEL_BINARY and MODEL_UNARY */
                      MODEL_OR_ELSE,
                      MODEL_AND_ALSO,
                      MODEL_OR,
                      MODEL_XOR,
                      MODEL_AND,
                      MODEL_EQUAL,
                      MODEL_NOT_EQUAL,
                      MODEL_LESS,
                      MODEL_LESS_EQUAL,
                      MODEL_GREATER,
                      MODEL_GREATER_EQUAL,
                      MODEL_SHIFT_LEFT,
                      MODEL_SHIFT_RIGHT,
                      MODEL_PLUS,
                      MODEL_MINUS,
                      MODEL_TIMES,
                      MODEL_NEGATE,
                      MODEL_COMPLEMENT,
                      MODEL_NOT
};

enum model_node_kind {
  MODEL_NUMBER,
  MODEL_REGISTER, /* RD, RA or RB: the register's value */
  MODEL_IMM,
  MODEL_PC,
  MODEL_NEXT_PC,
  MODEL_UNARY,
  MODEL_BINARY,
  MODEL_CONDITIONAL,
  MODEL_CAST,
  MODEL_CALL,
  MODEL_NAMED, /* number: which */
  /* statements */
  MODEL_ASSIGN, /* child[0] is MODEL_REGISTER (RD) or MODEL_NEXT_PC */
  MODEL_NAME,   /* number: which; child[0]: its value */
  MODEL_IF,     /* child[2] may be NULL */
  MODEL_SEQUENCE
};

struct model_node {
  enum model_node_kind kind;
  enum model_type type;
  enum model_operator operator;
  enum model_field field; /* of MODEL_REGISTER */
  uint64_t number;
  const struct model_function *function;
  struct model_node *child[3];
};

/* Parses the statements from text to end for an instruction whose fields are known. The text begins at line and column
   of the manual called name. */
struct model_node *model_parse(const struct model_instruction *instruction, const char *name, unsigned line,
                               unsigned column, const char *text, const char *end, struct model_error *error);
void model_node_free(struct model_node *node);

void model_execute(struct model_execution *execution, const struct model_node *statement);

/* The type of both operands of an operator, and their values in it (C17, 6.3.1.8). Values are kept in the low bits of
   64, the rest zero. */
enum model_type model_common_type(enum model_type a, enum model_type b);
uint64_t model_convert(uint64_t value, enum model_type from, enum model_type to);

#endif
