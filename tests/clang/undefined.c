// A check of -fsanitize=undefined that fails says which one it is, and where.
// RUN: sh -c 'for check in ADD SUB MUL NEG DIV SHIFT INDEX NULL BOOL FLOAT CONVERT \
// RUN:   UNREACHABLE BUILTIN VLA NONNULL POINTER; do \
// RUN:   %clang -g -O1 -w -fsanitize=undefined,float-cast-overflow,implicit-conversion -mstack=global -DCHECK=$check %s -o %t && \
// RUN:   not %trax_sim %t 2>&1 | FileCheck %s --check-prefix=SAYS-$check || exit 1; done'
#include <limits.h>
#include <stdbool.h>

static volatile int number = INT_MAX, zero;
static int *volatile pointer;
static int array[4];
static unsigned char byte = 7;
static volatile float large = 1e20f;
static int take(unsigned char c) { return c; }
__attribute__((noinline)) static int use(int *v) { return v != 0; }
__attribute__((nonnull, noinline)) static int given(int *p) { return p == array; }

enum { ADD, SUB, MUL, NEG, DIV, SHIFT, INDEX, NULL, BOOL, FLOAT, CONVERT, UNREACHABLE, BUILTIN, VLA, NONNULL, POINTER };

int main(void) {
  switch (CHECK) {
  case ADD: // SAYS-ADD: undefined behaviour: addition overflows
    return number + 1; // SAYS-ADD: undefined.c:[[#@LINE]]
  case SUB: // SAYS-SUB: undefined behaviour: subtraction overflows
    return -2 - number; // SAYS-SUB: undefined.c:[[#@LINE]]
  case MUL: // SAYS-MUL: undefined behaviour: multiplication overflows
    return number * 2; // SAYS-MUL: undefined.c:[[#@LINE]]
  case NEG: // SAYS-NEG: undefined behaviour: negation overflows
    return -(-number - 1); // SAYS-NEG: undefined.c:[[#@LINE]]
  case DIV: // SAYS-DIV: undefined behaviour: division by zero, or it overflows
    return 7 / zero; // SAYS-DIV: undefined.c:[[#@LINE]]
  case SHIFT: // SAYS-SHIFT: undefined behaviour: shift out of range
    return 1 << number; // SAYS-SHIFT: undefined.c:[[#@LINE]]
  case INDEX: // SAYS-INDEX: undefined behaviour: index out of bounds
    return array[number]; // SAYS-INDEX: undefined.c:[[#@LINE]]
  case NULL: // SAYS-NULL: undefined behaviour: access by a null or misaligned pointer, or beyond its object
    return *pointer; // SAYS-NULL: undefined.c:[[#@LINE]]
  case BOOL: // SAYS-BOOL: undefined behaviour: load of a value that its type does not have
    return *(bool *)&byte; // SAYS-BOOL: undefined.c:[[#@LINE]]
  case FLOAT: // SAYS-FLOAT: undefined behaviour: conversion from floating point overflows
    return (int)large; // SAYS-FLOAT: undefined.c:[[#@LINE]]
  case CONVERT: // SAYS-CONVERT: undefined behaviour: implicit conversion changes the value
    return take(number); // SAYS-CONVERT: undefined.c:[[#@LINE]]
  case UNREACHABLE: // SAYS-UNREACHABLE: undefined behaviour: unreachable code is reached
    __builtin_unreachable(); // SAYS-UNREACHABLE: undefined.c:[[#@LINE]]
  case BUILTIN: // SAYS-BUILTIN: undefined behaviour: invalid argument of a builtin
    return __builtin_ctz(zero); // SAYS-BUILTIN: undefined.c:[[#@LINE]]
  case VLA: // SAYS-VLA: undefined behaviour: array of variable length has no length
    { int v[zero]; return use(v); } // SAYS-VLA: undefined.c:[[#@LINE]]
  case NONNULL: // SAYS-NONNULL: undefined behaviour: null argument where none may be
    return given(pointer); // SAYS-NONNULL: undefined.c:[[#@LINE]]
  case POINTER: // SAYS-POINTER: undefined behaviour: pointer arithmetic overflows
    return (pointer + 1 == array) + (int)((char *)-4 + number); // SAYS-POINTER: undefined.c:[[#@LINE]]
  }
  return 0;
}
