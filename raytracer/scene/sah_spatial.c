/* Spatial splits of the builder.

   Bins need the bounds of each triangle's parts between neighbouring planes. By definition these are what
   scene_split_triangle leaves when it cuts one part after the other off the rest. One walk along the edges finds the same
   floats unless a coordinate is nearly halfway between two floats. Then the parts are cut off one by one. */
#include "sah.h"

#include <math.h>

enum { BINS = 16 };

struct spatial_bins {
  struct sah_box boxes[BINS][3];
  uint32_t begin[BINS][4], end[BINS][4]; /* the number of primitives that begin and end in a bin */
};

/* --- the parts of one primitive on one axis --- */

struct cuts {
  const struct sah_prim *prim;
  const float *corners[3];
  int axis, first, last;      /* bins */
  const float *planes;        /* planes[i] is between the bins i - 1 and i */
  struct scene_box box[BINS]; /* of the parts, from first to last */
};

static void cut_one_by_one(struct cuts *cuts) {
  const struct sah_prim *prim = cuts->prim;
  struct scene_box sides[2], rest = {{prim->min[0], prim->min[1], prim->min[2]},
                                     {prim->max[0], prim->max[1], prim->max[2]}};
  for (int bin = cuts->first; bin < cuts->last; bin++) {
    scene_split_triangle(cuts->corners, &rest, cuts->axis, cuts->planes[bin + 1], sides);
    cuts->box[bin] = sides[0];
    rest = sides[1];
  }
  cuts->box[cuts->last] = rest;
}

static inline void extend(double *min, double *max, double value) {
  *min = value < *min ? value : *min;
  *max = value > *max ? value : *max;
}

/* Rounds outwards, but not beyond the primitive. False if a coordinate that differs by `error` would be rounded to
   another float. */
static inline bool round_outwards(struct cuts *cuts, int bin, int axis, double min, double max, double error) {
  const float low = (float)min, high = (float)max;
  if ((float)(min - error) != (float)(min + error) || (float)(max - error) != (float)(max + error))
    return false;
  const float down = scene_next_float(low, false), up = scene_next_float(high, true);
  cuts->box[bin].min[axis] = down > cuts->prim->min[axis] ? down : cuts->prim->min[axis];
  cuts->box[bin].max[axis] = up < cuts->prim->max[axis] ? up : cuts->prim->max[axis];
  return true;
}

/* The same for a whole triangle by a walk along its edges. False if some float is not certain. */
static bool cut_at_once(struct cuts *cuts) {
  const int axis = cuts->axis, first = cuts->first, last = cuts->last, others[2] = {axis == 0, axis == 2 ? 1 : 2};
  const float *planes = cuts->planes;
  double min[BINS][2], max[BINS][2], steepest[2] = {0, 0}, largest[3] = {0, 0, 0};
  for (int i = first; i <= last; i++)
    for (int k = 0; k < 2; k++)
      min[i][k] = INFINITY, max[i][k] = -INFINITY;
  for (int i = 0; i < 3; i++) {
    const float *a = cuts->corners[i], *b = cuts->corners[i < 2 ? i + 1 : 0];
    for (int k = 0; k < 3; k++)
      largest[k] = fmax(largest[k], fabs((double)a[k]));
    /* A corner is in one bin, or in two if it is on their plane. */
    int bin = first;
    while (bin < last && a[axis] > planes[bin + 1])
      bin++;
    for (int at = bin; at <= last && (at == bin || a[axis] == planes[at]); at++)
      for (int k = 0; k < 2; k++)
        extend(&min[at][k], &max[at][k], a[others[k]]);
    /* The planes that the edge crosses, from its lower end. */
    if (a[axis] > b[axis]) {
      const float *swap = a;
      a = b, b = swap;
      for (bin = first; bin < last && a[axis] > planes[bin + 1];)
        bin++;
    }
    double slopes[2] = {0, 0};
    bool known = false;
    for (int plane = bin + 1; plane <= last && planes[plane] < b[axis]; plane++) {
      if (planes[plane] <= a[axis])
        continue;
      for (int k = 0; k < 2 && !known; k++) {
        slopes[k] = ((double)b[others[k]] - a[others[k]]) / ((double)b[axis] - a[axis]);
        steepest[k] = fmax(steepest[k], fabs(slopes[k]));
      }
      known = true;
      for (int k = 0; k < 2; k++) {
        const double value = a[others[k]] + ((double)planes[plane] - a[axis]) * slopes[k];
        extend(&min[plane - 1][k], &max[plane - 1][k], value);
        extend(&min[plane][k], &max[plane][k], value);
      }
    }
  }
  for (int bin = first; bin <= last; bin++) {
    cuts->box[bin].min[axis] = bin == first ? cuts->prim->min[axis] : planes[bin];
    cuts->box[bin].max[axis] = bin == last ? cuts->prim->max[axis] : planes[bin + 1];
    for (int k = 0; k < 2; k++)
      /* Either way of cutting is exact to a few 2^-52 of the coordinates, those on the axis times the slope. */
      if (!round_outwards(cuts, bin, others[k], min[bin][k], max[bin][k],
                          0x1p-46 * (largest[others[k]] + steepest[k] * largest[axis])))
        return false;
  }
  return true;
}

