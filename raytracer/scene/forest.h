/* The parts of the generated forest (forest.c). */
#ifndef TRAX_SCENE_FOREST_H
#define TRAX_SCENE_FOREST_H

#include "internal.h"

enum { GRID = 96, CIRCLE = 1024 };

enum material { EARTH, BARK, LEAF, FIR, GRASS, STALK, CAP, STONE, PETAL, POLLEN, SHELL, SLIME, NEEDLE, MATERIALS };

struct point {
  double x, y, z;
};

struct forest {
  struct trax_mesh *mesh;
  size_t vertex_capacity, triangle_capacity;
  bool failed; /* out of memory */
  uint64_t random, seed;
  struct point circle[CIRCLE + 1]; /* cosine and sine in x and z; one more for the way round */
  double line[GRID + 1];           /* the ground's grid: places of its lines, the same in x and z */
  double height[GRID + 1][GRID + 1];
};

static inline struct point plus(struct point a, double factor, struct point b) {
  return (struct point){a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}

static inline struct point cross(struct point a, struct point b) {
  return (struct point){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline struct point unit(struct point a) {
  double length = __builtin_sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
  return (struct point){a.x / length, a.y / length, a.z / length};
}

struct ring {
  struct point middle;
  double radius;
};

/* --- forest_shapes.c --- */

void forest_make_circle(struct point *circle);
uint64_t forest_scramble(uint64_t x);
/* Random. */
double forest_between(struct forest *forest, double low, double high);
struct point forest_direction(struct forest *forest);
/* Smooth noise within -1 and 1, from random numbers at whole coordinates. */
double forest_noise(uint64_t seed, double x, double z);

uint32_t forest_vertex(struct forest *forest, struct point p);
void forest_triangle(struct forest *forest, enum material material, uint32_t a, uint32_t b, uint32_t c);
void forest_quad(struct forest *forest, enum material material, uint32_t a, uint32_t b, uint32_t c, uint32_t d);
/* A tube around a line of points, with a ring at each; a ring of radius 0 is a point. */
void forest_tube(struct forest *forest, enum material material, const struct ring *rings, uint32_t count,
                 uint32_t sides);
/* Two triangles with a fold along the middle. */
void forest_leaf(struct forest *forest, enum material material, struct point at, struct point along, double length,
                 double width);

/* --- forest_plants.c --- */

void forest_broadleaf(struct forest *forest, struct point foot);
void forest_fir(struct forest *forest, struct point foot);
void forest_tuft(struct forest *forest, struct point foot, double size);
void forest_mushroom(struct forest *forest, struct point foot, double size);
void forest_flower(struct forest *forest, struct point foot, double size);
void forest_stone(struct forest *forest, struct point at, double size);
/* A few hundredths of the clearing, with more triangles than ten trees. */
void forest_snail(struct forest *forest, struct point foot, double size);

#endif
