/* A stack machine's interpreter, which counts primes. */
#include "../bench.h"

enum operation { PUSH, LOAD, STORE, ADD, SUBTRACT, MULTIPLY, LESS, EQUAL, JUMP, JUMP_IF_ZERO, MASK, STOP };
struct instruction {
  unsigned char operation;
  short operand;
};

/* 0: candidate, 1: divisor, 2: multiple, 3: count. Candidates below 200; a divisor's multiples are added up. */
static const struct instruction program[] = {
    {PUSH, 2}, {STORE, 0},                                              /*  0 */
    {LOAD, 0}, {PUSH, 200}, {LESS, 0},  {JUMP_IF_ZERO, 37},             /*  2: next candidate */
    {PUSH, 2}, {STORE, 1},                                              /*  6 */
    {LOAD, 1}, {LOAD, 0},   {LESS, 0},  {JUMP_IF_ZERO, 28},             /*  8: next divisor */
    {LOAD, 1}, {STORE, 2},                                              /* 12 */
    {LOAD, 2}, {LOAD, 0},   {LESS, 0},  {JUMP_IF_ZERO, 23},             /* 14: next multiple */
    {LOAD, 2}, {LOAD, 1},   {ADD, 0},   {STORE, 2},         {JUMP, 14}, /* 18 */
    {LOAD, 2}, {LOAD, 0},   {EQUAL, 0}, {JUMP_IF_ZERO, 38}, {JUMP, 32}, /* 23: a divisor? */
    {LOAD, 3}, {PUSH, 1},   {ADD, 0},   {STORE, 3},                     /* 28: prime */
    {LOAD, 0}, {PUSH, 1},   {ADD, 0},   {STORE, 0},         {JUMP, 2},  /* 32 */
    {STOP, 0},                                                          /* 37 */
    {LOAD, 1}, {PUSH, 1},   {ADD, 0},   {STORE, 1},         {JUMP, 8},  /* 38 */
};

static int stack[16], variables[4];

void kernel_setup(void) {}

static int interpret(const struct instruction *code) {
  int *top = stack, executed = 0;
  for (;; executed++) {
    int operand = code->operand;
    switch ((enum operation)(code++)->operation) {
    case PUSH:
      *top++ = operand;
      break;
    case LOAD:
      *top++ = variables[operand];
      break;
    case STORE:
      variables[operand] = *--top;
      break;
    case ADD:
      top--, top[-1] += *top;
      break;
    case SUBTRACT:
      top--, top[-1] -= *top;
      break;
    case MULTIPLY:
      top--, top[-1] *= *top;
      break;
    case LESS:
      top--, top[-1] = top[-1] < *top;
      break;
    case EQUAL:
      top--, top[-1] = top[-1] == *top;
      break;
    case MASK:
      top[-1] &= operand;
      break;
    case JUMP:
      code = program + operand;
      break;
    case JUMP_IF_ZERO:
      if (*--top == 0)
        code = program + operand;
      break;
    case STOP:
      return executed;
    }
  }
}

struct result kernel_run(void) {
  for (int i = 0; i < 4; i++)
    variables[i] = 0;
  uint32_t executed = (uint32_t)interpret(program);
  return (struct result){mix(executed, (uint32_t)variables[3]), 0};
}
