/* Statements executed as C17 says. */
#include "semantics.h"

static bool is_signed(enum model_type type) {
  return type == MODEL_S32 || type == MODEL_S64;
}

static unsigned width(enum model_type type) {
  return type == MODEL_S64 || type == MODEL_U64 ? 64 : 32;
}

static uint64_t low(uint64_t value, enum model_type type) {
  return width(type) == 64 ? value : value & UINT32_MAX;
}

/* The number that bits of a signed type mean. */
static int64_t number_of(uint64_t bits, enum model_type type) {
  return width(type) == 64 ? (int64_t)bits : (int64_t)(bits ^ 0x80000000u) - 0x80000000;
}

enum model_type model_common_type(enum model_type a, enum model_type b) {
  if (width(a) == width(b))
    return is_signed(a) ? b : a;
  return width(a) == 64 ? a : b;
}

uint64_t model_convert(uint64_t value, enum model_type from, enum model_type to) {
  return low(is_signed(from) ? (uint64_t)number_of(value, from) : value, to);
}

static bool stopped(const struct model_execution *execution) {
  return execution->fault || execution->undefined;
}

static uint64_t evaluate(struct model_execution *execution, const struct model_node *node);

static uint64_t evaluate_as(struct model_execution *execution, const struct model_node *node, enum model_type type) {
  return model_convert(evaluate(execution, node), node->type, type);
}

static bool is_true(struct model_execution *execution, const struct model_node *node) {
  return evaluate(execution, node) != 0;
}

static uint64_t shift(struct model_execution *execution, const struct model_node *node) {
  const uint64_t value = evaluate(execution, node->child[0]);
  const uint64_t count = evaluate(execution, node->child[1]);
  if (count >= width(node->type))
    execution->undefined = "a shift by the width of the value or more";
  else if (node->operator== MODEL_SHIFT_LEFT && is_signed(node->type))
    execution->undefined = "a left shift of a signed value";
  if (stopped(execution))
    return 0;
  return low(node->operator== MODEL_SHIFT_LEFT ? value << count : value>> count, node->type);
}

static uint64_t arithmetic(struct model_execution *execution, const struct model_node *node) {
  const enum model_type type = node->type;
  const uint64_t a = evaluate_as(execution, node->child[0], type), b = evaluate_as(execution, node->child[1], type);
  const int64_t x = number_of(a, type), y = number_of(b, type);
  const enum model_operator operator= node->operator;
  int64_t exact;
  const bool overflow = operator== MODEL_PLUS    ? __builtin_add_overflow(x, y, &exact)
                        : operator== MODEL_MINUS ? __builtin_sub_overflow(x, y, &exact)
                                                 : __builtin_mul_overflow(x, y, &exact);
  if (is_signed(type) && (overflow || number_of(low((uint64_t)exact, type), type) != exact))
    execution->undefined = "an overflow of signed numbers";
  return low(operator== MODEL_PLUS ? a + b : operator== MODEL_MINUS ? a - b : a * b, type);
}

static bool compare(struct model_execution *execution, const struct model_node *node) {
  const enum model_type type = model_common_type(node->child[0]->type, node->child[1]->type);
  const uint64_t a = evaluate_as(execution, node->child[0], type), b = evaluate_as(execution, node->child[1], type);
  const bool less = is_signed(type) ? number_of(a, type) < number_of(b, type) : a < b;
  switch (node->operator) {
  case MODEL_EQUAL:
    return a == b;
  case MODEL_NOT_EQUAL:
    return a != b;
  case MODEL_LESS:
    return less;
  case MODEL_LESS_EQUAL:
    return less || a == b;
  case MODEL_GREATER:
    return !less && a != b;
  default: /* MODEL_GREATER_EQUAL */
    return !less;
  }
}