static void find_cuts(struct cuts *cuts) {
  bool whole = true;
  for (int i = 0; i < 3; i++)
    for (int axis = 0; axis < 3; axis++)
      whole &= (cuts->corners[i][axis] >= cuts->prim->min[axis]) & (cuts->corners[i][axis] <= cuts->prim->max[axis]);
  if (!whole || !cut_at_once(cuts))
    cut_one_by_one(cuts);
}

/* --- bins --- */

static inline struct sah_box as_vectors(const struct scene_box *box) {
  return (struct sah_box){_mm_set_ps(0, box->min[2], box->min[1], box->min[0]),
                          _mm_set_ps(0, box->max[2], box->max[1], box->max[0])};
}

static void find_corners(const float *corners[3], const struct sah *sah, const struct sah_prim *prim) {
  const uint32_t *vertices = sah->mesh->triangles[prim->triangle].vertices;
  for (int i = 0; i < 3; i++)
    corners[i] = sah->mesh->vertices[vertices[i]];
}

static void fill_axis(struct spatial_bins *bins, const struct sah *sah, const struct sah_prim *prim, int axis, int low,
                      int high, const float *planes) {
  const struct sah_box box = sah_box_of(prim);
  bins->begin[low][axis]++;
  bins->end[high][axis]++;
  struct cuts cuts = {.prim = prim, .axis = axis, .first = low, .last = high, .planes = planes};
  while (cuts.first < cuts.last && planes[cuts.first + 1] <= prim->min[axis])
    cuts.first++;
  while (cuts.first < cuts.last && planes[cuts.last] >= prim->max[axis])
    cuts.last--;
  if (cuts.first == cuts.last) {
    sah_extend(&bins->boxes[cuts.first][axis], &box);
    return;
  }
  find_corners(cuts.corners, sah, prim);
  find_cuts(&cuts);
  for (int bin = cuts.first; bin <= cuts.last; bin++) {
    const struct sah_box part = as_vectors(&cuts.box[bin]);
    sah_extend(&bins->boxes[bin][axis], &part);
  }
}

static void fill(struct spatial_bins *bins, const struct sah *sah, const struct sah_set *set,
                 const struct sah_split *mapping, float planes[3][BINS + 1]) {
  float scale[4];
  _mm_storeu_ps(scale, mapping->scale);
  for (size_t i = set->begin; i < set->end; i++) {
    const struct sah_prim *prim = &sah->prims[i];
    const struct sah_box box = sah_box_of(prim);
    int low[4], high[4];
    if (prim->budget <= 1) {
      const __m128 middle = _mm_mul_ps(_mm_add_ps(box.min, box.max), _mm_set1_ps(0.5f));
      _mm_storeu_si128((__m128i *)low, sah_clamp(sah_bins(middle, mapping), BINS - 1));
      for (int axis = 0; axis < 3; axis++) {
        bins->begin[low[axis]][axis]++;
        bins->end[low[axis]][axis]++;
        sah_extend(&bins->boxes[low[axis]][axis], &box);
      }
      continue;
    }
    _mm_storeu_si128((__m128i *)low, sah_clamp(sah_bins(box.min, mapping), BINS - 1));
    _mm_storeu_si128((__m128i *)high, sah_clamp(sah_bins(box.max, mapping), BINS - 1));
    for (int axis = 0; axis < 3; axis++)
      if (scale[axis] != 0)
        fill_axis(bins, sah, prim, axis, low[axis], high[axis], planes[axis]);
  }
}

