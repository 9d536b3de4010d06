/* The builder of trees by the surface-area heuristic: object splits over 32 bins an axis, spatial splits over 16 (M.
   Stich, H. Friedrich and A. Dietrich, "Spatial splits in bounding volume hierarchies", High Performance Graphics
   2009). It makes the trees that Embree's builder of high quality makes with one thread (tests/scene/builder_test.c
   compares them), and so has its rules: a budget of splits for each triangle, room for further parts that children
   share by their budgets. */
#ifndef TRAX_SCENE_SAH_H
#define TRAX_SCENE_SAH_H

#include "internal.h"

#include <emmintrin.h>

/* A triangle, or a part of one. */
struct sah_prim {
  float min[3];
  uint32_t budget; /* it may be split while this is more than 1; 0: nothing is split */
  float max[3];
  uint32_t triangle;
} __attribute__((aligned(32)));

/* Boxes for arithmetic on all axes at once. The fourth element is 0 in boxes of primitives, and arbitrary in others. */
struct sah_box {
  __m128 min, max;
};

/* Primitives from begin to end, with room for further parts up to room_end. */
struct sah_set {
  struct sah_box box, middles; /* middles: around the sums of the corners of the boxes */
  size_t begin, end, room_end;
};

struct sah {
  struct sah_prim *prims;
  const struct trax_mesh *mesh;
  float root_area;
};

/* A division of a set. */
struct sah_split {
  float cost; /* INFINITY: nowhere */
  int axis, bin;
  bool spatial;
  __m128 offset, scale; /* from coordinates to bins */
  float position;       /* of a spatial split */
};

static inline struct sah_box sah_empty_box(void) {
  return (struct sah_box){_mm_set1_ps(__builtin_inff()), _mm_set1_ps(-__builtin_inff())};
}

static inline struct sah_box sah_box_of(const struct sah_prim *prim) {
  const __m128 axes = _mm_castsi128_ps(_mm_set_epi32(0, -1, -1, -1));
  return (struct sah_box){_mm_and_ps(_mm_load_ps(prim->min), axes), _mm_and_ps(_mm_load_ps(prim->max), axes)};
}

static inline void sah_extend(struct sah_box *box, const struct sah_box *other) {
  box->min = _mm_min_ps(box->min, other->min);
  box->max = _mm_max_ps(box->max, other->max);
}

static inline float sah_half_area(const struct sah_box *box) {
  float size[4];
  _mm_storeu_ps(size, _mm_sub_ps(box->max, box->min));
  return size[0] * (size[1] + size[2]) + size[1] * size[2];
}

/* 0 of an empty box. */
static inline float sah_area(const struct sah_box *box) {
  const bool full = (_mm_movemask_ps(_mm_cmple_ps(box->min, box->max)) & 7) == 7;
  return full ? 2 * sah_half_area(box) : 0;
}

/* Rounds down, but whole numbers to the even one of the two next to their half. */
static inline __m128i sah_bins(__m128 place, const struct sah_split *split) {
  return _mm_cvtps_epi32(_mm_sub_ps(_mm_mul_ps(_mm_sub_ps(place, split->offset), split->scale), _mm_set1_ps(0.5f)));
}

static inline __m128i sah_clamp(__m128i bins, int last) {
  const __m128i most = _mm_set1_epi32(last), over = _mm_cmpgt_epi32(bins, most);
  bins = _mm_or_si128(_mm_and_si128(over, most), _mm_andnot_si128(over, bins));
  return _mm_andnot_si128(_mm_cmplt_epi32(bins, _mm_setzero_si128()), bins);
}

enum { SAH_MOST_BINS = 32 };

/* Finds the axis and the bin before which a division costs least, if that is less than split->cost. begin and end: how
   many primitives begin and end in a bin. Axes without a scale have none. */
static inline void sah_sweep(struct sah_split *split, int count, const struct sah_box (*boxes)[3],
                             const uint32_t (*begin)[4], const uint32_t (*end)[4]) {
  float scale[4], areas[SAH_MOST_BINS];
  uint32_t counts[SAH_MOST_BINS];
  _mm_storeu_ps(scale, split->scale);
  for (int axis = 0; axis < 3; axis++) {
    if (scale[axis] == 0)
      continue;
    uint32_t before = 0, behind = 0;
    struct sah_box box = sah_empty_box();
    for (int i = count - 1; i > 0; i--) {
      sah_extend(&box, &boxes[i][axis]);
      areas[i] = sah_half_area(&box);
      counts[i] = behind += end[i][axis];
    }
    box = sah_empty_box();
    for (int i = 1; i < count; i++) {
      sah_extend(&box, &boxes[i - 1][axis]);
      before += begin[i - 1][axis];
      const float cost = sah_half_area(&box) * (float)before + areas[i] * (float)counts[i];
      if (cost < split->cost)
        split->cost = cost, split->axis = axis, split->bin = i;
    }
  }
}

/* --- sah_object.c --- */

/* Divides the primitives by their middles. overlap: of the two sides' boxes. */
struct sah_split sah_find_object_split(const struct sah *sah, const struct sah_set *set, struct sah_box *overlap);
/* Sorts the primitives to two sides; their rooms are empty. weights: sums of their budgets. */
void sah_partition(const struct sah *sah, const struct sah_split *split, const struct sah_set *set,
                   struct sah_set sides[2], size_t weights[2]);

/* --- sah_spatial.c --- */

enum { SAH_SPATIAL_BINS = 16 };

/* The bounds of the parts of a primitive between planes, from the bin `first` to `last`; planes[i] is between the bins
   i - 1 and i. For tests. */
void sah_find_parts(struct scene_box parts[SAH_SPATIAL_BINS], const struct sah *sah, const struct sah_prim *prim,
                    int axis, const float *planes, int first, int last);

/* The best spatial split, unless it needs more room than there is or does not cost less than `most`. */
struct sah_split sah_find_spatial_split(const struct sah *sah, const struct sah_set *set, float most);
/* Divides the primitives across the plane. set->end grows. */
void sah_divide(const struct sah *sah, const struct sah_split *split, struct sah_set *set);

#endif
