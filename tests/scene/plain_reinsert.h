#ifndef TRAX_TEST_PLAIN_REINSERT_H
#define TRAX_TEST_PLAIN_REINSERT_H

#include "../../raytracer/scene/internal.h"

/* Compares by values, the greatest first, then by numbers. */
struct rank {
  double value;
  uint32_t number;
};
int compare_ranks(const void *a, const void *b);

/* Improves a tree as scene_reinsert does, without threads. False when out of memory. */
bool plain_reinsert(struct scene_links *links, unsigned passes);

#endif