struct sah_split sah_find_spatial_split(const struct sah *sah, const struct sah_set *set, float most) {
  const __m128 sign = _mm_set1_ps(-0.0f), size = _mm_sub_ps(set->box.max, set->box.min);
  const __m128 largest = _mm_max_ps(_mm_andnot_ps(sign, set->box.min), _mm_andnot_ps(sign, set->box.max));
  const __m128 least = _mm_mul_ps(_mm_set1_ps(128 * 0x1p-23f), largest); /* bins are not narrower than a few floats */
  struct sah_split split = {.cost = INFINITY, .axis = -1, .spatial = true, .offset = set->box.min};
  split.scale = _mm_andnot_ps(_mm_cmple_ps(size, least), _mm_div_ps(_mm_set1_ps(BINS), _mm_max_ps(least, size)));
  float offset[4], scale[4], planes[3][BINS + 1];
  _mm_storeu_ps(offset, split.offset);
  _mm_storeu_ps(scale, split.scale);
  struct spatial_bins bins = {.begin = {{0}}};
  for (int axis = 0; axis < 3; axis++) {
    const float step = 1 / scale[axis];
    for (int i = 0; i <= BINS; i++)
      planes[axis][i] = (float)i * step + offset[axis];
    for (int i = 0; i < BINS; i++)
      bins.boxes[i][axis] = sah_empty_box();
  }
  fill(&bins, sah, set, &split, planes);
  size_t parts = 0; /* on both sides of the best split */
  for (int axis = 0; axis < 3; axis++) {
    if (scale[axis] == 0)
      continue;
    float areas[BINS];
    uint32_t counts[BINS], before = 0, behind = 0;
    struct sah_box box = sah_empty_box();
    for (int i = BINS - 1; i > 0; i--) {
      sah_extend(&box, &bins.boxes[i][axis]);
      areas[i] = sah_half_area(&box);
      counts[i] = behind += bins.end[i][axis];
    }
    box = sah_empty_box();
    for (int i = 1; i < BINS; i++) {
      sah_extend(&box, &bins.boxes[i - 1][axis]);
      before += bins.begin[i - 1][axis];
      const float cost = sah_half_area(&box) * (float)before + areas[i] * (float)counts[i];
      if (cost < split.cost) {
        split.cost = cost, split.axis = axis, split.bin = i;
        split.position = planes[axis][i];
        parts = (size_t)before + counts[i];
      }
    }
  }
  if (!(split.cost < most) || parts - (set->end - set->begin) > set->room_end - set->end)
    split.cost = INFINITY;
  return split;
}

static inline bool is_empty(const struct scene_box *box) {
  return !(box->min[0] <= box->max[0] && box->min[1] <= box->max[1] && box->min[2] <= box->max[2]);
}

static struct sah_prim part_of(const struct sah_prim *prim, const struct scene_box *box) {
  return (struct sah_prim){{box->min[0], box->min[1], box->min[2]},
                           prim->budget - 1,
                           {box->max[0], box->max[1], box->max[2]},
                           prim->triangle};
}

void sah_divide(const struct sah *sah, const struct sah_split *split, struct sah_set *set) {
  const size_t end = set->end;
  for (size_t i = set->begin; i < end && set->end < set->room_end; i++) {
    struct sah_prim *prim = &sah->prims[i];
    if (prim->budget <= 1 || !(prim->min[split->axis] < split->position && prim->max[split->axis] > split->position))
      continue;
    const float *corners[3];
    find_corners(corners, sah, prim);
    const struct scene_box box = {{prim->min[0], prim->min[1], prim->min[2]}, {prim->max[0], prim->max[1], prim->max[2]}};
    struct scene_box sides[2];
    scene_split_triangle(corners, &box, split->axis, split->position, sides);
    if (is_empty(&sides[0]) || is_empty(&sides[1]))
      continue;
    sah->prims[set->end++] = part_of(prim, &sides[1]);
    *prim = part_of(prim, &sides[0]);
  }
}
