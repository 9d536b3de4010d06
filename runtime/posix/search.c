/* Tables, trees and lists of <search.h>. */
#include <errno.h>
#include <search.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* --- a hash table: open addressing, a power of two of slots --- */

static ENTRY *table;
static size_t slots, taken;

int hcreate(size_t count) {
  if (table)
    return 0;
  if (count > SIZE_MAX / 4 / sizeof *table) {
    errno = ENOMEM;
    return 0;
  }
  for (slots = 16; slots < 2 * count; slots *= 2)
    continue;
  taken = 0;
  table = calloc(slots, sizeof *table);
  return table != NULL;
}

void hdestroy(void) {
  free(table);
  table = NULL;
}

ENTRY *hsearch(ENTRY item, ACTION action) {
  uint32_t hash = 2166136261u; /* FNV-1a */
  for (const char *c = item.key; *c; c++)
    hash = (hash ^ (unsigned char)*c) * 16777619u;
  size_t slot = hash & (slots - 1);
  for (; table[slot].key; slot = (slot + 1) & (slots - 1))
    if (strcmp(table[slot].key, item.key) == 0)
      return &table[slot];
  if (action == FIND || taken + 1 >= slots) {
    errno = action == FIND ? ESRCH : ENOMEM;
    return NULL;
  }
  taken++;
  table[slot] = item;
  return &table[slot];
}

/* --- trees: treaps, with pseudo-random priorities --- */

struct node {
  const void *key; /* first: what tsearch returns points to it */
  struct node *left, *right;
  uint32_t priority;
};

static struct node **turn(struct node **link, int right) {
  struct node *up = *link, *down = right ? up->right : up->left;
  if (right) {
    up->right = down->left;
    down->left = up;
  } else {
    up->left = down->right;
    down->right = up;
  }
  *link = down;
  return right ? &down->left : &down->right; /* where the upper one is now */
}

static struct node *insert(struct node **link, const void *key, int (*compare)(const void *, const void *)) {
  static uint32_t state = 1;
  if (!*link) {
    struct node *made = malloc(sizeof *made);
    state = state * 1664525u + 1013904223u;
    if (made)
      *made = (struct node){key, NULL, NULL, state >> 1};
    return *link = made;
  }
  const int order = compare(key, (*link)->key);
  if (order == 0)
    return *link;
  struct node **side = order > 0 ? &(*link)->right : &(*link)->left, *found = insert(side, key, compare);
  if (*side && (*side)->priority > (*link)->priority)
    turn(link, order > 0);
  return found;
}

void *tsearch(const void *key, void **root, int (*compare)(const void *, const void *)) {
  return root ? insert((struct node **)root, key, compare) : NULL;
}

void *tfind(const void *key, void *const *root, int (*compare)(const void *, const void *)) {
  for (struct node *it = root ? *root : NULL; it;) {
    const int order = compare(key, it->key);
    if (order == 0)
      return it;
    it = order > 0 ? it->right : it->left;
  }
  return NULL;
}

/* Returns the parent of the node that was removed; of the root, the root's place. */
void *tdelete(const void *restrict key, void **restrict root, int (*compare)(const void *, const void *)) {
  struct node **link = (struct node **)root;
  void *parent = root;
  if (!root)
    return NULL;
  while (*link) {
    const int order = compare(key, (*link)->key);
    if (order == 0)
      break;
    parent = *link;
    link = order > 0 ? &(*link)->right : &(*link)->left;
  }
  struct node *it = *link;
  if (!it)
    return NULL;
  while (it->left && it->right)
    link = turn(link, it->right->priority > it->left->priority);
  *link = it->left ? it->left : it->right;
  free(it);
  return parent;
}

static void walk(const struct node *it, void (*action)(const void *, VISIT, int), int depth) {
  if (!it->left && !it->right) {
    action(it, leaf, depth);
    return;
  }
  action(it, preorder, depth);
  if (it->left)
    walk(it->left, action, depth + 1);
  action(it, postorder, depth);
  if (it->right)
    walk(it->right, action, depth + 1);
  action(it, endorder, depth);
}

void twalk(const void *root, void (*action)(const void *, VISIT, int)) {
  if (root && action)
    walk(root, action, 0);
}

void tdestroy(void *root, void (*release)(void *)) {
  struct node *it = root;
  while (it) {
    if (it->left) { /* rotated away, so that there is no recursion */
      struct node *left = it->left;
      it->left = left->right;
      left->right = it;
      it = left;
      continue;
    }
    struct node *right = it->right;
    release((void *)(uintptr_t)it->key);
    free(it);
    it = right;
  }
}

/* --- arrays and lists --- */

void *lfind(const void *key, const void *base, size_t *count, size_t size, int (*compare)(const void *, const void *)) {
  for (size_t i = 0; i < *count; i++)
    if (compare(key, (const char *)base + i * size) == 0)
      return (char *)(uintptr_t)base + i * size;
  return NULL;
}

void *lsearch(const void *key, void *base, size_t *count, size_t size, int (*compare)(const void *, const void *)) {
  void *found = lfind(key, base, count, size, compare);
  return found ? found : memcpy((char *)base + (*count)++ * size, key, size);
}

struct element {
  struct element *next, *before;
};

void insque(void *element, void *before) {
  struct element *it = element, *other = before;
  it->before = other;
  it->next = other ? other->next : NULL;
  if (it->next)
    it->next->before = it;
  if (other)
    other->next = it;
}

void remque(void *element) {
  struct element *it = element;
  if (it->next)
    it->next->before = it->before;
  if (it->before)
    it->before->next = it->next;
}
