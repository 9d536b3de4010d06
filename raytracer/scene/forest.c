/* A forest that is generated from a number: a large ground, trees, and a clearing with many detailed objects far below
   the scene's scale. It resembles the fairy forest of the ray-tracing literature, which is not available, and has its
   174,117 triangles. y is up; the ground is 4,000 units wide, the clearing 12, a blade of grass 0.2.

   The same seed gives the same bytes on every host: random numbers are integers, and floating-point operations are
   those that IEEE 754 defines to the bit. libm is not used; angles are places in a table made by bisection. */
#include "internal.h"

#include <stdlib.h>
#include <string.h>

enum { FOREST_TRIANGLES = 174117, GRID = 96, CIRCLE = 1024 };

enum material { EARTH, BARK, LEAF, FIR, GRASS, STALK, CAP, STONE, PETAL, POLLEN, SHELL, SLIME, NEEDLE, MATERIALS };

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

/* --- arithmetic that is the same everywhere --- */

static struct point plus(struct point a, double factor, struct point b) {
  return (struct point){a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}

static struct point cross(struct point a, struct point b) {
  return (struct point){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static struct point unit(struct point a) {
  double length = __builtin_sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
  return (struct point){a.x / length, a.y / length, a.z / length};
}

static void make_circle(struct point *circle) {
  const struct point corners[] = {{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}};
  for (int i = 0; i <= CIRCLE; i += CIRCLE / 4)
    circle[i] = corners[i / (CIRCLE / 4) % 4];
  for (int step = CIRCLE / 4; step > 1; step /= 2)
    for (int i = 0; i < CIRCLE; i += step)
      circle[i + step / 2] = unit(plus(circle[i], 1, circle[i + step]));
}

/* splitmix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014) */
static uint64_t scramble(uint64_t x) {
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
  x = (x ^ x >> 27) * 0x94D049BB133111EBu;
  return x ^ x >> 31;
}

static double between(struct forest *forest, double low, double high) {
  forest->random += 0x9E3779B97F4A7C15u;
  return low + (high - low) * ((double)(scramble(forest->random) >> 11) * 0x1p-53);
}

static uint32_t number_below(struct forest *forest, uint32_t limit) {
  return (uint32_t)between(forest, 0, limit);
}

static struct point direction(struct forest *forest) {
  return forest->circle[number_below(forest, CIRCLE)];
}

/* Smooth noise within -1 and 1, from random numbers at whole coordinates. */
static double lattice(uint64_t seed, int64_t x, int64_t z) {
  uint64_t number = scramble(seed + (uint64_t)x * 0x9E3779B97F4A7C15u + (uint64_t)z * 0xD1B54A32D192ED03u);
  return (double)(number >> 11) * 0x1p-52 - 1;
}

static double noise(uint64_t seed, double x, double z) {
  int64_t column = (int64_t)(x + 65536) - 65536, row = (int64_t)(z + 65536) - 65536; /* rounded down */
  double u = x - (double)column, v = z - (double)row;
  u = u * u * (3 - 2 * u), v = v * v * (3 - 2 * v);
  double near = lattice(seed, column, row) * (1 - u) + lattice(seed, column + 1, row) * u;
  double far = lattice(seed, column, row + 1) * (1 - u) + lattice(seed, column + 1, row + 1) * u;
  return near * (1 - v) + far * v;
}

/* --- triangles --- */

static uint32_t vertex(struct forest *forest, struct point p) {
  struct trax_mesh *mesh = forest->mesh;
  if (!scene_grow(&mesh->vertices, sizeof *mesh->vertices, mesh->vertex_count, &forest->vertex_capacity)) {
    forest->failed = true;
    return 0;
  }
  float *place = mesh->vertices[mesh->vertex_count];
  place[0] = (float)p.x, place[1] = (float)p.y, place[2] = (float)p.z;
  return mesh->vertex_count++;
}

static void triangle(struct forest *forest, enum material material, uint32_t a, uint32_t b, uint32_t c) {
  struct trax_mesh *mesh = forest->mesh;
  if (!scene_grow(&mesh->triangles, sizeof *mesh->triangles, mesh->triangle_count, &forest->triangle_capacity)) {
    forest->failed = true;
    return;
  }
  mesh->triangles[mesh->triangle_count] =
      (struct trax_mesh_triangle){{a, b, c}, (uint32_t)material, mesh->triangle_count};
  mesh->triangle_count++;
}

static void quad(struct forest *forest, enum material material, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  triangle(forest, material, a, b, c);
  triangle(forest, material, a, c, d);
}

/* A tube around a line of points, with a ring at each; a ring of radius 0 is a point. */
struct ring {
  struct point middle;
  double radius;
};

enum { MOST_SIDES = 48 };

static void tube(struct forest *forest, enum material material, const struct ring *rings, uint32_t count,
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
      next[s] = vertex(
          forest, plus(plus(rings[r].middle, rings[r].radius * round.x, aside), rings[r].radius * round.z, across));
    }
    next[sides] = next[0];
    for (uint32_t s = 0; r > 0 && s < sides; s++)
      if (rings[r].radius == 0)
        triangle(forest, material, last[s], last[s + 1], next[s]);
      else if (rings[r - 1].radius == 0)
        triangle(forest, material, last[s], next[s + 1], next[s]);
      else
        quad(forest, material, last[s], last[s + 1], next[s + 1], next[s]);
    memcpy(last, next, sizeof last);
  }
}

/* A leaf: two triangles with a fold along the middle. */
static void leaf(struct forest *forest, enum material material, struct point at, struct point along, double length,
                 double width) {
  struct point aside = unit(cross(along, along.y * along.y > 0.9 ? (struct point){1, 0, 0} : (struct point){0, 1, 0}));
  struct point up = cross(aside, along), middle = plus(plus(at, 0.45 * length, along), 0.2 * width, up);
  uint32_t base = vertex(forest, at), tip = vertex(forest, plus(at, length, along));
  triangle(forest, material, base, tip, vertex(forest, plus(middle, 0.5 * width, aside)));
  triangle(forest, material, tip, base, vertex(forest, plus(middle, -0.5 * width, aside)));
}

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
      double y = 45 * hills * (noise(forest->seed, x / 310, z / 310) + 0.4 * noise(forest->seed + 1, x / 90, z / 90)) +
                 0.35 * noise(forest->seed + 2, x / 5, z / 5) + 0.05 * noise(forest->seed + 3, x / 0.7, z / 0.7);
      forest->height[row][column] = y;
      vertex(forest, (struct point){x, y, z});
    }
  for (uint32_t row = 0; row < GRID; row++)
    for (uint32_t column = 0; column < GRID; column++) {
      uint32_t corner = row * (GRID + 1) + column;
      quad(forest, EARTH, corner, corner + GRID + 1, corner + GRID + 2, corner + 1);
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
  double radius = __builtin_sqrt(between(forest, least * least, most * most));
  struct point way = direction(forest);
  return on_ground(forest, radius * way.x, radius * way.z);
}

