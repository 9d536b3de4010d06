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

/* Whether p prevents cutting the triangle off. Points at one of its corners do not; polygons with holes have such. */
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

/* --- many corners --- */

/* With more corners than this, only those that are not convex are tested, by a grid of cells. In a simple polygon, if
   any corner is in an ear, one that is not convex is. */
enum { FEW_CORNERS = 1024, MOST_CELLS = 1024 };

struct grid {
  const struct point *points;
  uint32_t *before, *after; /* the ring */
  uint32_t *next;           /* corner in the same cell; NONE */
  uint32_t *cells;          /* first corners; NONE */
  unsigned char *reflex;    /* of each corner in the ring: it is not convex */
  struct point least;
  double scale_x, scale_y;
  uint32_t side;
};

#define NONE UINT32_MAX

static uint32_t cell_of(double value, double least, double scale, uint32_t side) {
  const double cell = (value - least) * scale;
  return !(cell > 0) ? 0 : cell >= side ? side - 1 : (uint32_t)cell;
}

static bool is_reflex(const struct grid *grid, uint32_t corner) {
  const struct point *points = grid->points;
  return !(turn(points[grid->before[corner]], points[corner], points[grid->after[corner]]) > 0);
}

/* The part of a triangle between two heights, from left to right, with its bounds. */
struct span {
  double left, right;
};

static void add_edge(struct span *span, struct point a, struct point b, double low, double high) {
  if (a.y > b.y) {
    const struct point c = a;
    a = b, b = c;
  }
  if (a.y > high || b.y < low)
    return;
  const double slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0;
  const double from = a.y < low ? a.x + (low - a.y) * slope : a.x, to = b.y > high ? a.x + (high - a.y) * slope : b.x;
  span->left = fmin(span->left, fmin(from, to));
  span->right = fmax(span->right, fmax(from, to));
}

/* Tests the cells that the triangle touches, row by row, and one more at either end of each row. */
static bool is_empty(const struct grid *grid, uint32_t before, uint32_t at, uint32_t after, uint64_t *steps) {
  const struct point a = grid->points[before], b = grid->points[at], c = grid->points[after];
  const uint32_t low = cell_of(fmin(a.y, fmin(b.y, c.y)), grid->least.y, grid->scale_y, grid->side);
  const uint32_t high = cell_of(fmax(a.y, fmax(b.y, c.y)), grid->least.y, grid->scale_y, grid->side);
  const double height = grid->scale_y > 0 ? 1 / grid->scale_y : INFINITY;
  for (uint32_t y = low; y <= high; y++) {
    struct span span = {INFINITY, -INFINITY};
    const double bottom = grid->least.y + (y - 0.01) * height, top = grid->least.y + (y + 1.01) * height;
    add_edge(&span, a, b, bottom, top);
    add_edge(&span, b, c, bottom, top);
    add_edge(&span, c, a, bottom, top);
    uint32_t left = cell_of(span.left, grid->least.x, grid->scale_x, grid->side);
    uint32_t right = cell_of(span.right, grid->least.x, grid->scale_x, grid->side);
    left -= left > 0;
    right += right + 1 < grid->side;
    for (uint32_t x = left; x <= right; x++) {
      ++*steps;
      for (uint32_t i = grid->cells[y * grid->side + x]; i != NONE; i = grid->next[i]) {
        ++*steps;
        if (grid->reflex[i] && i != before && i != at && i != after && is_inside(grid->points[i], a, b, c))
          return false;
      }
    }
  }
  return true;
}

/* The same as is_ear. */
static bool is_ear_in(const struct grid *grid, uint32_t at, uint64_t *steps) {
  const uint32_t before = grid->before[at], after = grid->after[at];
  ++*steps;
  return turn(grid->points[before], grid->points[at], grid->points[after]) > 0 &&
         is_empty(grid, before, at, after, steps);
}

