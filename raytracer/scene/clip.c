/* Triangles cut by axis-parallel planes, in binary64. */
#include "internal.h"

#include <math.h>
#include <string.h>

unsigned scene_clip_polygon(double (*restrict out)[3], unsigned most, const double (*restrict in)[3], unsigned count,
                            int axis, double sign, double plane) {
  unsigned kept = 0;
  for (unsigned i = 0; i < count && kept + 2 <= most; i++) {
    const double *a = in[i], *b = in[i + 1 < count ? i + 1 : 0];
    const double da = sign * (a[axis] - plane), db = sign * (b[axis] - plane);
    if (da >= 0)
      memcpy(out[kept++], a, sizeof out[0]);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      double *cut = out[kept++];
      for (int other = 0; other < 3; other++)
        cut[other] = a[other] + da / (da - db) * (b[other] - a[other]);
      cut[axis] = plane;
    }
  }
  return kept;
}

struct bounds {
  double min[3], max[3];
};

static const struct bounds nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static inline void add_value(struct bounds *bounds, int axis, double value) {
  bounds->min[axis] = value < bounds->min[axis] ? value : bounds->min[axis];
  bounds->max[axis] = value > bounds->max[axis] ? value : bounds->max[axis];
}

/* The bounds, rounded outwards but not beyond the box; the box if they are empty, since less than rounding is in it. */
static struct scene_box rounded(const struct bounds *bounds, const struct scene_box *box) {
  struct scene_box result = *box;
  for (int axis = 0; axis < 3 && bounds->min[0] <= bounds->max[0]; axis++) {
    const float low = scene_next_float((float)bounds->min[axis], false),
                high = scene_next_float((float)bounds->max[axis], true);
    result.min[axis] = low > box->min[axis] ? low : box->min[axis];
    result.max[axis] = high < box->max[axis] ? high : box->max[axis];
  }
  return result;
}

struct scene_box scene_clip_triangle(const float *const corners[3], const struct scene_box *box) {
  enum { MOST = 10 }; /* three, one more for each plane, and one that scene_clip_polygon asks for */
  double polygons[2][MOST][3];
  unsigned now = 0, count = 3;
  for (int corner = 0; corner < 3; corner++)
    for (int axis = 0; axis < 3; axis++)
      polygons[0][corner][axis] = corners[corner][axis];
  for (int side = 0; side < 6; side++) {
    const int axis = side >> 1;
    const double sign = side & 1 ? -1 : 1, plane = side & 1 ? box->max[axis] : box->min[axis];
    bool cuts = false;
    for (unsigned i = 0; i < count; i++)
      cuts |= sign * (polygons[now][i][axis] - plane) < 0;
    if (!cuts) /* as most planes: the box of a part is little smaller than that of the triangle */
      continue;
    count = scene_clip_polygon(polygons[!now], MOST, polygons[now], count, axis, sign, plane);
    now = !now;
  }
  struct bounds bounds = nothing;
  for (unsigned i = 0; i < count; i++)
    for (int axis = 0; axis < 3; axis++)
      add_value(&bounds, axis, polygons[now][i][axis]);
  return rounded(&bounds, box);
}

/* Finds the bounds on both sides of a triangle that is whole, by one walk along its edges. */
static void split_whole(const float *const corners[3], int axis, float position, struct bounds sides[2]) {
  for (int corner = 0; corner < 3; corner++) {
    const float *a = corners[corner], *b = corners[corner < 2 ? corner + 1 : 0];
    const double da = (double)a[axis] - position, db = (double)b[axis] - position;
    for (int side = 0; side < 2; side++)
      for (int other = 0; other < 3 && (side ? da >= 0 : da <= 0); other++)
        add_value(&sides[side], other, a[other]);
    if ((da < 0 && db > 0) || (da > 0 && db < 0))
      for (int other = 0; other < 3; other++) {
        const double value = other == axis ? position : a[other] + da / (da - db) * ((double)b[other] - a[other]);
        add_value(&sides[0], other, value);
        add_value(&sides[1], other, value);
      }
  }
}

void scene_split_triangle(const float *const corners[3], const struct scene_box *box, int axis, float position,
                          struct scene_box parts[2]) {
  bool whole = true;
  for (int corner = 0; corner < 3; corner++)
    for (int other = 0; other < 3; other++)
      whole &= (corners[corner][other] >= box->min[other]) & (corners[corner][other] <= box->max[other]);
  parts[0] = parts[1] = *box;
  parts[0].max[axis] = parts[1].min[axis] = position;
  if (whole) {
    struct bounds sides[2] = {nothing, nothing};
    split_whole(corners, axis, position, sides);
    for (int side = 0; side < 2; side++)
      parts[side] = rounded(&sides[side], &parts[side]);
  } else
    for (int side = 0; side < 2; side++)
      parts[side] = scene_clip_triangle(corners, &parts[side]);
}
