/* Statements of the manual to trees: recursive descent, a level of precedence at a time. */
#include "semantics.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_DEPTH = 64 };

struct parser {
  const struct model_instruction *instruction;
  const char *name;
  unsigned line, column; /* of begin */
  const char *begin, *at, *end;
  const char *token; /* the current one: [token, at) */
  unsigned depth;
  struct {
    const char *name;
    size_t length;
  } named[MODEL_MOST_NAMES];
  unsigned names;
  struct model_error *error; /* set: parsing has failed */
  bool failed;
};

static struct model_node *fail(struct parser *parser, const char *place, const char *reason, const char *word,
                               size_t length) {
  if (!parser->failed)
    model_fail(parser->error, "%s:%u:%u: %s: %s%s%.*s%s", parser->name, parser->line,
               parser->column + (unsigned)(place - parser->begin), parser->instruction->mnemonic, reason,
               word ? " '" : "", (int)length, word ? word : "", word ? "'" : "");
  parser->failed = true;
  return NULL;
}

static struct model_node *fail_token(struct parser *parser, const char *reason) {
  const size_t length = (size_t)(parser->at - parser->token);
  return length ? fail(parser, parser->token, reason, parser->token, length)
                : fail(parser, parser->token, reason, "the end", strlen("the end"));
}

static bool is_word(char c) {
  return isalnum((unsigned char)c) || c == '_';
}

static void next(struct parser *parser) {
  static const char *const pairs[] = {"<<", ">>", "<=", ">=", "==", "!=", "&&", "||"};
  while (parser->at < parser->end && isspace((unsigned char)*parser->at))
    parser->at++;
  parser->token = parser->at;
  if (parser->at == parser->end)
    return;
  if (is_word(*parser->at)) {
    while (parser->at < parser->end && is_word(*parser->at))
      parser->at++;
    return;
  }
  parser->at++;
  for (size_t i = 0; i < sizeof pairs / sizeof *pairs && parser->at < parser->end; i++)
    if (memcmp(parser->token, pairs[i], 2) == 0) {
      parser->at++;
      return;
    }
}

static bool is(const struct parser *parser, const char *token) {
  return (size_t)(parser->at - parser->token) == strlen(token) && memcmp(parser->token, token, strlen(token)) == 0;
}

static bool accept(struct parser *parser, const char *token) {
  if (parser->failed || !is(parser, token))
    return false;
  next(parser);
  return true;
}

static void expect(struct parser *parser, const char *token) {
  char reason[32];
  snprintf(reason, sizeof reason, "expected '%s' before", token);
  if (!accept(parser, token))
    fail_token(parser, reason);
}

void model_node_free(struct model_node *node) {
  if (!node)
    return;
  for (size_t i = 0; i < 3; i++)
    model_node_free(node->child[i]);
  free(node);
}

/* Takes the children, even when it fails. */
static struct model_node *make(struct parser *parser, struct model_node node) {
  struct model_node *made = parser->failed ? NULL : malloc(sizeof *made);
  if (made) {
    *made = node;
    return made;
  }
  for (size_t i = 0; i < 3; i++)
    model_node_free(node.child[i]);
  return fail(parser, parser->token, "out of memory", NULL, 0);
}

static struct model_node *expression(struct parser *parser);

/* Enters a rule that calls itself; leave follows. */
static bool enter(struct parser *parser) {
  if (++parser->depth > MOST_DEPTH)
    fail(parser, parser->token, "nested too deeply", NULL, 0);
  return !parser->failed;
}

static struct model_node *leave(struct parser *parser, struct model_node *node) {
  parser->depth--;
  return node;
}

static bool needs_value(struct parser *parser, const char *place, const struct model_node *node) {
  if (node && node->type == MODEL_VOID)
    fail(parser, place, "a value is needed here", NULL, 0);
  return !parser->failed;
}

