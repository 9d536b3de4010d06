// Numbers from text, correctly rounded; the functions of <inttypes.h>, <string.h> and <stdlib.h> that go with them.
// RUN: %run_c %s %t --turns -O0,-O2,-Os
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const texts[] = {
    "0",
    "-0.0",
    "1",
    "3.14159265358979323846264338327950288419716939937510",
    "1e23",
    "-1.7976931348623157e308",
    "1.7976931348623159e308",
    "4.9406564584124654e-324",
    "2.4703282292062327e-324",
    "2.2250738585072011e-308",
    "9007199254740993",
    "9007199254740993.00000000000000000000000000000000000000000000001",
    "123456789012345678901234567890e-10",
    "0x1.fffffffffffff8p0",
    "0x1p-1074x",
    "inf",
    "-Infinity and more",
    "nan(1)",
    "1e",
    ".",
    "",
    "3.4028235677973366e38",
    "1.401298464324817e-45",
    "16777217",
    "16777217.0000000000000000000000001",
};

int main(void) {
  for (unsigned i = 0; i < sizeof texts / sizeof texts[0]; i++) {
    char *end;
    double d = strtod(texts[i], &end);
    printf("%a %d ", d, (int)(end - texts[i]));
    float f = strtof(texts[i], &end);
    printf("%a %d\n", (double)f, (int)(end - texts[i]));
  }
  printf("%.17g %.17g\n", atof("  0.1xyz"), (double)strtold("1e-5", NULL));
  errno = 0;
  (void)strtod("1e999", NULL);
  printf("%d\n", errno == ERANGE);
  printf("%" PRIdMAX " %" PRIuMAX "\n", strtoimax("-9223372036854775808", NULL, 10), strtoumax("0xffffffffffffffff", NULL, 0));
  imaxdiv_t q = imaxdiv(-1000000000001, 7);
  printf("%" PRIdMAX " %" PRIdMAX " %" PRIdMAX "\n", q.quot, q.rem, imaxabs(-5));
  char line[] = "12.5, -3e2;0x10";
  double sum = 0;
  for (char *token = strtok(line, ",; "); token; token = strtok(NULL, ",; "))
    sum += strtod(token, NULL);
  printf("%g\n", sum);
  return 0;
}
