/* Conway's life on a torus. */
#include "../bench.h"

enum { SIDE = 48, GENERATIONS = 8 };
static unsigned char cells[2][SIDE][SIDE];

void kernel_setup(void) {}

static void generation(unsigned char from[SIDE][SIDE], unsigned char to[SIDE][SIDE]) {
  for (int y = 0; y < SIDE; y++) {
    int above = (y + SIDE - 1) % SIDE, below = (y + 1) % SIDE;
    for (int x = 0; x < SIDE; x++) {
      int left = x == 0 ? SIDE - 1 : x - 1, right = x == SIDE - 1 ? 0 : x + 1;
      int neighbours = from[above][left] + from[above][x] + from[above][right] + from[y][left] + from[y][right] +
                       from[below][left] + from[below][x] + from[below][right];
      to[y][x] = neighbours == 3 || (neighbours == 2 && from[y][x]);
    }
  }
}

struct result kernel_run(void) {
  uint32_t random = 6, checksum = 0;
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++)
      cells[0][y][x] = next_random(&random) >> 30 == 0;
  for (int i = 0; i < GENERATIONS; i++)
    generation(cells[i & 1], cells[~i & 1]);
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++)
      checksum = mix(checksum, cells[0][y][x]);
  return (struct result){checksum, 0};
}
