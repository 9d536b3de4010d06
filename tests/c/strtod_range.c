// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-mstack=global"
// ERANGE: not for a subnormal number that is exact.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

int main(void) {
  static const char *const texts[] = {"0x1p-1074", "0x1p-1075", "0x1.8p-1074", "0x1.8p-1073", "0x0.0000000000001p-1022", "0x1p-1030", "0x1.0000000000001p-1030",
                                      "4.9e-324", "1e-310", "1e-400", "1e400", "0x1p-149", "0x1p-150", "0x1.8p-149", "0x3p-149", "0x1p-126", "1e-40", "1e-50", "1e39",
                                      "0", "0x0p-2000", "1"};
  for (unsigned i = 0; i < sizeof texts / sizeof *texts; i++) {
    errno = 0;
    double d = strtod(texts[i], NULL);
    int of_double = errno == ERANGE;
    errno = 0;
    float f = strtof(texts[i], NULL);
    printf("%s %a %d %a %d\n", texts[i], d, of_double, (double)f, errno == ERANGE);
  }
  return 0;
}
