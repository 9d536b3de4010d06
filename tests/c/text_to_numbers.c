// RUN: %run_c %s %t
// atoi, strtol and their like.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const texts[] = {"0", " -42xyz", "0x1F", "017", "zz", "9999999999", "-", "18446744073709551615"};

int main(void) {
  for (int i = 0; i < 8; i++) {
    char *end;
    errno = 0;
    long long a = strtoll(texts[i], &end, 10);
    printf("%lld %s %d|", a, end, errno != 0);
    a = strtoll(texts[i], &end, 0);
    printf("%lld %s|", a, end);
    unsigned long long u = strtoull(texts[i], &end, 36);
    printf("%llu %s\n", u, end);
  }
  printf("%d %d %d\n", atoi("123"), abs(atoi("-5")), div(17, -5).rem);
  return 0;
}
