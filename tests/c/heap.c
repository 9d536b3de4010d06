// RUN: %run_c %s %t
// malloc, realloc, calloc and free.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct node {
  struct node *left, *right;
  int key;
};

__attribute__((noinline)) static struct node *insert(struct node *root, int key) {
  struct node **link = &root;
  while (*link)
    link = key < (*link)->key ? &(*link)->left : &(*link)->right;
  *link = calloc(1, sizeof **link);
  (*link)->key = key;
  return root;
}

int main(void) {
  struct node *root = NULL;
  for (int i = 0; i < 50; i++)
    root = insert(root, i * 37 % 101);
  int depth = 0, sum = 0;
  for (struct node *n = root; n; n = n->right, depth++)
    sum += n->key;
  printf("%d %d\n", depth, sum);

  char *text = malloc(1);
  *text = 0;
  for (int i = 0; i < 40; i++) {
    size_t length = strlen(text);
    text = realloc(text, length + 2);
    text[length] = (char)('a' + i % 26);
    text[length + 1] = 0;
  }
  puts(text);
  free(text);

  static unsigned char *blocks[20];
  unsigned x = 7, bad = 0;
  for (int round = 0; round < 400; round++) {
    unsigned i = (x = x * 1664525 + 1013904223) >> 16;
    unsigned char **block = &blocks[i % 20];
    if (*block) {
      bad += **block != (unsigned char)(i % 20);
      free(*block);
      *block = NULL;
    } else {
      *block = malloc(1 + i % 300);
      bad += ((uintptr_t)*block & 7) != 0;
      memset(*block, (int)(i % 20), 1 + i % 300);
    }
  }
  void *aligned = aligned_alloc(256, 512);
  printf("%u %d\n", bad, ((uintptr_t)aligned & 255) == 0);
  void *volatile empty = aligned_alloc(8192, 0), *volatile other = aligned_alloc(8192, 0);
  printf("%d\n", empty && other && empty != other);
  free(empty);
  free(other);
  return 0;
}
