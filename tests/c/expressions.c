// RUN: %run_c %s %t
// A parser of expressions by precedence climbing, its recursion within 512 bytes of stack, and the postfix code it
// emits.
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *at;
static char code[64], *emitted;
static int failed;

__attribute__((noinline)) static int precedence(int symbol) {
  switch (symbol) {
  case '|':
    return 1;
  case '&':
    return 2;
  case '<':
  case '>':
    return 3;
  case '+':
  case '-':
    return 4;
  case '*':
  case '/':
  case '%':
    return 5;
  }
  return 0;
}

__attribute__((noinline)) static int apply(int symbol, int a, int b) {
  switch (symbol) {
  case '|':
    return a | b;
  case '&':
    return a & b;
  case '<':
    return a < b;
  case '>':
    return a > b;
  case '+':
    return a + b;
  case '-':
    return a - b;
  case '*':
    return a * b;
  }
  if (b == 0) {
    failed = 1;
    return 0;
  }
  return symbol == '/' ? a / b : a % b;
}

__attribute__((noinline)) static int parse(int least) {
  int value;
  while (*at == ' ')
    at++;
  if (*at == '(') {
    at++;
    value = parse(1);
    if (*at++ != ')')
      failed = 1;
  } else if (*at == '-') {
    at++;
    value = -parse(6);
    *emitted++ = '~';
  } else {
    char *end;
    value = (int)strtol(at, &end, 0);
    failed |= end == at;
    for (; at < end; at++)
      *emitted++ = *at;
    *emitted++ = ' ';
  }
  for (;;) {
    while (*at == ' ')
      at++;
    int symbol = *at, binds = precedence(symbol);
    if (binds < least || binds == 0)
      return value;
    at++;
    value = apply(symbol, value, parse(binds + 1));
    *emitted++ = (char)symbol;
  }
}

__attribute__((noinline)) static void evaluate(const char *text) {
  at = text;
  emitted = code;
  failed = 0;
  int value = parse(1);
  *emitted = 0;
  printf("%s: ", code);
  if (failed || *at)
    printf("failed at %d\n", (int)strlen(text) - (int)strlen(at));
  else
    printf("%d\n", value);
}

int main(void) {
  evaluate("1 + 2 * 3 - 4");
  evaluate("(1+2)*-(3 - 0x10)/2");
  evaluate("100 % 7 < 3 & 5 > 4 | 8");
  evaluate("2*(3+(4-1))");
  evaluate("7 / (2 - 2)");
  evaluate("3 + ");
  evaluate("- - 5 2");
  return 0;
}
