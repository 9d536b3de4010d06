#include <stdio.h>
struct pair {
  int first;
  float second;
};
int total;
static const int table[4] = {1, 2, 3, 4};

__attribute__((noinline)) int walk(struct pair *p, int depth) {
  int local = depth * 2;
  if (depth == 0)
    return p->first + local;
  int below = walk(p, depth - 1);
  total += below;
  return below + local + table[depth & 3];
}

int main(void) {
  struct pair p = {7, 1.5f};
  int result = walk(&p, 3);
  printf("%d\n", result);
  return result & 0x3f;
}
