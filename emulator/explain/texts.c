#define _POSIX_C_SOURCE 200809L /* strdup */
#include "explain/texts.h"
#include "trax/grow.h"

#include <string.h>

static uint64_t hash_of(const char *text) {
  uint64_t hash = 0xCBF29CE484222325u;
  for (; *text; text++)
    hash = (hash ^ (unsigned char)*text) * 0x100000001B3u;
  return hash;
}

uint32_t trax_texts_number(struct trax_texts *texts, const char *text) {
  for (uint64_t hash = hash_of(text);; hash++) {
    const struct trax_map_entry *entry = trax_map_put(&texts->by_hash, sizeof *entry, hash, (uint32_t)texts->count);
    if (!entry)
      return 0;
    const uint32_t number = entry->value;
    if (number < texts->count) {
      if (strcmp(texts->texts[number], text) == 0)
        return number + 1;
      continue;
    }
    if (!trax_grow((void **)&texts->texts, texts->count, &texts->capacity, sizeof *texts->texts) ||
        !(texts->texts[number] = strdup(text)))
      return 0;
    texts->count++;
    return number + 1;
  }
}

void trax_texts_free(struct trax_texts *texts) {
  for (size_t i = 0; i < texts->count; i++)
    free(texts->texts[i]);
  free(texts->texts);
  trax_map_free(&texts->by_hash);
  *texts = (struct trax_texts){0};
}