/* --- plants and stones --- */

static void broadleaf(struct forest *forest, struct point foot) {
  double height = between(forest, 9, 16), radius = 0.035 * height;
  struct point lean = direction(forest), top = plus(foot, height, (struct point){0, 1, 0});
  struct ring trunk[7];
  for (int i = 0; i < 7; i++) {
    struct point bend = plus(foot, i * height / 6, (struct point){0, 1, 0});
    trunk[i] = (struct ring){plus(bend, 0.002 * height * i * i, lean), radius * (7 - i) / 7};
  }
  trunk[0].middle.y -= 0.3;
  top = plus(top, 0.072 * height, lean);
  tube(forest, BARK, trunk, 7, 8);
  for (int branch = 0; branch < 14; branch++) {
    struct point way = direction(forest), from = trunk[2 + branch % 4].middle;
    double length = between(forest, 0.18, 0.36) * height;
    struct ring bough[4];
    for (int i = 0; i < 4; i++)
      bough[i] = (struct ring){plus(plus(from, length * i / 3, way), 0.06 * length * i * i, (struct point){0, 1, 0}),
                               0.35 * radius * (4 - i) / 4};
    tube(forest, BARK, bough, 4, 5);
    for (int i = 0; i < 24; i++) {
      struct point along = direction(forest), at = plus(bough[1 + i % 3].middle, between(forest, 0, 0.9), along);
      at.y += between(forest, -0.5, 0.9);
      along.y = between(forest, -0.6, 0.4);
      double size = between(forest, 0.5, 1);
      leaf(forest, LEAF, at, unit(along), size, 0.6 * size);
    }
  }
  for (int i = 0; i < 40; i++) {
    struct point along = direction(forest);
    along.y = between(forest, -0.3, 1);
    struct point at = plus(top, between(forest, 0, 1.2), along);
    leaf(forest, LEAF, at, unit(along), between(forest, 0.5, 1), 0.5);
  }
}

