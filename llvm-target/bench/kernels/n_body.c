/* Five bodies under gravity, in double precision, which is the library's on both machines; missing/n_body_float.c
   defines another. */
#include "../bench.h"

#include <tgmath.h>

#ifndef REAL
#define REAL double
#define STEPS 10
#endif

enum { BODIES = 5 };
struct body {
  REAL x, y, z, vx, vy, vz, mass;
};
static const struct body start[BODIES] = {{0, 0, 0, 0, 0, 0, 39.5},
                                          {4.84, -1.16, -0.10, 0.606, 2.81, -0.02, 0.037},
                                          {8.34, 4.12, -0.4, -1.01, 1.82, 0.008, 0.011},
                                          {12.9, -15.1, -0.22, 1.08, 0.868, -0.01, 0.0017},
                                          {15.4, -25.9, 0.179, 0.979, 0.594, -0.034, 0.002}};
static struct body bodies[BODIES];

void kernel_setup(void) {}

static void advance(REAL dt) {
  for (int i = 0; i < BODIES; i++) {
    struct body *a = &bodies[i];
    for (int j = i + 1; j < BODIES; j++) {
      struct body *b = &bodies[j];
      REAL dx = a->x - b->x, dy = a->y - b->y, dz = a->z - b->z;
      REAL square = dx * dx + dy * dy + dz * dz;
      REAL strength = dt / (square * sqrt(square));
      a->vx -= dx * b->mass * strength;
      a->vy -= dy * b->mass * strength;
      a->vz -= dz * b->mass * strength;
      b->vx += dx * a->mass * strength;
      b->vy += dy * a->mass * strength;
      b->vz += dz * a->mass * strength;
    }
  }
  for (int i = 0; i < BODIES; i++) {
    bodies[i].x += dt * bodies[i].vx;
    bodies[i].y += dt * bodies[i].vy;
    bodies[i].z += dt * bodies[i].vz;
  }
}

struct result kernel_run(void) {
  for (int i = 0; i < BODIES; i++)
    bodies[i] = start[i];
  for (int i = 0; i < STEPS; i++)
    advance((REAL)0.01);
  uint32_t checksum = 0;
  REAL sum = 0;
  for (int i = 0; i < BODIES; i++) {
    checksum = mix_float(mix_float(mix_float(checksum, (float)bodies[i].x), (float)bodies[i].y), (float)bodies[i].z);
    sum += bodies[i].x;
  }
  return (struct result){checksum, (float)(sum / BODIES)};
}
