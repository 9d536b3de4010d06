// RUN: %run_c %s %t
// Bodies under gravity in binary32, to the bit; sqrtf and division are correctly rounded, so the orbits agree with any
// machine's.
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BODIES = 4 };
static struct body {
  float position[3], velocity[3], mass;
} bodies[BODIES] = {
    {{0, 0, 0}, {0, 0, 0}, 1},
    {{1, 0, 0.1f}, {0, 1, 0}, 0.001f},
    {{-2, 0.5f, 0}, {0.1f, -0.7f, 0.05f}, 0.01f},
    {{0, 3, -1}, {-0.55f, 0, 0.1f}, 0.005f},
};

__attribute__((noinline)) static void step(float dt) {
  for (int i = 0; i < BODIES; i++)
    for (int j = i + 1; j < BODIES; j++) {
      float d[3], square = 0.0001f;
      for (int k = 0; k < 3; k++) {
        d[k] = bodies[i].position[k] - bodies[j].position[k];
        square += d[k] * d[k];
      }
      float strength = dt / (square * sqrtf(square));
      for (int k = 0; k < 3; k++) {
        bodies[i].velocity[k] -= d[k] * bodies[j].mass * strength;
        bodies[j].velocity[k] += d[k] * bodies[i].mass * strength;
      }
    }
  for (int i = 0; i < BODIES; i++)
    for (int k = 0; k < 3; k++)
      bodies[i].position[k] += dt * bodies[i].velocity[k];
}

__attribute__((noinline)) static float energy(void) {
  float e = 0;
  for (int i = 0; i < BODIES; i++) {
    const float *v = bodies[i].velocity;
    e += 0.5f * bodies[i].mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int j = i + 1; j < BODIES; j++) {
      float square = 0;
      for (int k = 0; k < 3; k++) {
        float d = bodies[i].position[k] - bodies[j].position[k];
        square += d * d;
      }
      e -= bodies[i].mass * bodies[j].mass / sqrtf(square);
    }
  }
  return e;
}

__attribute__((noinline)) static void show(float x) {
  unsigned u;
  memcpy(&u, &x, 4);
  printf("%08x ", u);
}

int main(void) {
  float before = energy();
  for (int i = 0; i < 50; i++)
    step(0.01f);
  for (int i = 0; i < BODIES; i++) {
    for (int k = 0; k < 3; k++)
      show(bodies[i].position[k]);
    puts("");
  }
  show(energy());
  puts(fabsf(energy() - before) < 0.001f ? "kept" : "lost");
  return 0;
}
