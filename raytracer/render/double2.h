/* Double-double arithmetic: a number is the sum of two binary64, which hold 106 bits of it. Of T. J. Dekker, "A
   floating-point technique for extending the available precision", Numerische Mathematik 18 (1971), with the bounds of
   M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for basic building blocks of double-word
   arithmetic", ACM TOMS 44 (2017), where u is 2^-53. Compile it without contraction and without -ffast-math. */
#ifndef TRAX_RENDER_DOUBLE2_H
#define TRAX_RENDER_DOUBLE2_H

#include "double3.h"

struct double2 {
  double high, low; /* |low| is at most half of the last place of high */
};

struct double2_3 {
  struct double2 x, y, z;
};

/* a + b without error, if |a| >= |b| */
static inline struct double2 double2_ordered(double a, double b) {
  const double high = a + b;
  return (struct double2){high, b - (high - a)};
}

/* a + b without error */
static inline struct double2 double2_of_sum(double a, double b) {
  const double high = a + b, of_b = high - a;
  return (struct double2){high, (a - (high - of_b)) + (b - of_b)};
}

/* Relative error below 4 u^2 (AccurateDWPlusDW). */
static inline struct double2 double2_plus(struct double2 a, struct double2 b) {
  const struct double2 s = double2_of_sum(a.high, b.high), t = double2_of_sum(a.low, b.low);
  const struct double2 v = double2_ordered(s.high, s.low + t.high);
  return double2_ordered(v.high, t.low + v.low);
}

static inline struct double2 double2_minus(struct double2 a, struct double2 b) {
  return double2_plus(a, (struct double2){-b.high, -b.low});
}

/* Relative error at most 5 u^2 (DWTimesDW3), without underflow. */
static inline struct double2 double2_times(struct double2 a, struct double2 b) {
  const double high = a.high * b.high, low = fma(a.high, b.high, -high);
  const double cross = fma(a.high, b.low, fma(a.low, b.high, a.low * b.low));
  return double2_ordered(high, low + cross);
}

/* a - b without error */
static inline struct double2_3 double2_difference(const float a[3], struct double3 b) {
  return (struct double2_3){double2_of_sum(a[0], -b.x), double2_of_sum(a[1], -b.y), double2_of_sum(a[2], -b.z)};
}

static inline struct double2 double2_cross(struct double2 a, struct double2 b, struct double2 c, struct double2 d) {
  return double2_minus(double2_times(a, b), double2_times(c, d));
}

/* det(a, b, c): within 2^-101 of the sum of its products' magnitudes. */
static inline struct double2 double2_volume(const struct double2_3 *a, const struct double2_3 *b,
                                            const struct double2_3 *c) {
  const struct double2 x = double2_times(a->x, double2_cross(b->y, c->z, b->z, c->y)),
                       y = double2_times(a->y, double2_cross(b->z, c->x, b->x, c->z)),
                       z = double2_times(a->z, double2_cross(b->x, c->y, b->y, c->x));
  return double2_plus(double2_plus(x, y), z);
}

#endif
