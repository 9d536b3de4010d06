/* Plants and stones of the generated forest. */
#include "forest.h"

void forest_broadleaf(struct forest *forest, struct point foot) {
  double height = forest_between(forest, 9, 16), radius = 0.035 * height;
  struct point lean = forest_direction(forest), top = plus(foot, height, (struct point){0, 1, 0});
  struct ring trunk[7];
  for (int i = 0; i < 7; i++) {
    struct point bend = plus(foot, i * height / 6, (struct point){0, 1, 0});
    trunk[i] = (struct ring){plus(bend, 0.002 * height * i * i, lean), radius * (7 - i) / 7};
  }
  trunk[0].middle.y -= 0.3;
  top = plus(top, 0.072 * height, lean);
  forest_tube(forest, BARK, trunk, 7, 8);
  for (int branch = 0; branch < 14; branch++) {
    struct point way = forest_direction(forest), from = trunk[2 + branch % 4].middle;
    double length = forest_between(forest, 0.18, 0.36) * height;
    struct ring bough[4];
    for (int i = 0; i < 4; i++)
      bough[i] = (struct ring){plus(plus(from, length * i / 3, way), 0.06 * length * i * i, (struct point){0, 1, 0}),
                               0.35 * radius * (4 - i) / 4};
    forest_tube(forest, BARK, bough, 4, 5);
    for (int i = 0; i < 24; i++) {
      struct point along = forest_direction(forest),
                   at = plus(bough[1 + i % 3].middle, forest_between(forest, 0, 0.9), along);
      at.y += forest_between(forest, -0.5, 0.9);
      along.y = forest_between(forest, -0.6, 0.4);
      double size = forest_between(forest, 0.5, 1);
      forest_leaf(forest, LEAF, at, unit(along), size, 0.6 * size);
    }
  }
  for (int i = 0; i < 40; i++) {
    struct point along = forest_direction(forest);
    along.y = forest_between(forest, -0.3, 1);
    struct point at = plus(top, forest_between(forest, 0, 1.2), along);
    forest_leaf(forest, LEAF, at, unit(along), forest_between(forest, 0.5, 1), 0.5);
  }
}

void forest_fir(struct forest *forest, struct point foot) {
  double height = forest_between(forest, 11, 22), radius = 0.02 * height;
  struct point up = {0, 1, 0};
  struct ring trunk[4];
  for (int i = 0; i < 4; i++)
    trunk[i] = (struct ring){plus(foot, i * height / 3 - 0.3, up), radius * (3 - i) / 3};
  forest_tube(forest, BARK, trunk, 4, 8);
  for (int tier = 0; tier < 11; tier++) {
    double part = (tier + 2) / 13.0, reach = 0.24 * height * (1.05 - part);
    for (int i = 0; i < 20; i++) {
      struct point along = forest_direction(forest);
      along.y = forest_between(forest, -0.5, -0.2);
      forest_leaf(forest, FIR, plus(foot, height * part, up), unit(along), reach * forest_between(forest, 0.8, 1.1),
                  0.35 * reach);
    }
  }
}

void forest_tuft(struct forest *forest, struct point foot, double size) {
  for (int blade = 0; blade < 9; blade++) {
    struct point way = forest_direction(forest), aside = {way.z, 0, -way.x}, root = plus(foot, 0.15 * size, way);
    double width = 0.05 * size, height = size * forest_between(forest, 0.6, 1),
           bend = size * forest_between(forest, 0.1, 0.4);
    struct point middle = plus(plus(root, 0.6 * height, (struct point){0, 1, 0}), 0.3 * bend, way);
    struct point tip = plus(plus(root, height, (struct point){0, 1, 0}), bend, way);
    uint32_t a = forest_vertex(forest, plus(root, -width, aside)), b = forest_vertex(forest, plus(root, width, aside));
    uint32_t c = forest_vertex(forest, plus(middle, 0.8 * width, aside)),
             d = forest_vertex(forest, plus(middle, -0.8 * width, aside));
    forest_quad(forest, GRASS, a, b, c, d);
    forest_triangle(forest, GRASS, d, c, forest_vertex(forest, tip));
  }
}

