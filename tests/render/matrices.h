/* The first three rows of matrices that place meshes, row by row. */
#ifndef TRAX_TEST_MATRICES_H
#define TRAX_TEST_MATRICES_H

#include <math.h>

struct matrix {
  double m[3][4];
};

static const struct matrix identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

static inline struct matrix product(struct matrix a, struct matrix b) {
  struct matrix out;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 4; k++)
      out.m[i][k] = a.m[i][0] * b.m[0][k] + a.m[i][1] * b.m[1][k] + a.m[i][2] * b.m[2][k] + (k == 3 ? a.m[i][3] : 0);
  return out;
}

static inline struct matrix scaled(double x, double y, double z) {
  return (struct matrix){{{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}}};
}

static inline struct matrix moved(double x, double y, double z) {
  return (struct matrix){{{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}}};
}

static inline struct matrix turned(double angle, int axis) {
  struct matrix out = identity;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  out.m[u][u] = out.m[v][v] = cos(angle);
  out.m[u][v] = -sin(angle);
  out.m[v][u] = sin(angle);
  return out;
}

#endif
