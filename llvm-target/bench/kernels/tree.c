/* A binary search tree and a linked list: insertions, look-ups, a walk without recursion. */
#include "../bench.h"

#include <stddef.h>

enum { NODES = 1000, LOOKUPS = 3000 };
static struct node {
  unsigned key;
  struct node *left, *right, *next;
} nodes[NODES];
static int used;
static struct node *root, *list;

void kernel_setup(void) {}

static void insert(unsigned key) {
  struct node **place = &root;
  while (*place) {
    if ((*place)->key == key)
      return;
    place = key < (*place)->key ? &(*place)->left : &(*place)->right;
  }
  struct node *node = &nodes[used++];
  node->key = key;
  node->left = node->right = NULL;
  node->next = list;
  list = node;
  *place = node;
}

static int depth_of(unsigned key) {
  int depth = 0;
  for (const struct node *node = root; node; node = key < node->key ? node->left : node->right) {
    if (node->key == key)
      return depth;
    depth++;
  }
  return -1;
}

static struct node *reverse(struct node *first) {
  struct node *reversed = NULL;
  while (first) {
    struct node *next = first->next;
    first->next = reversed;
    reversed = first;
    first = next;
  }
  return reversed;
}

struct result kernel_run(void) {
  uint32_t random = 21, checksum = 0;
  used = 0, root = list = NULL;
  for (int i = 0; i < NODES; i++)
    insert(next_random(&random) >> 20);
  for (int i = 0; i < LOOKUPS; i++)
    checksum += (uint32_t)depth_of(next_random(&random) >> 20);
  list = reverse(list);
  for (const struct node *node = list; node; node = node->next)
    checksum = mix(checksum, node->key);
  return (struct result){checksum, 0};
}
