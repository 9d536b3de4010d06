// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-mstack=global"
// sscanf: every conversion, widths, sets, mismatches, and the end of the text.
#include <stdio.h>
#include <string.h>

static void show(int done, const char *rest) {
  printf("%d %s\n", done, rest);
}

int main(void) {
  int a = 0, b = 0, c = 0;
  long long big = 0;
  unsigned char tiny = 0;
  short small = 0;
  float f = 0;
  double d = 0;
  char word[32] = "", other[32] = "";
  printf("%d", sscanf("12 -34 0x1F", "%d%d%i", &a, &b, &c));
  printf(" %d %d %d\n", a, b, c);
  printf("%d", sscanf("077 077 ff", "%i %d %x", &a, &b, &c));
  printf(" %d %d %d\n", a, b, c);
  printf("%d", sscanf("9223372036854775807 300 70000", "%lld %hhu %hd", &big, &tiny, &small));
  printf(" %lld %u %d\n", big, tiny, small);
  printf("%d", sscanf("3.25 -1e-3", "%f %lf", &f, &d));
  printf(" %g %g\n", (double)f, d);
  printf("%d", sscanf("0x1.8p1 inf", "%lf %f", &d, &f));
  printf(" %g %g\n", d, (double)f);
  printf("%d", sscanf("hello world", "%5s %3c", word, other));
  printf(" %s %.3s\n", word, other);
  printf("%d", sscanf("key=value;rest", "%[a-z]=%[^;]", word, other));
  printf(" %s %s\n", word, other);
  printf("%d", sscanf("]x]y", "%[]x]%s", word, other));
  printf(" %s %s\n", word, other);
  printf("%d", sscanf("12345678", "%3d%2d%n", &a, &b, &c));
  printf(" %d %d %d\n", a, b, c);
  printf("%d", sscanf("1,2,3", "%d,%*d,%d", &a, &b));
  printf(" %d %d\n", a, b);
  printf("%d", sscanf("50%", "%d%%%n", &a, &c));
  printf(" %d %d\n", a, c);
  a = 7;
  show(sscanf("abc", "%d", &a), "no number");
  show(sscanf("", "%d", &a), "the end");
  show(sscanf("   ", "%s", word), "blanks");
  show(sscanf("5 abc", "%d %d", &a, &b), "one of two");
  show(sscanf("x", "y"), "another letter");
  show(sscanf("5.", "%lf", &d), "a point");
  show(sscanf("-", "%d", &a), "a sign alone");
  printf("%d", sscanf("4294967295", "%u", (unsigned *)&a));
  printf(" %u\n", (unsigned)a);
  printf("%zu\n", strlen(word));
  return 0;
}
