/* Spatial splits of the builder.

   Bins need the bounds of each triangle's parts between neighbouring planes. By definition these are what
   scene_split_triangle leaves when it cuts one part after the other off the rest. One walk along the edges finds the
   same floats unless a coordinate is nearly halfway between two floats. Then the parts are cut off one by one. */
#include "sah.h"

#include <math.h>
#include <string.h>

enum { BINS = SAH_SPATIAL_BINS };

struct spatial_bins {
  struct sah_box boxes[BINS][3];
  uint32_t begin[BINS][4], end[BINS][4]; /* the number of primitives that begin and end in a bin */
};

/* --- the outline of a primitive --- */

enum { MOST_CORNERS = 10 };

/* The part of a triangle in the box of its primitive. */
struct outline {
  const float *triangle[3];
  double corners[MOST_CORNERS][3];
  unsigned count;    /* 0: nothing but rounding */
  bool whole;        /* the triangle itself */
  double slope;      /* of the steepest edge that the box cuts */
  double largest[3]; /* coordinates of the triangle, without signs */
  bool flat[3];      /* all coordinates of the triangle are the same */
};

static double slope_of(const double a[3], const double b[3], int axis) {
  const double rise = fmax(fabs(b[0] - a[0]), fmax(fabs(b[1] - a[1]), fabs(b[2] - a[2])));
  return rise / fabs(b[axis] - a[axis]);
}

/* The slope of the steepest edge that crosses a plane. */
static double steepest(const double (*corners)[3], unsigned count, int axis, double plane) {
  double most = 0;
  for (unsigned i = 0; i < count; i++) {
    const double *a = corners[i], *b = corners[i + 1 < count ? i + 1 : 0];
    if ((a[axis] < plane) != (b[axis] < plane))
      most = fmax(most, slope_of(a, b, axis));
  }
  return most;
}

static void find_outline(struct outline *outline, const struct sah *sah, const struct sah_prim *prim) {
  const uint32_t *vertices = sah->mesh->triangles[prim->triangle].vertices;
  double(*corners)[3] = outline->corners, cut[MOST_CORNERS][3];
  unsigned count = 3;
  for (int i = 0; i < 3; i++)
    outline->triangle[i] = sah->mesh->vertices[vertices[i]];
  outline->whole = true;
  outline->slope = 0;
  for (int axis = 0; axis < 3; axis++) {
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 3; i++) {
      const double value = corners[i][axis] = outline->triangle[i][axis];
      low = value < low ? value : low;
      high = value > high ? value : high;
    }
    outline->largest[axis] = fmax(-low, high);
    outline->flat[axis] = low == high;
    outline->whole &= low >= prim->min[axis] && high <= prim->max[axis];
  }
  for (int side = 0; side < 6 && !outline->whole && count; side++) {
    const int axis = side >> 1;
    const double sign = side & 1 ? -1 : 1, plane = side & 1 ? prim->max[axis] : prim->min[axis];
    bool cuts = false;
    for (unsigned i = 0; i < count; i++)
      cuts |= sign * (corners[i][axis] - plane) < 0;
    if (!cuts)
      continue;
    outline->slope = fmax(outline->slope, steepest((const double(*)[3])corners, count, axis, plane));
    count = scene_clip_polygon(cut, MOST_CORNERS, (const double(*)[3])corners, count, axis, sign, plane);
    memcpy(corners, cut, count * sizeof *corners);
  }
  outline->count = count;
}

/* --- its parts on one axis --- */

struct cuts {
  const struct sah_prim *prim;
  const struct outline *outline;
  int axis, first, last;      /* bins */
  const float *planes;        /* planes[i] is between the bins i - 1 and i */
  struct scene_box box[BINS]; /* of the parts, from first to last */
};

static void cut_one_by_one(struct cuts *cuts) {
  const struct sah_prim *prim = cuts->prim;
  struct scene_box sides[2],
      rest = {{prim->min[0], prim->min[1], prim->min[2]}, {prim->max[0], prim->max[1], prim->max[2]}};
  for (int bin = cuts->first; bin < cuts->last; bin++) {
    scene_split_triangle(cuts->outline->triangle, &rest, cuts->axis, cuts->planes[bin + 1], sides);
    cuts->box[bin] = sides[0];
    rest = sides[1];
  }
  cuts->box[cuts->last] = rest;
}

