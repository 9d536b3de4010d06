// RUN: %run_c %s %t
// Designated initialisers, compound literals, flexible array members, strings with escapes, and members left zero.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct node {
  int value;
  const struct node *next;
};
struct packet {
  unsigned char kind, length;
  unsigned short payload[];
};

enum { RED = 2, GREEN, BLUE = -5, ALPHA, COUNT = 8 };
static const char *const colours[COUNT] = {
    [RED] = "red", [GREEN] = "green", [BLUE + 10] = "blue", [ALPHA + 10] = "alpha"};
static int matrix[3][4] = {[1] = {[2] = 7, 8}, [0][1] = 5, [2][0] = 1};
static const struct node *list = &(struct node){1, &(struct node){2, &(struct node){3, NULL}}};
static unsigned char pixel[][3] = {{1, 2, 3}, {4}, [3] = {5, 6, 7}};
static const char escapes[] = "\x41\102\t\\\"\?\0after";
static const unsigned short wide[] = u"z\u00e9\u4e2d";

__attribute__((noinline)) static int sum(const int *v, int n) {
  int total = 0;
  while (n--)
    total = total * 10 + *v++;
  return total;
}
__attribute__((noinline)) static int total(struct node n) {
  return n.next ? n.value + total(*n.next) : n.value;
}

__attribute__((noinline)) static void literals(int x) {
  printf("%d %d\n", sum((int[]){x, x + 1, x + 2}, 3), sum((int[5]){[1] = x, [4] = 9}, 5));
  int *p = (int[]){x, 4};
  for (int i = 0; i < 3; i++) {
    int *q = &(int){i}; /* one object, initialised anew in each round */
    p[0] += *q;
    *q = 100;
  }
  printf("%d %d\n", p[0], total((struct node){x, list}));
}

__attribute__((noinline)) static struct packet *make(int n) {
  struct packet *p = malloc(sizeof *p + (size_t)n * sizeof p->payload[0]);
  *p = (struct packet){.kind = 9, .length = (unsigned char)n};
  for (int i = 0; i < n; i++)
    p->payload[i] = (unsigned short)(i * 10000);
  return p;
}

int main(void) {
  for (int i = 0; i < COUNT; i++)
    printf("%s ", colours[i] ? colours[i] : "-");
  puts("");
  for (int i = 0; i < 12; i++)
    printf("%d", matrix[i / 4][i % 4]);
  printf(" %d %d %d\n", (int)sizeof pixel, pixel[1][1], pixel[3][2]);
  printf("%s %d %s %x %x %d\n", escapes, (int)sizeof escapes, escapes + 8, wide[1], wide[2], (int)sizeof wide);
  literals(3);
  struct packet *p = make(7);
  printf("%d %d %d %d\n", p->kind, p->length, p->payload[6], (int)sizeof *p);
  free(p);
  return 0;
}
