/* Comparisons of doubles, and of floats for code that calls them by name. */
#include "double.h"

/* -1, 0 or 1; unordered if one is a NaN. Without the signs, the values compare as integers; +0 equals -0. */
static inline int compare(double x, double y, int unordered) {
  uint64_t a = double_bits(x), b = double_bits(y);
  if (is_nan_bits(a) || is_nan_bits(b))
    return unordered;
  if (a == b || double_magnitude(a | b) == 0)
    return 0;
  if (double_sign(a) != double_sign(b))
    return double_sign(a) ? -1 : 1;
  return (a < b) != double_sign(a) ? -1 : 1;
}

/* Two functions serve eight names. They differ in the result for a NaN. */
int __ledf2(double a, double b) {
  return compare(a, b, 1);
}

int __gedf2(double a, double b) {
  return compare(a, b, -1);
}

int __eqdf2(double a, double b) {
  return __ledf2(a, b);
}

int __nedf2(double a, double b) {
  return __ledf2(a, b);
}

int __ltdf2(double a, double b) {
  return __ledf2(a, b);
}

int __cmpdf2(double a, double b) {
  return __ledf2(a, b);
}

int __gtdf2(double a, double b) {
  return __gedf2(a, b);
}

int __unorddf2(double a, double b) {
  return is_nan_bits(double_bits(a)) || is_nan_bits(double_bits(b));
}

int __lesf2(float a, float b) {
  return a < b ? -1 : a == b ? 0 : 1;
}

int __gesf2(float a, float b) {
  return a > b ? 1 : a == b ? 0 : -1;
}

int __eqsf2(float a, float b) {
  return __lesf2(a, b);
}

int __nesf2(float a, float b) {
  return __lesf2(a, b);
}

int __ltsf2(float a, float b) {
  return __lesf2(a, b);
}

int __gtsf2(float a, float b) {
  return __gesf2(a, b);
}

int __unordsf2(float a, float b) {
  return a != a || b != b;
}