static void fir(struct forest *forest, struct point foot) {
  double height = between(forest, 11, 22), radius = 0.02 * height;
  struct point up = {0, 1, 0};
  struct ring trunk[4];
  for (int i = 0; i < 4; i++)
    trunk[i] = (struct ring){plus(foot, i * height / 3 - 0.3, up), radius * (3 - i) / 3};
  tube(forest, BARK, trunk, 4, 8);
  for (int tier = 0; tier < 11; tier++) {
    double part = (tier + 2) / 13.0, reach = 0.24 * height * (1.05 - part);
    for (int i = 0; i < 20; i++) {
      struct point along = direction(forest);
      along.y = between(forest, -0.5, -0.2);
      leaf(forest, FIR, plus(foot, height * part, up), unit(along), reach * between(forest, 0.8, 1.1), 0.35 * reach);
    }
  }
}

static void tuft(struct forest *forest, struct point foot, double size) {
  for (int blade = 0; blade < 9; blade++) {
    struct point way = direction(forest), aside = {way.z, 0, -way.x}, root = plus(foot, 0.15 * size, way);
    double width = 0.05 * size, height = size * between(forest, 0.6, 1), bend = size * between(forest, 0.1, 0.4);
    struct point middle = plus(plus(root, 0.6 * height, (struct point){0, 1, 0}), 0.3 * bend, way);
    struct point tip = plus(plus(root, height, (struct point){0, 1, 0}), bend, way);
    uint32_t a = vertex(forest, plus(root, -width, aside)), b = vertex(forest, plus(root, width, aside));
    uint32_t c = vertex(forest, plus(middle, 0.8 * width, aside)),
             d = vertex(forest, plus(middle, -0.8 * width, aside));
    quad(forest, GRASS, a, b, c, d);
    triangle(forest, GRASS, d, c, vertex(forest, tip));
  }
}

static void mushroom(struct forest *forest, struct point foot, double size) {
  struct point up = {0, 1, 0}, lean = direction(forest), top = plus(plus(foot, size, up), 0.15 * size, lean);
  const struct ring stalk[] = {{plus(foot, -0.05 * size, up), 0.16 * size},
                               {plus(plus(foot, 0.3 * size, up), 0.03 * size, lean), 0.12 * size},
                               {plus(plus(foot, 0.7 * size, up), 0.09 * size, lean), 0.10 * size},
                               {top, 0.09 * size}};
  tube(forest, STALK, stalk, 4, 12);
  struct ring cap[9];
  for (int i = 0; i < 8; i++) { /* a quarter of the circle, and back to the stalk below */
    struct point arc = forest->circle[i * CIRCLE / 4 / 7];
    cap[i] = (struct ring){plus(top, 0.38 * size * arc.z, up), i == 7 ? 0 : 0.5 * size * arc.x};
  }
  tube(forest, CAP, cap, 8, 20);
  const struct ring gills[] = {{plus(top, -0.02 * size, up), 0.05 * size}, {top, 0.5 * size}};
  tube(forest, STALK, gills, 2, 20);
}

static void flower(struct forest *forest, struct point foot, double size) {
  struct point up = {0, 1, 0}, lean = direction(forest);
  struct ring stem[3];
  for (int i = 0; i < 3; i++)
    stem[i] = (struct ring){plus(plus(foot, 0.5 * size * i, up), 0.05 * size * i * i, lean), 0.02 * size};
  tube(forest, GRASS, stem, 3, 5);
  const struct point head = stem[2].middle;
  for (int petal = 0; petal < 9; petal++) {
    struct point along = forest->circle[petal * CIRCLE / 9];
    along.y = 0.35;
    leaf(forest, PETAL, plus(head, 0.05 * size, up), unit(along), 0.3 * size, 0.16 * size);
  }
  const struct ring bud[] = {
      {head, 0.08 * size}, {plus(head, 0.07 * size, up), 0.06 * size}, {plus(head, 0.1 * size, up), 0}};
  tube(forest, POLLEN, bud, 3, 8);
}

/* An octahedron whose faces are divided; corners that faces share are the same to the bit. */
static struct point stone_corner(const struct forest *forest, struct point way, struct point at, double size) {
  double bump = 1 + 0.25 * noise(forest->seed + 4, 5 * at.x + 2 * way.x + way.y, 5 * at.z + 2 * way.z - way.y);
  return (struct point){at.x + size * bump * way.x, at.y + 0.6 * size * bump * way.y, at.z + size * bump * way.z};
}

