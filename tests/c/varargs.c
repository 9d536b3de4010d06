// RUN: %run_c %s %t
// Variable arguments of every class, copied lists, and named arguments that fill all registers before them.
#include <stdarg.h>
#include <stdio.h>

struct point {
  int x, y;
};

__attribute__((noinline)) static int sum(int count, ...) {
  va_list list;
  va_start(list, count);
  int total = 0;
  for (int i = 0; i < count; i++)
    total += va_arg(list, int);
  va_end(list);
  return total;
}

__attribute__((noinline)) static double mixed(const char *types, ...) {
  va_list list, again;
  va_start(list, types);
  va_copy(again, list);
  double total = 0;
  for (; *types; types++)
    switch (*types) {
    case 'i':
      total += va_arg(list, int);
      break;
    case 'l':
      total += (double)va_arg(list, long long);
      break;
    case 'd':
      total += va_arg(list, double);
      break;
    case 'p': {
      struct point p = va_arg(list, struct point);
      total += p.x * 100 + p.y;
      break;
    }
    case 's':
      total += *va_arg(list, const char *);
    }
  va_end(list);
  total += va_arg(again, int) * 1000000;
  va_end(again);
  return total;
}

__attribute__((noinline)) static int many(int a, int b, int c, int d, int e, int f, int g, int h, int i, ...) {
  va_list list;
  va_start(list, i);
  int x = va_arg(list, int), y = va_arg(list, int);
  va_end(list);
  return a + b + c + d + e + f + g + h + i + 100 * x + 1000 * y;
}

int main(void) {
  printf("%d %d %d\n", sum(0), sum(3, 1, 2, 3), sum(10, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
  printf("%.3f\n", mixed("ildps", 1, 1ll << 33, 0.125, (struct point){3, 4}, "A"));
  printf("%d\n", many(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11));
  return 0;
}