static void fill_grid(struct grid *grid, uint32_t count) {
  struct point most = grid->least = grid->points[0];
  uint32_t reflex = 0;
  for (uint32_t i = 0; i < count; i++) {
    grid->before[i] = i ? i - 1 : count - 1;
    grid->after[i] = i + 1 < count ? i + 1 : 0;
    const struct point p = grid->points[i];
    grid->least = (struct point){fmin(grid->least.x, p.x), fmin(grid->least.y, p.y)};
    most = (struct point){fmax(most.x, p.x), fmax(most.y, p.y)};
  }
  for (uint32_t i = 0; i < count; i++)
    reflex += grid->reflex[i] = is_reflex(grid, i);
  for (grid->side = 1; grid->side < MOST_CELLS && grid->side * grid->side < reflex;)
    grid->side *= 2;
  grid->scale_x = most.x > grid->least.x ? grid->side / (most.x - grid->least.x) : 0;
  grid->scale_y = most.y > grid->least.y ? grid->side / (most.y - grid->least.y) : 0;
  for (uint32_t i = 0; i < grid->side * grid->side; i++)
    grid->cells[i] = NONE;
  for (uint32_t i = 0; i < count; i++) {
    if (!grid->reflex[i])
      continue;
    const uint32_t x = cell_of(grid->points[i].x, grid->least.x, grid->scale_x, grid->side);
    const uint32_t y = cell_of(grid->points[i].y, grid->least.y, grid->scale_y, grid->side);
    grid->next[i] = grid->cells[y * grid->side + x];
    grid->cells[y * grid->side + x] = i;
  }
}

static bool is_stopped(const struct scene_polygon_work *work) {
  return work->steps >= SCENE_POLYGON_STEPS || scene_is_interrupted(work->interrupt);
}

static const char too_hard[] = "a polygon that takes too long to be cut into triangles";
static const char no_memory[] = "not enough memory for a polygon";

static const char *cut_large(struct scene_polygon_work *work, uint32_t count) {
  uint32_t *links = malloc((3 * (size_t)count + MOST_CELLS * MOST_CELLS) * sizeof *links);
  unsigned char *reflex = malloc(count);
  if (!links || !reflex) {
    free(links);
    free(reflex);
    return no_memory;
  }
  struct grid grid = {.points = work->points,
                      .before = links,
                      .after = links + count,
                      .next = links + 2 * (size_t)count,
                      .cells = links + 3 * (size_t)count,
                      .reflex = reflex};
  fill_grid(&grid, count);
  bool search = true;
  uint32_t at = 1, made = 0, near[2] = {0, 2}; /* the corners beside the last cut, whose angles have changed */
  for (uint32_t left = count; left > 2 && !is_stopped(work); left--) {
    for (uint32_t tried = 0; search && !is_ear_in(&grid, at, &work->steps); search = tried < left) {
      const bool first = tried == 0 && is_ear_in(&grid, near[1], &work->steps);
      if (first || (tried == 0 && is_ear_in(&grid, near[0], &work->steps))) {
        at = near[first];
        break;
      }
      at = grid.after[at];
      if (++tried % 4096 == 0 && is_stopped(work))
        break;
    }
    const uint32_t before = grid.before[at], after = grid.after[at];
    work->triangles[made][0] = before;
    work->triangles[made][1] = at;
    work->triangles[made][2] = after;
    made++;
    grid.after[before] = after;
    grid.before[after] = before;
    reflex[at] = 0;
    reflex[before] &= is_reflex(&grid, before);
    reflex[after] &= is_reflex(&grid, after);
    near[0] = before, near[1] = after;
    at = grid.after[after]; /* not the next one, which would make a fan of slivers across the polygon */
  }
  free(links);
  free(reflex);
  return made == count - 2 ? NULL : too_hard;
}

/* --- any polygon --- */

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
  if (count > FEW_CORNERS)
    return cut_large(work, count);
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
    }
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
  return work->steps < SCENE_POLYGON_STEPS ? NULL : too_hard;
}

void scene_polygon_work_release(struct scene_polygon_work *work) {
  free(work->points);
  free(work->ring);
  free(work->triangles);
  *work = (struct scene_polygon_work){0};
}