static void stone_face(struct forest *forest, struct point a, struct point b, struct point c, int depth,
                       struct point at, double size) {
  if (depth == 0) {
    uint32_t first = vertex(forest, stone_corner(forest, a, at, size));
    uint32_t second = vertex(forest, stone_corner(forest, b, at, size));
    triangle(forest, STONE, first, second, vertex(forest, stone_corner(forest, c, at, size)));
    return;
  }
  struct point ab = unit(plus(a, 1, b)), bc = unit(plus(b, 1, c)), ca = unit(plus(c, 1, a));
  stone_face(forest, a, ab, ca, depth - 1, at, size);
  stone_face(forest, b, bc, ab, depth - 1, at, size);
  stone_face(forest, c, ca, bc, depth - 1, at, size);
  stone_face(forest, ab, bc, ca, depth - 1, at, size);
}

static void stone(struct forest *forest, struct point at, double size) {
  for (int face = 0; face < 8; face++) {
    struct point x = {face & 1 ? -1 : 1, 0, 0}, y = {0, face & 2 ? -1 : 1, 0}, z = {0, 0, face & 4 ? -1 : 1};
    stone_face(forest, x, y, z, 3, at, size);
  }
}

/* A snail, a few hundredths of the clearing, with more triangles than ten trees. */
static void snail(struct forest *forest, struct point foot, double size) {
  enum { TURNS = 4, PER_TURN = 60, RINGS = TURNS * PER_TURN };
  struct ring shell[RINGS];
  double radius = 0.012 * size;
  const struct point middle = {foot.x, foot.y + 0.55 * size, foot.z};
  for (int i = 0; i < RINGS; i++, radius *= 1.0102) {
    struct point arc = forest->circle[i % PER_TURN * CIRCLE / PER_TURN];
    shell[i] = (struct ring){
        {middle.x + 2.1 * radius * arc.x, middle.y + 2.1 * radius * arc.z, middle.z + 0.5 * size - 3.2 * radius},
        i == 0 ? 0 : radius};
  }
  tube(forest, SHELL, shell, RINGS, 32);
  struct ring body[24];
  for (int i = 0; i < 24; i++) {
    double u = (i - 11.5) / 11.5;
    body[i] =
        (struct ring){{foot.x + size * u, foot.y + (u > 0.5 ? 1.6 * size * (u - 0.5) * (u - 0.5) : 0) + 0.08 * size,
                       foot.z + 0.2 * size},
                      i == 0 || i == 23 ? 0 : 0.16 * size * (1 - u * u * u * u)};
  }
  tube(forest, SLIME, body, 24, 24);
}

/* --- the whole --- */

/* Plants `count` objects of these sizes between two circles. */
static void scatter(struct forest *forest, void (*plant)(struct forest *, struct point, double), int count,
                    double nearest, double farthest, double smallest, double largest) {
  for (int i = 0; i < count; i++) {
    struct point at = somewhere(forest, nearest, farthest);
    plant(forest, at, between(forest, smallest, largest));
  }
}

static void grow(struct forest *forest) {
  make_ground(forest);
  snail(forest, on_ground(forest, 0.3, 0.2), 0.45);
  for (int i = 0; i < 32; i++)
    broadleaf(forest, somewhere(forest, 11, 80));
  for (int i = 0; i < 60; i++)
    fir(forest, somewhere(forest, 13, 240));
  scatter(forest, mushroom, 46, 0.8, 5, 0.12, 0.6);
  scatter(forest, stone, 24, 1, 9, 0.1, 0.7);
  scatter(forest, flower, 150, 0.6, 7, 0.25, 0.6);
  while (forest->mesh->triangle_count < FOREST_TRIANGLES - 3000 && !forest->failed)
    scatter(forest, tuft, 1, 0.4, 11, 0.1, 0.35);
  /* The rest are needles on the ground, a triangle each. */
  while (forest->mesh->triangle_count < FOREST_TRIANGLES && !forest->failed) {
    struct point at = somewhere(forest, 0, 8), way = direction(forest);
    at.y += 0.004;
    uint32_t a = vertex(forest, at), b = vertex(forest, plus(at, 0.09, way));
    triangle(forest, NEEDLE, a, b,
             vertex(forest, plus(plus(at, 0.05, way), 0.012, (struct point){way.z, 0.6, -way.x})));
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
  *forest = (struct forest){.mesh = mesh, .seed = scramble(seed + 0x9E3779B97F4A7C15u)};
  forest->random = forest->seed;
  make_circle(forest->circle);
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
  fir(forest, (struct point){0, 0, 0});
}

trax_status scene_generate_fir(struct trax_mesh *mesh, uint64_t seed, trax_error *error) {
  return generate(mesh, seed, grow_fir, error);
}
