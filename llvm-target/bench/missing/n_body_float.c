/* Five bodies under gravity, in single precision: square roots and fused multiply-adds. */
#include "../bench.h"

#include <math.h>

enum { BODIES = 5, STEPS = 200 };
struct body {
  float x, y, z, vx, vy, vz, mass;
};
static const struct body start[BODIES] = {{0, 0, 0, 0, 0, 0, 39.5f},
                                          {4.84f, -1.16f, -0.10f, 0.606f, 2.81f, -0.02f, 0.037f},
                                          {8.34f, 4.12f, -0.4f, -1.01f, 1.82f, 0.008f, 0.011f},
                                          {12.9f, -15.1f, -0.22f, 1.08f, 0.868f, -0.01f, 0.0017f},
                                          {15.4f, -25.9f, 0.179f, 0.979f, 0.594f, -0.034f, 0.002f}};
static struct body bodies[BODIES];

void kernel_setup(void) {}

static void advance(float dt) {
  for (int i = 0; i < BODIES; i++) {
    struct body *a = &bodies[i];
    for (int j = i + 1; j < BODIES; j++) {
      struct body *b = &bodies[j];
      float dx = a->x - b->x, dy = a->y - b->y, dz = a->z - b->z;
      float square = dx * dx + dy * dy + dz * dz;
      float strength = dt / (square * sqrtf(square));
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
    advance(0.01f);
  uint32_t checksum = 0;
  float sum = 0;
  for (int i = 0; i < BODIES; i++) {
    checksum = mix_float(mix_float(mix_float(checksum, bodies[i].x), bodies[i].y), bodies[i].z);
    sum += bodies[i].x;
  }
  return (struct result){checksum, sum / BODIES};
}