static struct model_node *number(struct parser *parser) {
  char digits[32] = "", *rest;
  const size_t length = (size_t)(parser->at - parser->token);
  if (length < sizeof digits)
    memcpy(digits, parser->token, length);
  const unsigned long long value = strtoull(digits, &rest, 0);
  enum model_type type = value <= INT32_MAX ? MODEL_S32 : MODEL_U32;
  if ((*rest == 'u' || *rest == 'U') && rest[1] == 0) {
    type = MODEL_U32;
    rest++;
  }
  if (!*digits || *rest || value > UINT32_MAX)
    return fail_token(parser, "not a number of 32 bits:");
  next(parser);
  return make(parser, (struct model_node){.kind = MODEL_NUMBER, .type = type, .number = value});
}

static struct model_node *call(struct parser *parser, const struct model_function *function) {
  struct model_node node = {.kind = MODEL_CALL, .type = function->result, .function = function};
  next(parser);
  expect(parser, "(");
  for (unsigned i = 0; i < function->arguments && !parser->failed; i++) {
    if (i)
      expect(parser, ",");
    const char *place = parser->token;
    node.child[i] = expression(parser);
    needs_value(parser, place, node.child[i]);
  }
  expect(parser, ")");
  return make(parser, node);
}

static struct model_node *word(struct parser *parser) {
  static const struct {
    const char *name;
    struct model_node node;
  } names[] = {{"RD", {.kind = MODEL_REGISTER, .field = MODEL_FIELD_RD}},
               {"RA", {.kind = MODEL_REGISTER, .field = MODEL_FIELD_RA}},
               {"RB", {.kind = MODEL_REGISTER, .field = MODEL_FIELD_RB}},
               {"IMM", {.kind = MODEL_IMM, .field = MODEL_FIELD_IMM}},
               {"PC", {.kind = MODEL_PC}},
               {"NEXT_PC", {.kind = MODEL_NEXT_PC}}};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    if (!is(parser, names[i].name))
      continue;
    struct model_node node = names[i].node;
    node.type = MODEL_U32;
    if (node.kind <= MODEL_IMM && parser->instruction->field[node.field].width == 0)
      return fail_token(parser, "the encoding has no field for");
    next(parser);
    return make(parser, node);
  }
  for (unsigned i = 0; i < parser->names; i++)
    if (parser->named[i].length == (size_t)(parser->at - parser->token) &&
        memcmp(parser->token, parser->named[i].name, parser->named[i].length) == 0) {
      next(parser);
      return make(parser, (struct model_node){.kind = MODEL_NAMED, .type = MODEL_U32, .number = i});
    }
  const struct model_function *function = model_find_function(parser->token, (size_t)(parser->at - parser->token));
  return function ? call(parser, function) : fail_token(parser, "unknown word");
}

static bool type_name(struct parser *parser, enum model_type *type) {
  static const struct {
    const char *name;
    enum model_type type;
  } types[] = {{"uint32_t", MODEL_U32}, {"int32_t", MODEL_S32}, {"uint64_t", MODEL_U64}, {"int64_t", MODEL_S64}};
  for (size_t i = 0; i < sizeof types / sizeof *types; i++)
    if (accept(parser, types[i].name)) {
      *type = types[i].type;
      return true;
    }
  return false;
}

static struct model_node *unary(struct parser *parser);

static struct model_node *prefixed(struct parser *parser) {
  static const struct {
    const char *token;
    enum model_operator operator;
  } operators[] = {{"-", MODEL_NEGATE}, {"~", MODEL_COMPLEMENT}, {"!", MODEL_NOT}};
  for (size_t i = 0; i < sizeof operators / sizeof *operators; i++)
    if (accept(parser, operators[i].token)) {
      const char *place = parser->token;
      struct model_node *operand = unary(parser);
      if (!needs_value(parser, place, operand))
        return model_node_free(operand), NULL;
      const enum model_type type = operators[i].operator== MODEL_NOT ? MODEL_S32 : operand->type;
      return make(parser, (struct model_node){.kind = MODEL_UNARY,
                                              .type = type,
                                              .operator = operators[i].operator,
                                              .child = {operand}});
    }
  if (accept(parser, "(")) {
    enum model_type type;
    const bool is_cast = type_name(parser, &type);
    struct model_node *inside = is_cast ? NULL : expression(parser);
    expect(parser, ")");
    if (!is_cast)
      return inside;
    const char *place = parser->token;
    inside = unary(parser);
    needs_value(parser, place, inside);
    return make(parser, (struct model_node){.kind = MODEL_CAST, .type = type, .child = {inside}});
  }
  if (parser->token < parser->end && isdigit((unsigned char)*parser->token))
    return number(parser);
  if (parser->token < parser->end && is_word(*parser->token))
    return word(parser);
  return fail_token(parser, "expected a value before");
}

