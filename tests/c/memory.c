// RUN: %run_c %s %t
// memcpy, memmove, memset and memcmp at every alignment, and copies that the compiler expands.
#include <stdio.h>
#include <string.h>

static unsigned char a[80], b[80];

__attribute__((noinline)) static unsigned hash(const unsigned char *p, int n) {
  unsigned h = 0;
  for (int i = 0; i < n; i++)
    h = h * 31 + p[i];
  return h;
}

struct block {
  int v[9];
};
static struct block from, to;

int main(void) {
  for (int i = 0; i < 80; i++)
    a[i] = (unsigned char)(i * 7 + 3);
  for (unsigned offset = 0; offset < 4; offset++)
    for (unsigned size = 0; size < 40; size += 13) {
      memset(b, 0xEE, sizeof b);
      memcpy(b + 4 + offset, a + 5, size);
      printf("%x ", hash(b, 80));
      memmove(b + 6, b + 4 + offset, size);
      memmove(b + 3 + offset, b + 4, size);
      printf("%x ", hash(b, 80));
      memset(b + offset, (int)size, size);
      printf("%x %d\n", hash(b, 80), memcmp(a + 5, b + 4 + offset, size) > 0);
    }
  for (int i = 0; i < 9; i++)
    from.v[i] = i * 1000;
  to = from;
  memcpy(&to.v[1], &from.v[4], 12);
  printf("%x %d\n", hash((unsigned char *)&to, sizeof to), memchr(a, 10, 80) == a + 1);
  return 0;
}