/* Bounds on the three axes. */
struct range {
  double min[3], max[3];
};

static inline void extend(struct range *range, int axis, double value) {
  range->min[axis] = value < range->min[axis] ? value : range->min[axis];
  range->max[axis] = value > range->max[axis] ? value : range->max[axis];
}

/* Rounds outwards, but not beyond the primitive. False if a coordinate that differs by `error` would be rounded to
   another float. */
static inline bool round_outwards(struct cuts *cuts, int bin, int axis, const struct range *range, double error) {
  const double min = range->min[axis], max = range->max[axis];
  if ((float)(min - error) != (float)(min + error) || (float)(max - error) != (float)(max + error))
    return false;
  const float down = scene_next_float((float)min, false), up = scene_next_float((float)max, true);
  cuts->box[bin].min[axis] = down > cuts->prim->min[axis] ? down : cuts->prim->min[axis];
  cuts->box[bin].max[axis] = up < cuts->prim->max[axis] ? up : cuts->prim->max[axis];
  return true;
}

/* Finds the bounds of the outline between the planes by a walk along its edges. slopes: the steepest that a plane
   crosses. */
static void walk(const struct cuts *cuts, struct range *ranges, double slopes[3]) {
  const struct outline *outline = cuts->outline;
  const int axis = cuts->axis, first = cuts->first, last = cuts->last, others[2] = {axis == 0, axis == 2 ? 1 : 2};
  const float *planes = cuts->planes;
  for (int i = first; i <= last; i++)
    ranges[i] = (struct range){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
  const double *a = outline->corners[outline->count - 1];
  int bin = first; /* of a; the lower one of two if it is on their plane */
  while (bin < last && a[axis] > planes[bin + 1])
    bin++;
  for (unsigned i = 0; i < outline->count; i++) {
    const double *b = outline->corners[i];
    int to = bin;
    while (to < last && b[axis] > planes[to + 1])
      to++;
    while (to > first && b[axis] <= planes[to])
      to--;
    for (int at = to; at <= last && (at == to || b[axis] == planes[at]); at++)
      for (int k = 0; k < 3; k++)
        extend(&ranges[at], k, b[k]);
    const int low = bin < to ? bin : to, high = bin < to ? to : bin;
    const double start = bin < to ? a[axis] : b[axis], *lower = bin < to ? a : b;
    if (low < high) {
      double slope[2];
      for (int k = 0; k < 2; k++) {
        slope[k] = (b[others[k]] - a[others[k]]) / (b[axis] - a[axis]);
        slopes[others[k]] = fmax(slopes[others[k]], fabs(slope[k]));
      }
      for (int plane = low + 1; plane <= high; plane++)
        for (int k = 0; k < 2; k++) {
          const double value = lower[others[k]] + (planes[plane] - start) * slope[k];
          extend(&ranges[plane - 1], others[k], value);
          extend(&ranges[plane], others[k], value);
        }
    }
    a = b, bin = to;
  }
}

/* Cuts as cut_one_by_one does. False if some float is not certain. */
static bool cut_at_once(struct cuts *cuts) {
  const struct outline *outline = cuts->outline;
  const int axis = cuts->axis, first = cuts->first, last = cuts->last;
  struct range ranges[BINS];
  double slopes[3] = {0, 0, 0}, errors[3], largest = 0;
  if (outline->count == 0)
    return false;
  walk(cuts, ranges, slopes);
  for (int k = 0; k < 3; k++)
    largest = fmax(largest, outline->largest[k]);
  for (int k = 0; k < 3; k++)
    /* Either way of cutting a triangle is exact to a few 2^-52 of its coordinates, those on the axis times the slope.
       Corners that the box has cut have moved already by such an error. */
    errors[k] = outline->flat[k] ? 0
                : outline->whole
                    ? 0x1p-46 * (outline->largest[k] + slopes[k] * outline->largest[axis])
                    : 0x1p-48 * largest * (1 + outline->slope) * (1 + fmax(slopes[0], fmax(slopes[1], slopes[2])));
  /* Nothing may be left of a part that is thinner than that. */
  if (!outline->whole && (ranges[first].min[axis] + errors[axis] >= cuts->planes[first + 1] ||
                          ranges[last].max[axis] - errors[axis] <= cuts->planes[last]))
    return false;
  for (int bin = first; bin <= last; bin++) {
    if (bin > first)
      ranges[bin].min[axis] = cuts->planes[bin];
    if (bin < last)
      ranges[bin].max[axis] = cuts->planes[bin + 1];
    for (int k = 0; k < 3; k++)
      if (!round_outwards(cuts, bin, k, &ranges[bin],
                          k == axis && (outline->whole || (bin > first && bin < last)) ? 0 : errors[k]))
        return false;
    if (bin > first)
      cuts->box[bin].min[axis] = cuts->planes[bin];
    if (bin < last)
      cuts->box[bin].max[axis] = cuts->planes[bin + 1];
  }
  return true;
}

/* --- bins --- */

void sah_find_parts(struct scene_box parts[SAH_SPATIAL_BINS], const struct sah *sah, const struct sah_prim *prim,
                    int axis, const float *planes, int first, int last) {
  struct outline outline;
  find_outline(&outline, sah, prim);
  struct cuts cuts = {.prim = prim, .outline = &outline, .axis = axis, .first = first, .last = last, .planes = planes};
  if (!cut_at_once(&cuts))
    cut_one_by_one(&cuts);
  memcpy(parts, cuts.box, sizeof cuts.box);
}

static inline struct sah_box as_vectors(const struct scene_box *box) {
  return (struct sah_box){_mm_set_ps(0, box->min[2], box->min[1], box->min[0]),
                          _mm_set_ps(0, box->max[2], box->max[1], box->max[0])};
}

/* outline: of the primitive, without a triangle: not yet found. */
static void fill_axis(struct spatial_bins *bins, const struct sah *sah, const struct sah_prim *prim,
                      struct outline *outline, int axis, int low, int high, const float *planes) {
  const struct sah_box box = sah_box_of(prim);
  bins->begin[low][axis]++;
  bins->end[high][axis]++;
  struct cuts cuts = {.prim = prim, .outline = outline, .axis = axis, .first = low, .last = high, .planes = planes};
  while (cuts.first < cuts.last && planes[cuts.first + 1] <= prim->min[axis])
    cuts.first++;
  while (cuts.first < cuts.last && planes[cuts.last] >= prim->max[axis])
    cuts.last--;
  if (cuts.first == cuts.last) {
    sah_extend(&bins->boxes[cuts.first][axis], &box);
    return;
  }
  if (!outline->triangle[0])
    find_outline(outline, sah, prim);
  if (!cut_at_once(&cuts))
    cut_one_by_one(&cuts);
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
    struct outline outline;
    outline.triangle[0] = NULL;
    for (int axis = 0; axis < 3; axis++)
      if (scale[axis] != 0)
        fill_axis(bins, sah, prim, &outline, axis, low[axis], high[axis], planes[axis]);
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
  sah_sweep(&split, BINS, (const struct sah_box(*)[3])bins.boxes, (const uint32_t(*)[4])bins.begin,
            (const uint32_t(*)[4])bins.end);
  size_t parts = 0; /* on both sides of the best split */
  for (int i = 0; i < BINS && split.axis >= 0; i++)
    parts += (i < split.bin ? bins.begin : bins.end)[i][split.axis];
  if (split.axis >= 0)
    split.position = planes[split.axis][split.bin];
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
    const uint32_t *vertices = sah->mesh->triangles[prim->triangle].vertices;
    const float *corners[3];
    for (int corner = 0; corner < 3; corner++)
      corners[corner] = sah->mesh->vertices[vertices[corner]];
    const struct scene_box box = {{prim->min[0], prim->min[1], prim->min[2]},
                                  {prim->max[0], prim->max[1], prim->max[2]}};
    struct scene_box sides[2];
    scene_split_triangle(corners, &box, split->axis, split->position, sides);
    if (is_empty(&sides[0]) || is_empty(&sides[1]))
      continue;
    sah->prims[set->end++] = part_of(prim, &sides[1]);
    *prim = part_of(prim, &sides[0]);
  }
}