static struct model_node *unary(struct parser *parser) {
  return leave(parser, enter(parser) ? prefixed(parser) : NULL);
}

/* Loosest first. */
static const struct {
  const char *token;
  unsigned level;
  enum model_operator operator;
} binary_operators[] = {{"||", 1, MODEL_OR_ELSE},
                        {"&&", 2, MODEL_AND_ALSO},
                        {"|", 3, MODEL_OR},
                        {"^", 4, MODEL_XOR},
                        {"&", 5, MODEL_AND},
                        {"==", 6, MODEL_EQUAL},
                        {"!=", 6, MODEL_NOT_EQUAL},
                        {"<", 7, MODEL_LESS},
                        {"<=", 7, MODEL_LESS_EQUAL},
                        {">", 7, MODEL_GREATER},
                        {">=", 7, MODEL_GREATER_EQUAL},
                        {"<<", 8, MODEL_SHIFT_LEFT},
                        {">>", 8, MODEL_SHIFT_RIGHT},
                        {"+", 9, MODEL_PLUS},
                        {"-", 9, MODEL_MINUS},
                        {"*", 10, MODEL_TIMES}};
enum { BINARY_OPERATORS = sizeof binary_operators / sizeof *binary_operators, TIGHTEST = 10 };

static struct model_node *combine(struct parser *parser, enum model_operator operator, const char * place,
                                  struct model_node *left, struct model_node *right) {
  enum model_type type = MODEL_S32; /* of comparisons */
  if (operator== MODEL_SHIFT_LEFT || operator== MODEL_SHIFT_RIGHT)
    type = left->type;
  else if (operator>= MODEL_PLUS || operator== MODEL_OR || operator== MODEL_XOR || operator== MODEL_AND)
    type = model_common_type(left->type, right->type);
  if (operator== MODEL_SHIFT_RIGHT &&(type == MODEL_S32 || type == MODEL_S64))
    fail(parser, place, "what the right shift of a signed value gives depends on the compiler", NULL, 0);
  return make(parser, (struct model_node){.kind = MODEL_BINARY,
                                          .type = type,
                                          .operator = operator,
                                          .child = {left, right}});
}

static struct model_node *binary(struct parser *parser, unsigned level) {
  if (level > TIGHTEST)
    return unary(parser);
  const char *left_place = parser->token;
  struct model_node *left = binary(parser, level + 1);
  for (size_t i = 0; i < BINARY_OPERATORS; i++) {
    const char *place = parser->token;
    if (binary_operators[i].level != level || !accept(parser, binary_operators[i].token))
      continue;
    const char *right_place = parser->token;
    struct model_node *right = binary(parser, level + 1);
    if (!needs_value(parser, left_place, left) || !needs_value(parser, right_place, right)) {
      model_node_free(left);
      model_node_free(right);
      return NULL;
    }
    left = combine(parser, binary_operators[i].operator, place, left, right);
    i = (size_t)-1; /* left-associative: look for another one of this level */
  }
  return left;
}

