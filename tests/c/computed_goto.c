// RUN: %run_c %s %t
// Labels as values: a small interpreter.
#include <stdio.h>

__attribute__((noinline)) static int interpret(const unsigned char *code) {
  static const void *const labels[] = {&&push, &&add, &&multiply, &&duplicate, &&end};
  int stack[4], top = 0;
  goto *labels[*code++];
push:
  stack[top++] = *code++;
  goto *labels[*code++];
add:
  top--;
  stack[top - 1] += stack[top];
  goto *labels[*code++];
multiply:
  top--;
  stack[top - 1] *= stack[top];
  goto *labels[*code++];
duplicate:
  stack[top] = stack[top - 1];
  top++;
  goto *labels[*code++];
end:
  return stack[0];
}

int main(void) {
  static const unsigned char code[] = {0, 5, 3, 2, 0, 7, 1, 3, 1, 4};
  printf("%d\n", interpret(code));
  return 0;
}
