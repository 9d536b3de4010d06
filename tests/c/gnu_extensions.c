// RUN: %run_c %s %t --cflags "-Wno-gnu"
// gcc's extensions that clang has.
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define NOINLINE __attribute__((noinline)) static

NOINLINE int ranges(int c) {
  switch (c) {
  case '0' ... '9':
    return c - '0';
  case 'a' ... 'f':
    return c - 'a' + 10;
  case -1000000 ... - 1:
    return -1;
  default:
    return 99;
  }
}
NOINLINE int statements(int a) {
  return ({
    int square = a * a;
    square > 50 ? square : ({
      int half = square / 2;
      half + 1;
    });
  });
}
struct flexible {
  int count;
  short items[];
};
static struct flexible fixed = {3, {7, 8, 9}};
static int table[10] = {[2 ... 4] = 5, [7] = 6, [0] = -1};
struct tree {
  union {
    struct {
      int x, y;
    };
    int both[2];
  };
  struct tree *next;
};
NOINLINE int labels(const unsigned char *code) { // a table of differences
  static const int offsets[] = {&&push - &&push, &&add - &&push, &&stop - &&push};
  int stack[8], top = 0;
  goto *(&&push + offsets[*code++]);
push:
  stack[top++] = *code++;
  goto *(&&push + offsets[*code++]);
add:
  top--;
  stack[top - 1] += stack[top];
  goto *(&&push + offsets[*code++]);
stop:
  return stack[0];
}
NOINLINE int elvis(int a, int b) {
  return a ?: b;
}
NOINLINE struct tree *linked(struct tree *list, int n) {
  return (&(struct tree){{{n, n + 1}}, list})->x == n ? list : NULL;
}
NOINLINE int variable(int n, int m, int a[n][m]) {
  int sum = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < m; j++)
      sum += a[i][j] * (i + 1);
  return sum + (int)sizeof(int[n][m]);
}
NOINLINE int counts(int n, ...) {
  va_list list, again;
  va_start(list, n);
  va_copy(again, list);
  int sum = 0;
  while (n--)
    sum += va_arg(list, int);
  sum = sum * 1000 + va_arg(again, int);
  va_end(list);
  va_end(again);
  return sum;
}
#define COUNT(...) counts(sizeof((int[]){__VA_ARGS__}) / sizeof(int), __VA_ARGS__)

int main(void) {
  printf("%d %d %d %d\n", ranges('7'), ranges('d'), ranges(-5), ranges(1000));
  printf("%d %d\n", statements(6), statements(9));
  printf("%d %d %d\n", fixed.items[2], (int)sizeof fixed, (int)offsetof(struct flexible, items));
  for (int i = 0; i < 10; i++)
    printf("%d ", table[i]);
  puts("");
  struct tree leaf = {.x = 3, .y = 4};
  printf("%d %d %d\n", leaf.both[0], leaf.y, linked(&leaf, 8) == &leaf);
  printf("%d\n", labels((const unsigned char[]){0, 20, 0, 22, 1, 2}));
  printf("%d %d\n", elvis(0, 5), elvis(6, 5));
  int grid[2][3] = {{1, 2, 3}, {4, 5, 6}};
  printf("%d %d\n", variable(2, 3, grid), COUNT(1, 2, 3, 4));
  typeof(grid[0][0]) swapped = __builtin_choose_expr(sizeof(int) == 4, 10, "text");
  printf("%d %d %d\n", swapped, __builtin_types_compatible_p(int, typeof(swapped)), __alignof__(struct tree) >= 4);
  printf("%d %d\n", 0b1011, ({
           __label__ out;
           int r = 1;
           if (r)
             goto out;
           r = 2;
         out:
           r + 1;
         }));
  return 0;
}