static struct model_node *conditional(struct parser *parser) {
  struct model_node node = {.kind = MODEL_CONDITIONAL};
  const char *place = parser->token;
  node.child[0] = binary(parser, 1);
  if (!accept(parser, "?"))
    return node.child[0];
  needs_value(parser, place, node.child[0]);
  const char *first = parser->token;
  node.child[1] = expression(parser);
  expect(parser, ":");
  const char *second = parser->token;
  node.child[2] = conditional(parser);
  if (needs_value(parser, first, node.child[1]) && needs_value(parser, second, node.child[2]))
    node.type = model_common_type(node.child[1]->type, node.child[2]->type);
  return make(parser, node);
}

static struct model_node *expression(struct parser *parser) {
  return leave(parser, enter(parser) ? conditional(parser) : NULL);
}

static struct model_node *statements(struct parser *parser, const char *until);

static struct model_node *statement(struct parser *parser);

/* A name that no function and no other value has. */
static struct model_node *name(struct parser *parser) {
  struct model_node node = {.kind = MODEL_NAME, .number = parser->names};
  const char *begin = parser->token;
  const size_t length = (size_t)(parser->at - begin);
  if (parser->names == MODEL_MOST_NAMES)
    return fail_token(parser, "too many names before");
  if (length == 0 || !is_word(*begin) || isdigit((unsigned char)*begin))
    return fail_token(parser, "expected a name before");
  next(parser);
  expect(parser, "=");
  const char *place = parser->token;
  node.child[0] = expression(parser);
  needs_value(parser, place, node.child[0]);
  expect(parser, ";");
  parser->named[parser->names].name = begin;
  parser->named[parser->names++].length = length;
  return make(parser, node);
}

static struct model_node *one_statement(struct parser *parser) {
  struct model_node node = {0};
  if (accept(parser, "{"))
    return statements(parser, "}");
  if (accept(parser, "if")) {
    node.kind = MODEL_IF;
    expect(parser, "(");
    const char *place = parser->token;
    node.child[0] = expression(parser);
    needs_value(parser, place, node.child[0]);
    expect(parser, ")");
    if (!parser->failed)
      node.child[1] = statement(parser);
    if (accept(parser, "else"))
      node.child[2] = statement(parser);
    return make(parser, node);
  }
  if (accept(parser, "uint32_t"))
    return name(parser);
  const char *place = parser->token;
  struct model_node *left = expression(parser);
  if (accept(parser, "=")) {
    if (!(left->kind == MODEL_NEXT_PC || (left->kind == MODEL_REGISTER && left->field == MODEL_FIELD_RD)))
      fail(parser, place, "only RD and NEXT_PC can be assigned to", NULL, 0);
    node = (struct model_node){.kind = MODEL_ASSIGN, .child = {left}};
    place = parser->token;
    node.child[1] = expression(parser);
    needs_value(parser, place, node.child[1]);
    left = make(parser, node);
  } else if (left && (left->kind != MODEL_CALL || left->type != MODEL_VOID))
    fail(parser, place, "a value that is not used", NULL, 0);
  expect(parser, ";");
  return left;
}

static struct model_node *statement(struct parser *parser) {
  return leave(parser, enter(parser) ? one_statement(parser) : NULL);
}

static struct model_node *statements(struct parser *parser, const char *until) {
  struct model_node *all = NULL;
  while (!parser->failed && !is(parser, until)) {
    struct model_node *one = statement(parser);
    all = make(parser, (struct model_node){.kind = MODEL_SEQUENCE, .child = {all, one}});
  }
  if (*until)
    expect(parser, until);
  return all;
}

struct model_node *model_parse(const struct model_instruction *instruction, const char *name, unsigned line,
                               unsigned column, const char *text, const char *end, struct model_error *error) {
  struct parser parser = {.instruction = instruction,
                          .name = name,
                          .line = line,
                          .column = column,
                          .begin = text,
                          .at = text,
                          .end = end,
                          .error = error};
  next(&parser);
  if (parser.token == end)
    return fail(&parser, text, "no statement", NULL, 0);
  struct model_node *all = statements(&parser, "");
  if (parser.failed) {
    model_node_free(all);
    return NULL;
  }
  return all;
}
