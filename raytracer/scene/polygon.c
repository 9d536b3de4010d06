/* Cuts polygons into triangles by ears, in the coordinate plane that is most perpendicular to Newell's normal. */
#include "internal.h"

#include <math.h>
#include <stdlib.h>

struct point {
  double x, y;
};

/* Newell's method: the sum of the edges' areas on the three coordinate planes. */
static void newell_normal(double normal[3], float (*positions)[3], const uint32_t *corners, uint32_t count) {
  normal[0] = normal[1] = normal[2] = 0;
  for (uint32_t i = 0; i < count; i++) {
    const float *a = positions[corners[i]], *b = positions[corners[i + 1 < count ? i + 1 : 0]];
    normal[0] += ((double)a[1] - b[1]) * ((double)a[2] + b[2]);
    normal[1] += ((double)a[2] - b[2]) * ((double)a[0] + b[0]);
    normal[2] += ((double)a[0] - b[0]) * ((double)a[1] + b[1]);
  }
}

/* Drops the axis along which the normal is longest; the polygon is then counter-clockwise. */
static void project(struct point *points, float (*positions)[3], const uint32_t *corners, uint32_t count) {
  double normal[3];
  newell_normal(normal, positions, corners, count);
  int drop = fabs(normal[0]) > fabs(normal[1]) ? 0 : 1;
  if (fabs(normal[2]) > fabs(normal[drop]))
    drop = 2;
  int x = (drop + 1) % 3, y = (drop + 2) % 3;
  bool flip = normal[drop] < 0;
  for (uint32_t i = 0; i < count; i++) {
    const float *position = positions[corners[i]];
    points[i] = flip ? (struct point){position[y], position[x]} : (struct point){position[x], position[y]};
  }
}

/* Twice the signed area of a triangle. */
static double turn(struct point a, struct point b, struct point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Whether p prevents cutting the triangle off. A point at its corners does not; polygons with holes have such. */
static bool is_inside(struct point p, struct point a, struct point b, struct point c) {
  if ((p.x == a.x && p.y == a.y) || (p.x == b.x && p.y == b.y) || (p.x == c.x && p.y == c.y))
    return false;
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

/* Whether the corner b between a and c can be cut off: it is convex and no other point lies in the triangle. */
static bool is_ear(const struct point *points, const uint32_t *ring, uint32_t count, uint32_t at) {
  uint32_t before = at ? at - 1 : count - 1, after = at + 1 < count ? at + 1 : 0;
  struct point a = points[ring[before]], b = points[ring[at]], c = points[ring[after]];
  if (!(turn(a, b, c) > 0))
    return false;
  const double left = fmin(a.x, fmin(b.x, c.x)), right = fmax(a.x, fmax(b.x, c.x));
  const double low = fmin(a.y, fmin(b.y, c.y)), high = fmax(a.y, fmax(b.y, c.y));
  for (uint32_t i = 0; i < count; i++) {
    if (i == before || i == at || i == after)
      continue;
    struct point p = points[ring[i]];
    if (p.x < left || p.x > right || p.y < low || p.y > high)
      continue;
    if (is_inside(p, a, b, c))
      return false;
  }
  return true;
}

static bool is_stopped(const struct scene_polygon_work *work) {
  return work->steps >= SCENE_POLYGON_STEPS || scene_is_interrupted(work->interrupt);
}

/* Convex polygons of at most this many corners are not counted as steps: a file may have any number of them. */
enum { FEW_CORNERS = 1024 };

static const char too_hard[] = "a polygon that takes too long to be cut into triangles; export triangles instead";
static const char no_memory[] = "not enough memory for a polygon";

const char *scene_cut_polygon(struct scene_polygon_work *work, float (*positions)[3], const uint32_t *corners,
                              uint32_t count, const uint32_t (**triangles)[3]) {
  if (count > work->capacity) {
    const struct scene_polygon_work old = *work;
    scene_polygon_work_release(work);
    work->steps = old.steps;
    work->interrupt = old.interrupt;
    work->points = malloc(count * sizeof(struct point));
    work->ring = malloc(count * sizeof *work->ring);
    work->triangles = malloc(count * sizeof *work->triangles);
    if (!work->points || !work->ring || !work->triangles)
      return no_memory;
    work->capacity = count;
  }
  struct point *points = work->points;
  *triangles = (const uint32_t(*)[3])work->triangles;
  project(points, positions, corners, count);
  uint32_t *ring = work->ring, left = count, made = 0;
  for (uint32_t i = 0; i < count; i++)
    ring[i] = i;
  /* If no ear is left (the polygon crosses itself, or has no area), any corner is cut off. */
  bool search = true;
  for (uint32_t at = 1; left > 2;) {
    for (uint32_t tried = 0; search && !is_ear(points, ring, left, at); search = tried < left) {
      at = at + 1 < left ? at + 1 : 0;
      tried++;
      work->steps += left;
      if (is_stopped(work))
        return too_hard;
    }
    work->steps += count > FEW_CORNERS ? left : 0;
    if (is_stopped(work))
      return too_hard;
    uint32_t before = at ? at - 1 : left - 1, after = at + 1 < left ? at + 1 : 0;
    work->triangles[made][0] = ring[before];
    work->triangles[made][1] = ring[at];
    work->triangles[made][2] = ring[after];
    made++;
    left--;
    for (uint32_t i = at; i < left; i++)
      ring[i] = ring[i + 1];
    if (at >= left)
      at = 0;
  }
  return NULL;
}

void scene_polygon_work_release(struct scene_polygon_work *work) {
  free(work->points);
  free(work->ring);
  free(work->triangles);
  *work = (struct scene_polygon_work){0};
}