void forest_mushroom(struct forest *forest, struct point foot, double size) {
  struct point up = {0, 1, 0}, lean = forest_direction(forest), top = plus(plus(foot, size, up), 0.15 * size, lean);
  const struct ring stalk[] = {{plus(foot, -0.05 * size, up), 0.16 * size},
                               {plus(plus(foot, 0.3 * size, up), 0.03 * size, lean), 0.12 * size},
                               {plus(plus(foot, 0.7 * size, up), 0.09 * size, lean), 0.10 * size},
                               {top, 0.09 * size}};
  forest_tube(forest, STALK, stalk, 4, 12);
  struct ring cap[9];
  for (int i = 0; i < 8; i++) { /* a quarter of the circle, and back to the stalk below */
    struct point arc = forest->circle[i * CIRCLE / 4 / 7];
    cap[i] = (struct ring){plus(top, 0.38 * size * arc.z, up), i == 7 ? 0 : 0.5 * size * arc.x};
  }
  forest_tube(forest, CAP, cap, 8, 20);
  const struct ring gills[] = {{plus(top, -0.02 * size, up), 0.05 * size}, {top, 0.5 * size}};
  forest_tube(forest, STALK, gills, 2, 20);
}

void forest_flower(struct forest *forest, struct point foot, double size) {
  struct point up = {0, 1, 0}, lean = forest_direction(forest);
  struct ring stem[3];
  for (int i = 0; i < 3; i++)
    stem[i] = (struct ring){plus(plus(foot, 0.5 * size * i, up), 0.05 * size * i * i, lean), 0.02 * size};
  forest_tube(forest, GRASS, stem, 3, 5);
  const struct point head = stem[2].middle;
  for (int petal = 0; petal < 9; petal++) {
    struct point along = forest->circle[petal * CIRCLE / 9];
    along.y = 0.35;
    forest_leaf(forest, PETAL, plus(head, 0.05 * size, up), unit(along), 0.3 * size, 0.16 * size);
  }
  const struct ring bud[] = {
      {head, 0.08 * size}, {plus(head, 0.07 * size, up), 0.06 * size}, {plus(head, 0.1 * size, up), 0}};
  forest_tube(forest, POLLEN, bud, 3, 8);
}

/* An octahedron whose faces are divided; corners that faces share are the same to the bit. */
static struct point stone_corner(const struct forest *forest, struct point way, struct point at, double size) {
  double bump = 1 + 0.25 * forest_noise(forest->seed + 4, 5 * at.x + 2 * way.x + way.y, 5 * at.z + 2 * way.z - way.y);
  return (struct point){at.x + size * bump * way.x, at.y + 0.6 * size * bump * way.y, at.z + size * bump * way.z};
}

static void stone_face(struct forest *forest, struct point a, struct point b, struct point c, int depth,
                       struct point at, double size) {
  if (depth == 0) {
    uint32_t first = forest_vertex(forest, stone_corner(forest, a, at, size));
    uint32_t second = forest_vertex(forest, stone_corner(forest, b, at, size));
    forest_triangle(forest, STONE, first, second, forest_vertex(forest, stone_corner(forest, c, at, size)));
    return;
  }
  struct point ab = unit(plus(a, 1, b)), bc = unit(plus(b, 1, c)), ca = unit(plus(c, 1, a));
  stone_face(forest, a, ab, ca, depth - 1, at, size);
  stone_face(forest, b, bc, ab, depth - 1, at, size);
  stone_face(forest, c, ca, bc, depth - 1, at, size);
  stone_face(forest, ab, bc, ca, depth - 1, at, size);
}

void forest_stone(struct forest *forest, struct point at, double size) {
  for (int face = 0; face < 8; face++) {
    struct point x = {face & 1 ? -1 : 1, 0, 0}, y = {0, face & 2 ? -1 : 1, 0}, z = {0, 0, face & 4 ? -1 : 1};
    stone_face(forest, x, y, z, 3, at, size);
  }
}

void forest_snail(struct forest *forest, struct point foot, double size) {
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
  forest_tube(forest, SHELL, shell, RINGS, 32);
  struct ring body[24];
  for (int i = 0; i < 24; i++) {
    double u = (i - 11.5) / 11.5;
    body[i] =
        (struct ring){{foot.x + size * u, foot.y + (u > 0.5 ? 1.6 * size * (u - 0.5) * (u - 0.5) : 0) + 0.08 * size,
                       foot.z + 0.2 * size},
                      i == 0 || i == 23 ? 0 : 0.16 * size * (1 - u * u * u * u)};
  }
  forest_tube(forest, SLIME, body, 24, 24);
}
