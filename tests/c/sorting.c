// RUN: %run_c %s %t
// qsort and bsearch with elements of several sizes.
#include <stdio.h>
#include <stdlib.h>

struct record {
  short key;
  char tag[3];
};

static int ints[100];
static struct record records[30];
static double doubles[10];

static int compare_ints(const void *a, const void *b) {
  int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
}
static int compare_records(const void *a, const void *b) {
  return ((const struct record *)a)->key - ((const struct record *)b)->key;
}
static int compare_doubles(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x < y) - (x > y);
}

int main(void) {
  unsigned x = 1;
  for (int i = 0; i < 100; i++)
    ints[i] = (int)(x = x * 1664525 + 1013904223) >> 8;
  qsort(ints, 100, sizeof ints[0], compare_ints);
  int ordered = 1;
  for (int i = 1; i < 100; i++)
    ordered &= ints[i - 1] <= ints[i];
  printf("%d %d %d\n", ordered, ints[0], ints[99]);
  for (int i = 0; i < 30; i++)
    records[i] = (struct record){(short)(i * 17 % 30), {(char)('a' + i * 17 % 30 % 26), '!', 0}};
  qsort(records, 30, sizeof records[0], compare_records);
  for (int i = 0; i < 30; i++)
    printf("%d%s ", records[i].key, records[i].tag);
  for (int i = 0; i < 10; i++)
    doubles[i] = (i * 7 % 10) * 0.5;
  qsort(doubles, 10, sizeof doubles[0], compare_doubles);
  printf("\n%g %g\n", doubles[0], doubles[9]);
  int key = ints[37], missing = 12345;
  printf("%d %d\n", (int)((int *)bsearch(&key, ints, 100, sizeof(int), compare_ints) - ints),
         bsearch(&missing, ints, 100, sizeof(int), compare_ints) == NULL);
  return 0;
}
