/* A forest that is generated from a number: a large ground, trees, and a clearing with many detailed objects far below
   the scene's scale. It resembles the fairy forest of the ray-tracing literature, which is not available, and has its
   174,117 triangles. y is up; the ground is 4,000 units wide, the clearing 12, a blade of grass 0.2.

   The same seed gives the same bytes on every host: random numbers are integers, and floating-point operations are
   those that IEEE 754 defines to the bit. libm is not used; angles are places in a table made by bisection. */
#include "forest.h"

#include <stdlib.h>
#include <string.h>

enum { FOREST_TRIANGLES = 174117 };

#define MATTE(...) {.diffuse = {__VA_ARGS__}, .ior = 1, .opacity = 1}

static const struct trax_mesh_material forest_materials[MATERIALS] = {
    [EARTH] = {"earth", MATTE(0.30f, 0.24f, 0.14f)},   [BARK] = {"bark", MATTE(0.28f, 0.19f, 0.12f)},
    [LEAF] = {"leaf", MATTE(0.20f, 0.42f, 0.10f)},     [FIR] = {"fir", MATTE(0.08f, 0.26f, 0.11f)},
    [GRASS] = {"grass", MATTE(0.30f, 0.52f, 0.12f)},   [STALK] = {"stalk", MATTE(0.85f, 0.80f, 0.68f)},
    [CAP] = {"cap", MATTE(0.72f, 0.10f, 0.06f)},       [STONE] = {"stone", MATTE(0.46f, 0.45f, 0.43f)},
    [PETAL] = {"petal", MATTE(0.75f, 0.55f, 0.85f)},   [POLLEN] = {"pollen", MATTE(0.90f, 0.72f, 0.10f)},
    [SHELL] = {"shell", MATTE(0.62f, 0.38f, 0.16f)},   [SLIME] = {"snail", MATTE(0.70f, 0.62f, 0.45f)},
    [NEEDLE] = {"needle", MATTE(0.42f, 0.26f, 0.12f)},
};

/* --- the ground --- */

/* Lines are close together in the clearing, so that the ground is as detailed as the objects on it. */
static void make_ground(struct forest *forest) {
  for (int i = 0; i <= GRID; i++) {
    double u = (double)(2 * i - GRID) / GRID;
    forest->line[i] = 8 * u + 1992 * u * u * u * u * u;
  }
  for (int row = 0; row <= GRID; row++)
    for (int column = 0; column <= GRID; column++) {
      double x = forest->line[column], z = forest->line[row], square = x * x + z * z;
      double hills = square / (square + 3600); /* flat in the middle */
      double y =
          45 * hills *
              (forest_noise(forest->seed, x / 310, z / 310) + 0.4 * forest_noise(forest->seed + 1, x / 90, z / 90)) +
          0.35 * forest_noise(forest->seed + 2, x / 5, z / 5) + 0.05 * forest_noise(forest->seed + 3, x / 0.7, z / 0.7);
      forest->height[row][column] = y;
      forest_vertex(forest, (struct point){x, y, z});
    }
  for (uint32_t row = 0; row < GRID; row++)
    for (uint32_t column = 0; column < GRID; column++) {
      uint32_t corner = row * (GRID + 1) + column;
      forest_quad(forest, EARTH, corner, corner + GRID + 1, corner + GRID + 2, corner + 1);
    }
}

static int cell_of(const struct forest *forest, double place) {
  int low = 0, high = GRID;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (forest->line[middle] <= place)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* A point on the ground's own triangles. */
static struct point on_ground(const struct forest *forest, double x, double z) {
  int column = cell_of(forest, x), row = cell_of(forest, z);
  double u = (x - forest->line[column]) / (forest->line[column + 1] - forest->line[column]);
  double v = (z - forest->line[row]) / (forest->line[row + 1] - forest->line[row]);
  const double *near = &forest->height[row][column], *far = &forest->height[row + 1][column];
  double y = v > u ? near[0] + v * (far[0] - near[0]) + u * (far[1] - far[0])
                   : near[0] + u * (near[1] - near[0]) + v * (far[1] - near[1]);
  return (struct point){x, y, z};
}

/* A random point between two circles around the middle of the clearing. */
static struct point somewhere(struct forest *forest, double least, double most) {
  double radius = __builtin_sqrt(forest_between(forest, least * least, most * most));
  struct point way = forest_direction(forest);
  return on_ground(forest, radius * way.x, radius * way.z);
}

/* --- the whole --- */

/* Plants `count` objects of these sizes between two circles. */
static void scatter(struct forest *forest, void (*plant)(struct forest *, struct point, double), int count,
                    double nearest, double farthest, double smallest, double largest) {
  for (int i = 0; i < count; i++) {
    struct point at = somewhere(forest, nearest, farthest);
    plant(forest, at, forest_between(forest, smallest, largest));
  }
}

static void grow(struct forest *forest) {
  make_ground(forest);
  forest_snail(forest, on_ground(forest, 0.3, 0.2), 0.45);
  for (int i = 0; i < 32; i++)
    forest_broadleaf(forest, somewhere(forest, 11, 80));
  for (int i = 0; i < 60; i++)
    forest_fir(forest, somewhere(forest, 13, 240));
  scatter(forest, forest_mushroom, 46, 0.8, 5, 0.12, 0.6);
  scatter(forest, forest_stone, 24, 1, 9, 0.1, 0.7);
  scatter(forest, forest_flower, 150, 0.6, 7, 0.25, 0.6);
  while (forest->mesh->triangle_count < FOREST_TRIANGLES - 3000 && !forest->failed)
    scatter(forest, forest_tuft, 1, 0.4, 11, 0.1, 0.35);
  /* The rest are needles on the ground, a triangle each. */
  while (forest->mesh->triangle_count < FOREST_TRIANGLES && !forest->failed) {
    struct point at = somewhere(forest, 0, 8), way = forest_direction(forest);
    at.y += 0.004;
    uint32_t a = forest_vertex(forest, at), b = forest_vertex(forest, plus(at, 0.09, way));
    forest_triangle(forest, NEEDLE, a, b,
                    forest_vertex(forest, plus(plus(at, 0.05, way), 0.012, (struct point){way.z, 0.6, -way.x})));
  }
}

static trax_status generate(struct trax_mesh *mesh, uint64_t seed, void (*grow_it)(struct forest *),
                            trax_error *error) {
  *mesh = (struct trax_mesh){0};
  struct forest *forest = calloc(1, sizeof *forest);
  mesh->materials = malloc(sizeof forest_materials);
  if (!forest || !mesh->materials) {
    free(forest);
    trax_mesh_release(mesh);
    return scene_out_of_memory(error, "forest");
  }
  memcpy(mesh->materials, forest_materials, sizeof forest_materials);
  mesh->material_count = MATERIALS;
  *forest = (struct forest){.mesh = mesh, .seed = forest_scramble(seed + 0x9E3779B97F4A7C15u)};
  forest->random = forest->seed;
  forest_make_circle(forest->circle);
  grow_it(forest);
  const bool failed = forest->failed;
  free(forest);
  if (!failed)
    return TRAX_OK;
  trax_mesh_release(mesh);
  return scene_out_of_memory(error, "forest");
}

trax_status scene_generate_forest(struct trax_mesh *mesh, uint64_t seed, trax_error *error) {
  return generate(mesh, seed, grow, error);
}

static void grow_fir(struct forest *forest) {
  forest_fir(forest, (struct point){0, 0, 0});
}

trax_status scene_generate_fir(struct trax_mesh *mesh, uint64_t seed, trax_error *error) {
  return generate(mesh, seed, grow_fir, error);
}
