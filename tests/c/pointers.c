// RUN: %run_c %s %t
// Pointer arithmetic, differences, arrays of arrays, pointers to pointers, and addresses of locals.
#include <stddef.h>
#include <stdio.h>

static int grid[4][5];
struct link {
  struct link *next;
  int value;
};

__attribute__((noinline)) static void exchange(int *a, int *b) {
  int t = *a;
  *a = *b;
  *b = t;
}
__attribute__((noinline)) static void reverse(struct link **list) {
  struct link *done = NULL;
  while (*list) {
    struct link *next = (*list)->next;
    (*list)->next = done;
    done = *list;
    *list = next;
  }
  *list = done;
}

int main(void) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 5; j++)
      grid[i][j] = i * 10 + j;
  int(*row)[5] = &grid[1], *p = &grid[2][3];
  printf("%d %d %d %d\n", (*row)[2], row[1][0], p[-4], (int)(p - &grid[0][0]));
  int a = 1, b = 2, *q = &a;
  exchange(&a, &b);
  exchange(q, p);
  printf("%d %d %d\n", a, b, *p);
  struct link nodes[3] = {{&nodes[1], 1}, {&nodes[2], 2}, {NULL, 3}}, *list = nodes;
  reverse(&list);
  printf("%d%d%d %d\n", list->value, list->next->value, list->next->next->value, (int)offsetof(struct link, value) > 0);
  return 0;
}
