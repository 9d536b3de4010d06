// RUN: %run_c %s %t --levels -O0,-O2,-Oz
// Conway's Life on rows of 64 bits, the neighbours counted in parallel.
#include <stdint.h>
#include <stdio.h>

enum { ROWS = 16 };
static uint64_t board[2][ROWS + 2];

static uint64_t rotate(uint64_t x, int n) {
  return x << n | x >> (64 - n);
}

__attribute__((noinline)) static void generation(const uint64_t *from, uint64_t *to) {
  for (int row = 1; row <= ROWS; row++) {
    uint64_t ones = 0, twos = 0, fours = 0;
    for (int d = -1; d <= 1; d++)
      for (int shift = 63; shift <= 65; shift++) {
        if (d == 0 && shift == 64)
          continue;
        uint64_t x = shift == 64 ? from[row + d] : rotate(from[row + d], shift % 64);
        uint64_t carry = ones & x;
        ones ^= x;
        fours |= twos & carry;
        twos ^= carry;
      }
    to[row] = twos & ~fours & (ones | from[row]);
  }
  to[0] = to[ROWS];
  to[ROWS + 1] = to[1];
}

static void set(int x, int y) {
  board[0][y + 1] |= 1ull << x;
}

int main(void) {
  static const char *const acorn[] = {".o.....", "...o...", "oo..ooo"};
  for (int y = 0; y < 3; y++)
    for (int x = 0; x < 7; x++)
      if (acorn[y][x] == 'o')
        set(x + 30, y + 6);
  set(1, 0), set(2, 1), set(0, 2), set(1, 2), set(2, 2);
  for (int i = 0; i < 60; i++) {
    generation(board[i & 1], board[~i & 1]);
    if (i % 15 == 14) {
      int alive = 0;
      for (int row = 1; row <= ROWS; row++)
        alive += __builtin_popcountll(board[~i & 1][row]);
      printf("%d %016llx\n", alive, (unsigned long long)board[~i & 1][8]);
    }
  }
  return 0;
}
