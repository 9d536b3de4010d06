/* Powers with an integer exponent, by squaring; a negative one divides at the end, as the compilers' own libraries do.
 */
#include "builtins.h"

/* |n| also for the least integer. */
static inline unsigned magnitude(int n) {
  return n < 0 ? 0 - (unsigned)n : (unsigned)n;
}

float __powisf2(float a, int n) {
  unsigned m = magnitude(n);
  float power = m & 1 ? a : 1;
  while (m >>= 1) {
    a *= a;
    if (m & 1)
      power *= a;
  }
  return n < 0 ? 1 / power : power;
}

double __powidf2(double a, int n) {
  unsigned m = magnitude(n);
  double power = m & 1 ? a : 1;
  while (m >>= 1) {
    a *= a;
    if (m & 1)
      power *= a;
  }
  return n < 0 ? 1 / power : power;
}
