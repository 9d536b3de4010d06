/* Object splits of the builder, and the sorting of primitives to the sides of a split. */
#include "sah.h"

#include <math.h>

struct object_bins {
  struct sah_box boxes[SAH_MOST_BINS][3];
  uint32_t counts[SAH_MOST_BINS][4];
};

static void fill(struct object_bins *bins, int count, const struct sah *sah, const struct sah_set *set,
                 const struct sah_split *mapping) {
  for (int i = 0; i < count; i++) {
    for (int axis = 0; axis < 3; axis++)
      bins->boxes[i][axis] = sah_empty_box();
    for (int axis = 0; axis < 4; axis++)
      bins->counts[i][axis] = 0;
  }
  for (size_t i = set->begin; i < set->end; i++) {
    const struct sah_box box = sah_box_of(&sah->prims[i]);
    int bin[4];
    _mm_storeu_si128((__m128i *)bin, sah_clamp(sah_bins(_mm_add_ps(box.min, box.max), mapping), count - 1));
    for (int axis = 0; axis < 3; axis++) {
      sah_extend(&bins->boxes[bin[axis]][axis], &box);
      bins->counts[bin[axis]][axis]++;
    }
  }
}

struct sah_split sah_find_object_split(const struct sah *sah, const struct sah_set *set, struct sah_box *overlap) {
  const size_t size = set->end - set->begin;
  const size_t wanted = (size_t)(4.0f + 0.05f * (float)size);
  const int count = wanted < SAH_MOST_BINS ? (int)wanted : SAH_MOST_BINS;
  const __m128 least = _mm_set1_ps(1e-34f), extent = _mm_max_ps(least, _mm_sub_ps(set->middles.max, set->middles.min));
  struct sah_split split = {.cost = INFINITY, .axis = -1, .offset = set->middles.min};
  split.scale = _mm_and_ps(_mm_cmpgt_ps(extent, least), _mm_div_ps(_mm_set1_ps(0.99f * (float)count), extent));
  struct object_bins bins;
  fill(&bins, count, sah, set, &split);
  const uint32_t(*counts)[4] = (const uint32_t(*)[4])bins.counts;
  sah_sweep(&split, count, (const struct sah_box(*)[3])bins.boxes, counts, counts);
  struct sah_box sides[2] = {sah_empty_box(), sah_empty_box()};
  for (int i = 0; i < count && split.axis >= 0; i++)
    sah_extend(&sides[i >= split.bin], &bins.boxes[i][split.axis]);
  overlap->min = _mm_max_ps(sides[0].min, sides[1].min);
  overlap->max = _mm_min_ps(sides[0].max, sides[1].max);
  return split;
}

static void add(struct sah_set *side, size_t *weight, const struct sah_prim *prim) {
  const struct sah_box box = sah_box_of(prim);
  sah_extend(&side->box, &box);
  const __m128 middle = _mm_add_ps(box.min, box.max);
  sah_extend(&side->middles, &(struct sah_box){middle, middle});
  *weight += prim->budget;
}

/* A spatial split sorts by the middle in bins that are clamped, an object split by the sum of the corners. */
static inline bool is_left(const struct sah_split *split, const struct sah_prim *prim) {
  const struct sah_box box = sah_box_of(prim);
  __m128 place = _mm_add_ps(box.min, box.max);
  if (split->spatial)
    place = _mm_mul_ps(place, _mm_set1_ps(0.5f));
  __m128i bins = sah_bins(place, split);
  if (split->spatial)
    bins = sah_clamp(bins, SAH_SPATIAL_BINS - 1);
  return _mm_movemask_ps(_mm_castsi128_ps(_mm_cmplt_epi32(bins, _mm_set1_epi32(split->bin)))) >> split->axis & 1;
}

void sah_partition(const struct sah *sah, const struct sah_split *split, const struct sah_set *set,
                   struct sah_set sides[2], size_t weights[2]) {
  struct sah_prim *left = sah->prims + set->begin, *right = sah->prims + set->end - 1;
  for (int side = 0; side < 2; side++) {
    sides[side].box = sides[side].middles = sah_empty_box();
    weights[side] = 0;
  }
  for (;;) {
    for (; left <= right && is_left(split, left); left++)
      add(&sides[0], &weights[0], left);
    for (; left <= right && !is_left(split, right); right--)
      add(&sides[1], &weights[1], right);
    if (right < left)
      break;
    add(&sides[0], &weights[0], right);
    add(&sides[1], &weights[1], left);
    const struct sah_prim swap = *left;
    *left++ = *right;
    *right-- = swap;
  }
  const size_t middle = (size_t)(left - sah->prims);
  sides[0].begin = set->begin, sides[0].end = sides[0].room_end = middle;
  sides[1].begin = middle, sides[1].end = sides[1].room_end = set->end;
}
