// RUN: %run_c %s %t
// Floating-point conversions: exact digits, rounding, width and flags.
#include <stdio.h>

static volatile double values[] = {0.0,         1.0,  -2.5, 3.14159265358979, 1e-5,
                                   123456789.0, 1e22, 0.1,  2.5e-310,         1.7976931348623157e308};

int main(void) {
  for (int i = 0; i < 10; i++) {
    printf("%f %e %g\n", values[i], values[i], values[i]);
    printf("%.0f|%.1e|%.3g|%12.4f|%-12.2e|\n", i < 9 ? values[i] : 0.5, values[i], values[i], i < 9 ? values[i] : 1.5,
           values[i]);
    printf("%.17g %a\n", values[i], values[i]);
  }
  printf("[%+.2f] [% .2f] [%08.2f] [%#.0f] [%#g] [%G] [%E]\n", 1.005, 1.0, -3.14159, 2.0, 1.5, 1e-10, 12345.678);
  volatile double zero = 0;
  printf("%f %e %F %5.1f|\n", 1 / zero, -1 / zero, 1 / zero, 1 / zero);
  printf("%.30f\n%.20e\n", 0.1, 1.0 / 3);
  return 0;
}
