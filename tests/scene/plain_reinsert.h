#ifndef TRAX_TEST_PLAIN_REINSERT_H
#define TRAX_TEST_PLAIN_REINSERT_H

#include "../../raytracer/scene/internal.h"

/* Improves a tree as scene_reinsert does, without threads. False when out of memory. */
bool plain_reinsert(struct scene_links *links, unsigned passes);

#endif