static uint64_t binary(struct model_execution *execution, const struct model_node *node) {
  const struct model_node *left = node->child[0], *right = node->child[1];
  switch (node->operator) {
  case MODEL_OR_ELSE:
    return is_true(execution, left) || is_true(execution, right);
  case MODEL_AND_ALSO:
    return is_true(execution, left) && is_true(execution, right);
  case MODEL_OR:
    return evaluate_as(execution, left, node->type) | evaluate_as(execution, right, node->type);
  case MODEL_XOR:
    return evaluate_as(execution, left, node->type) ^ evaluate_as(execution, right, node->type);
  case MODEL_AND:
    return evaluate_as(execution, left, node->type) & evaluate_as(execution, right, node->type);
  case MODEL_SHIFT_LEFT:
  case MODEL_SHIFT_RIGHT:
    return shift(execution, node);
  case MODEL_PLUS:
  case MODEL_MINUS:
  case MODEL_TIMES:
    return arithmetic(execution, node);
  default:
    return compare(execution, node);
  }
}

static uint64_t unary(struct model_execution *execution, const struct model_node *node) {
  const uint64_t value = evaluate(execution, node->child[0]);
  if (node->operator== MODEL_NOT)
    return !value;
  if (node->operator== MODEL_COMPLEMENT)
    return low(~value, node->type);
  if (is_signed(node->type) && number_of(value, node->type) == (width(node->type) == 64 ? INT64_MIN : INT32_MIN))
    execution->undefined = "an overflow of signed numbers";
  return low(0 - value, node->type);
}

static uint64_t call(struct model_execution *execution, const struct model_node *node) {
  uint32_t argument[MODEL_MAX_ARGUMENTS] = {0};
  for (unsigned i = 0; i < node->function->arguments; i++)
    argument[i] = (uint32_t)evaluate_as(execution, node->child[i], MODEL_U32);
  return stopped(execution) ? 0 : node->function->call(execution, argument);
}

static uint64_t evaluate(struct model_execution *execution, const struct model_node *node) {
  switch (node->kind) {
  case MODEL_NUMBER:
    return node->number;
  case MODEL_REGISTER:
    return execution->thread->registers[execution->operand[node->field]];
  case MODEL_IMM:
    return execution->operand[MODEL_FIELD_IMM];
  case MODEL_PC:
    return execution->thread->pc;
  case MODEL_NEXT_PC:
    return execution->next_pc;
  case MODEL_UNARY:
    return unary(execution, node);
  case MODEL_BINARY:
    return binary(execution, node);
  case MODEL_CONDITIONAL:
    return evaluate_as(execution, node->child[is_true(execution, node->child[0]) ? 1 : 2], node->type);
  case MODEL_CAST:
    return evaluate_as(execution, node->child[0], node->type);
  case MODEL_CALL:
    return call(execution, node);
  case MODEL_NAMED:
    return execution->named[node->number];
  default: /* statements have no value */
    return 0;
  }
}

static void assign(struct model_execution *execution, const struct model_node *node) {
  const uint32_t value = (uint32_t)evaluate_as(execution, node->child[1], MODEL_U32);
  if (stopped(execution))
    return;
  if (node->child[0]->kind == MODEL_NEXT_PC)
    execution->next_pc = value;
  else if (execution->operand[MODEL_FIELD_RD] != 0) /* r0 is always zero */
    execution->thread->registers[execution->operand[MODEL_FIELD_RD]] = value;
}

void model_execute(struct model_execution *execution, const struct model_node *statement) {
  if (!statement || stopped(execution))
    return;
  switch (statement->kind) {
  case MODEL_SEQUENCE:
    model_execute(execution, statement->child[0]);
    model_execute(execution, statement->child[1]);
    break;
  case MODEL_IF: {
    const bool condition = is_true(execution, statement->child[0]);
    model_execute(execution, statement->child[condition ? 1 : 2]);
    break;
  }
  case MODEL_NAME:
    execution->named[statement->number] = (uint32_t)evaluate_as(execution, statement->child[0], MODEL_U32);
    break;
  case MODEL_ASSIGN:
    assign(execution, statement);
    break;
  default:
    evaluate(execution, statement);
  }
}
