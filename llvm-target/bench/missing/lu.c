/* Linear equations by LU decomposition, with integers: divisions between short loops, the inner ones triangular. */
#include "../bench.h"

enum { SIZE = 6, SYSTEMS = 100 };

static int matrix[SIZE][SIZE], right[SIZE], solution[SIZE];

void kernel_setup(void) {}

static void fill(uint32_t *random) {
  for (int i = 0; i < SIZE; i++) {
    for (int j = 0; j < SIZE; j++)
      matrix[i][j] = (i + j + 2) * (i == j ? 200 : 100) + (int)(next_random(random) >> 28);
    right[i] = (int)(next_random(random) >> 12);
  }
}

static void decompose(int size) {
  for (int i = 0; i < size - 1; i++) {
    for (int j = i + 1; j < size; j++) {
      int rest = matrix[j][i];
      for (int k = 0; k < i; k++)
        rest -= matrix[j][k] * matrix[k][i];
      matrix[j][i] = rest / (matrix[i][i] | 1);
    }
    for (int j = i + 1; j < size; j++) {
      int rest = matrix[i + 1][j];
      for (int k = 0; k <= i; k++)
        rest -= matrix[i + 1][k] * matrix[k][j];
      matrix[i + 1][j] = rest;
    }
  }
}

static void substitute(int size) {
  int between[SIZE];
  for (int i = 0; i < size; i++) {
    int rest = right[i];
    for (int j = 0; j < i; j++)
      rest -= matrix[i][j] * between[j];
    between[i] = rest;
  }
  for (int i = size - 1; i >= 0; i--) {
    int rest = between[i];
    for (int j = i + 1; j < size; j++)
      rest -= matrix[i][j] * solution[j];
    solution[i] = rest / (matrix[i][i] | 1);
  }
}

struct result kernel_run(void) {
  uint32_t random = 36, checksum = 0;
  for (int system = 0; system < SYSTEMS; system++) {
    volatile int size = SIZE; /* so that loops are not replaced by their iterations */
    fill(&random);
    decompose(size);
    substitute(size);
    for (int i = 0; i < SIZE; i++)
      checksum = mix(checksum, (uint32_t)solution[i]);
  }
  return (struct result){checksum, 0};
}
