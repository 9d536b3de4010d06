/* A hash table with open addressing: words are counted. */
#include "../bench.h"

#include <stddef.h>

enum { SLOTS = 1024, KEYS = 600, LOOKUPS = 4000 };
static struct entry {
  char key[12];
  unsigned count;
} table[SLOTS];
static char keys[KEYS][12];

void kernel_setup(void) {
  uint32_t random = 4;
  for (int i = 0; i < KEYS; i++) {
    unsigned length = 4 + (next_random(&random) >> 29);
    for (unsigned k = 0; k < length; k++)
      keys[i][k] = (char)('a' + (next_random(&random) >> 28));
  }
}

static uint32_t hash(const char *key) {
  uint32_t value = 2166136261u; /* FNV-1a */
  while (*key)
    value = (value ^ (unsigned char)*key++) * 16777619u;
  return value;
}

static int equal(const char *a, const char *b) {
  while (*a && *a == *b)
    a++, b++;
  return *a == *b;
}

static struct entry *find(const char *key) {
  uint32_t at = hash(key) % SLOTS;
  while (table[at].key[0] && !equal(table[at].key, key))
    at = (at + 1) % SLOTS;
  return &table[at];
}

struct result kernel_run(void) {
  uint32_t random = 8, checksum = 0;
  for (int i = 0; i < SLOTS; i++)
    table[i].key[0] = 0, table[i].count = 0;
  for (int i = 0; i < LOOKUPS; i++) {
    const char *key = keys[(next_random(&random) >> 8) % KEYS];
    struct entry *entry = find(key);
    if (entry->key[0] == 0)
      for (size_t k = 0; k < sizeof entry->key; k++)
        entry->key[k] = key[k];
    entry->count++;
  }
  for (int i = 0; i < SLOTS; i++)
    checksum = mix(checksum, table[i].count);
  return (struct result){checksum, 0};
}
