/* Texts with numbers from 1; equal texts have the same number. */
#ifndef TRAX_EXPLAIN_TEXTS_H
#define TRAX_EXPLAIN_TEXTS_H

#include "trax/map.h"

struct trax_texts {
  char **texts; /* [number - 1] */
  size_t count, capacity;
  struct trax_map by_hash; /* if two texts have the same hash, the second one's key is the hash + 1 */
};

/* Returns the number of a text, which is copied; 0: out of memory. */
uint32_t trax_texts_number(struct trax_texts *texts, const char *text);
void trax_texts_free(struct trax_texts *texts);

/* 0 is "". */
static inline const char *trax_texts_at(const struct trax_texts *texts, uint32_t number) {
  return number ? texts->texts[number - 1] : "";
}

#endif
