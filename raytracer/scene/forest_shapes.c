/* Random numbers and shapes of the generated forest. */
#include "forest.h"

#include <string.h>

void forest_make_circle(struct point *circle) {
  const struct point corners[] = {{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}};
  for (int i = 0; i <= CIRCLE; i += CIRCLE / 4)
    circle[i] = corners[i / (CIRCLE / 4) % 4];
  for (int step = CIRCLE / 4; step > 1; step /= 2)
    for (int i = 0; i < CIRCLE; i += step)
      circle[i + step / 2] = unit(plus(circle[i], 1, circle[i + step]));
}

/* splitmix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014) */
uint64_t forest_scramble(uint64_t x) {
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
  x = (x ^ x >> 27) * 0x94D049BB133111EBu;
  return x ^ x >> 31;
}

double forest_between(struct forest *forest, double low, double high) {
  forest->random += 0x9E3779B97F4A7C15u;
  return low + (high - low) * ((double)(forest_scramble(forest->random) >> 11) * 0x1p-53);
}

static uint32_t forest_number_below(struct forest *forest, uint32_t limit) {
  return (uint32_t)forest_between(forest, 0, limit);
}

struct point forest_direction(struct forest *forest) {
  return forest->circle[forest_number_below(forest, CIRCLE)];
}

static double lattice(uint64_t seed, int64_t x, int64_t z) {
  uint64_t number = forest_scramble(seed + (uint64_t)x * 0x9E3779B97F4A7C15u + (uint64_t)z * 0xD1B54A32D192ED03u);
  return (double)(number >> 11) * 0x1p-52 - 1;
}

double forest_noise(uint64_t seed, double x, double z) {
  int64_t column = (int64_t)(x + 65536) - 65536, row = (int64_t)(z + 65536) - 65536; /* rounded down */
  double u = x - (double)column, v = z - (double)row;
  u = u * u * (3 - 2 * u), v = v * v * (3 - 2 * v);
  double near = lattice(seed, column, row) * (1 - u) + lattice(seed, column + 1, row) * u;
  double far = lattice(seed, column, row + 1) * (1 - u) + lattice(seed, column + 1, row + 1) * u;
  return near * (1 - v) + far * v;
}

/* --- triangles --- */

uint32_t forest_vertex(struct forest *forest, struct point p) {
  struct trax_mesh *mesh = forest->mesh;
  if (!scene_grow(&mesh->vertices, sizeof *mesh->vertices, mesh->vertex_count, &forest->vertex_capacity)) {
    forest->failed = true;
    return 0;
  }
  float *place = mesh->vertices[mesh->vertex_count];
  place[0] = (float)p.x, place[1] = (float)p.y, place[2] = (float)p.z;
  return mesh->vertex_count++;
}

void forest_triangle(struct forest *forest, enum material material, uint32_t a, uint32_t b, uint32_t c) {
  struct trax_mesh *mesh = forest->mesh;
  if (!scene_grow(&mesh->triangles, sizeof *mesh->triangles, mesh->triangle_count, &forest->triangle_capacity)) {
    forest->failed = true;
    return;
  }
  mesh->triangles[mesh->triangle_count] =
      (struct trax_mesh_triangle){{a, b, c}, (uint32_t)material, mesh->triangle_count};
  mesh->triangle_count++;
}

void forest_quad(struct forest *forest, enum material material, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  forest_triangle(forest, material, a, b, c);
  forest_triangle(forest, material, a, c, d);
}

enum { MOST_SIDES = 48 };

void forest_tube(struct forest *forest, enum material material, const struct ring *rings, uint32_t count,
                 uint32_t sides) {
  uint32_t last[MOST_SIDES + 1] = {0}, next[MOST_SIDES + 1];
  for (uint32_t r = 0; r < count; r++) {
    const struct ring *from = &rings[r > 0 ? r - 1 : 0], *to = &rings[r + 1 < count ? r + 1 : r];
    struct point axis = plus(to->middle, -1, from->middle);
    axis = axis.x == 0 && axis.y == 0 && axis.z == 0 ? (struct point){0, 1, 0} : unit(axis);
    struct point aside = unit(cross(axis, axis.x * axis.x > 0.7 ? (struct point){0, 0, 1} : (struct point){1, 0, 0}));
    struct point across = cross(axis, aside);
    for (uint32_t s = 0; s < sides; s++) {
      if (s > 0 && rings[r].radius == 0) {
        next[s] = next[0];
        continue;
      }
      struct point round = forest->circle[s * CIRCLE / sides];
      next[s] = forest_vertex(
          forest, plus(plus(rings[r].middle, rings[r].radius * round.x, aside), rings[r].radius * round.z, across));
    }
    next[sides] = next[0];
    for (uint32_t s = 0; r > 0 && s < sides; s++)
      if (rings[r].radius == 0)
        forest_triangle(forest, material, last[s], last[s + 1], next[s]);
      else if (rings[r - 1].radius == 0)
        forest_triangle(forest, material, last[s], next[s + 1], next[s]);
      else
        forest_quad(forest, material, last[s], last[s + 1], next[s + 1], next[s]);
    memcpy(last, next, sizeof last);
  }
}

void forest_leaf(struct forest *forest, enum material material, struct point at, struct point along, double length,
                 double width) {
  struct point aside = unit(cross(along, along.y * along.y > 0.9 ? (struct point){1, 0, 0} : (struct point){0, 1, 0}));
  struct point up = cross(aside, along), middle = plus(plus(at, 0.45 * length, along), 0.2 * width, up);
  uint32_t base = forest_vertex(forest, at), tip = forest_vertex(forest, plus(at, length, along));
  forest_triangle(forest, material, base, tip, forest_vertex(forest, plus(middle, 0.5 * width, aside)));
  forest_triangle(forest, material, tip, base, forest_vertex(forest, plus(middle, -0.5 * width, aside)));
}
