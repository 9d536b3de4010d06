/* Counts the steps for which points of the plane stay near 0. */
#include "../bench.h"

enum { WIDTH = 64, HEIGHT = 48, LIMIT = 100 };
static unsigned char steps[HEIGHT][WIDTH];

void kernel_setup(void) {}

static int escape(float cx, float cy) {
  float x = 0, y = 0;
  int n = 0;
  while (n < LIMIT && x * x + y * y <= 4.0f) {
    float next = x * x - y * y + cx;
    y = 2.0f * x * y + cy;
    x = next;
    n++;
  }
  return n;
}

struct result kernel_run(void) {
  uint32_t checksum = 0;
  float sum =
      0; /* mostly of points far from the set: those at its edge take any number of steps, after each rounding */
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++)
      steps[y][x] = (unsigned char)escape(-2.0f + 3.0f / WIDTH * (float)x, -1.2f + 2.4f / HEIGHT * (float)y);
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++) {
      checksum = mix(checksum, steps[y][x]);
      sum += 1.0f / (float)(steps[y][x] + 1);
    }
  return (struct result){checksum, sum / (WIDTH * HEIGHT)};
}
