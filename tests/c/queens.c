// RUN: %run_c %s %t
// Queens on a board: by bits with recursion, and with an explicit stack.
#include <stdio.h>

__attribute__((noinline)) static int place(unsigned free, unsigned left, unsigned right, unsigned all) {
  int found = free == 0;
  for (unsigned open = free & ~(left | right); open; open &= open - 1) {
    unsigned bit = open & -open;
    found += place(free ^ bit, (left | bit) << 1 & all, (right | bit) >> 1, all);
  }
  return found;
}

static int column[8];
static int safe(int row) {
  for (int above = 0; above < row; above++) {
    int d = column[row] - column[above];
    if (d == 0 || d == row - above || d == above - row)
      return 0;
  }
  return 1;
}

__attribute__((noinline)) static int first(int n) {
  int row = 0, tries = 0;
  column[0] = 0;
  while (row < n) {
    while (column[row] < n && !safe(row))
      column[row]++, tries++;
    if (column[row] == n) {
      if (row-- == 0)
        return -1;
      column[row]++;
    } else if (++row < n)
      column[row] = 0;
  }
  return tries;
}

int main(void) {
  for (int n = 1; n <= 6; n++)
    printf("%d ", place((1u << n) - 1, 0, 0, (1u << n) - 1));
  printf("\n%d ", first(3));
  printf("%d\n", first(6));
  for (int i = 0; i < 6; i++)
    printf("%d", column[i]);
  puts("");
  return 0;
}
