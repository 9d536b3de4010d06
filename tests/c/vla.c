// RUN: %run_c %s %t
// Arrays of variable length and alloca, released at the end of their scope.
#include <alloca.h>
#include <stdio.h>

__attribute__((noinline)) static int sum_of_squares(int n) {
  int v[n], sum = 0;
  for (int i = 0; i < n; i++)
    v[i] = i * i;
  for (int i = n; i-- > 0;)
    sum += v[i];
  return sum + (int)sizeof v;
}

__attribute__((noinline)) static unsigned blocks(int n) {
  unsigned hash = 0;
  for (int i = 1; i <= n; i++) { /* n arrays of up to 40 bytes at one place */
    char block[i];
    for (int j = 0; j < i; j++)
      block[j] = (char)(i + j);
    hash = hash * 31 + (unsigned)block[i - 1];
  }
  return hash;
}

__attribute__((noinline)) static int list(int n) {
  struct node {
    struct node *next;
    int value;
  } *head = NULL;
  for (int i = 0; i < n; i++) {
    struct node *node = alloca(sizeof *node);
    node->next = head;
    node->value = i;
    head = node;
  }
  int sum = 0;
  for (int weight = 1; head; head = head->next, weight++)
    sum += weight * head->value;
  return sum;
}

int main(void) {
  printf("%d %d %x %d\n", sum_of_squares(5), sum_of_squares(10), blocks(40), list(8));
  return 0;
}
