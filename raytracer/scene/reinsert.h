/* Declarations shared by the files that improve a tree by reinsertion. */
#ifndef TRAX_SCENE_REINSERT_H
#define TRAX_SCENE_REINSERT_H

#include "internal.h"

#include <emmintrin.h>

enum { MOST_FOCI = 8 };

/* The foci as columns, so that two are computed at once. Those beyond `count` are zero. In binary32, each coordinate is
   there four times, for four boxes at once. */
struct foci {
  double min[3][MOST_FOCI], max[3][MOST_FOCI];
  double scale[MOST_FOCI]; /* the reciprocal of a box's half area */
  __m128 coarse_min[MOST_FOCI][3], coarse_max[MOST_FOCI][3], coarse_scale[MOST_FOCI];
  double underflow; /* the most that underflow takes from a sum in binary32 */
  int count;
} __attribute__((aligned(16)));

/* Expected visits to a node with this box. */
static inline double visits_of(const struct foci *foci, const struct scene_box *box) {
  __m128d min[3], max[3];
  double sum = 0;
  for (int axis = 0; axis < 3; axis++)
    min[axis] = _mm_set1_pd(box->min[axis]), max[axis] = _mm_set1_pd(box->max[axis]);
  for (int i = 0; i < foci->count; i += 2) {
    __m128d size[3];
    for (int axis = 0; axis < 3; axis++)
      size[axis] = _mm_sub_pd(_mm_min_pd(max[axis], _mm_load_pd(&foci->max[axis][i])),
                              _mm_max_pd(min[axis], _mm_load_pd(&foci->min[axis][i])));
    const __m128d inside = _mm_cmpge_pd(_mm_min_pd(size[0], _mm_min_pd(size[1], size[2])), _mm_setzero_pd());
    const __m128d area = _mm_add_pd(_mm_add_pd(_mm_mul_pd(size[0], size[1]), _mm_mul_pd(size[1], size[2])),
                                    _mm_mul_pd(size[2], size[0]));
    const __m128d part = _mm_and_pd(_mm_mul_pd(_mm_load_pd(&foci->scale[i]), area), inside);
    sum += _mm_cvtsd_f64(part); /* in the order of the foci */
    sum += _mm_cvtsd_f64(_mm_unpackhi_pd(part, part));
  }
  return sum;
}

/* --- reinsert_search.c --- */

/* Limits a search in trees with many overlapping boxes. */
enum { MOST_LOOKED_AT = 1000 };

struct place {
  double least; /* the cost that the part adds to the nodes above, if it is inserted beside or below this node */
  uint32_t node, depth;
};

/* One thread's state of a search. */
struct search {
  const struct scene_links *links;
  const struct foci *foci;
  union {
    struct place heap[MOST_LOOKED_AT + 2]; /* the least first; each node looked at is one less and two more */
    struct place queue[2 * MOST_LOOKED_AT];
  };
  size_t heap_count;
  uint32_t *read; /* the nodes that the searches depend on */
  size_t read_count, read_capacity;
  bool heights; /* the last search depends on some */
  /* of the current search */
  const struct scene_link *part;
  uint32_t parent, beside; /* of the part; its other child */
  uint32_t depth;          /* inner nodes above the parent */
  /* These nodes, from the root on, as they are without the part. */
  struct above {
    uint32_t node, height;
    struct scene_box box;
    double visits;
  } above[TRAX_SCENE_MAX_DEPTH + 1];
};

/* Finds the node beside which the part costs least when it is taken out of the tree: its sibling if no other is better.
   Only reads the tree. SCENE_NO_LINK when out of memory. */
uint32_t scene_find_place(struct search *search, uint32_t part);

#endif
