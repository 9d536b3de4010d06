/* Every sign is certain: binary64 with an error bound decides where it can, integers of GMP where it cannot. */
#include "pair.h"

#include <math.h>

void exact_pair_init(struct exact_pair *pair) {
  for (int i = 0; i < 3; i++) {
    for (int axis = 0; axis < 3; axis++)
      mpz_init(pair->vertex[i][axis]);
    mpz_init(pair->direction[i]);
    mpz_init(pair->volume[i]);
  }
  mpz_inits(pair->determinant, pair->product, pair->sum, pair->factor, NULL);
  mpq_init(pair->distance);
}

void exact_pair_clear(struct exact_pair *pair) {
  for (int i = 0; i < 3; i++) {
    for (int axis = 0; axis < 3; axis++)
      mpz_clear(pair->vertex[i][axis]);
    mpz_clear(pair->direction[i]);
    mpz_clear(pair->volume[i]);
  }
  mpz_clears(pair->determinant, pair->product, pair->sum, pair->factor, NULL);
  mpq_clear(pair->distance);
}

/* value = number * 2^bits, of a number whose last bit is not below 2^-bits. */
static void set_number(mpz_t value, double number, int bits) {
  int exponent;
  const double fraction = frexp(number, &exponent);
  mpz_set_d(value, ldexp(fraction, 48));
  exponent += bits - 48;
  if (exponent >= 0)
    mpz_mul_2exp(value, value, (mp_bitcnt_t)exponent);
  else
    mpz_tdiv_q_2exp(value, value, (mp_bitcnt_t)-exponent); /* the bits that go are zero */
}

void exact_set_float(mpz_t value, float number) {
  set_number(value, (double)number, EXACT_BITS);
}

void exact_set_corner(struct exact_pair *pair, mpz_t value, const struct exact_triangle *triangle, int corner,
                      int axis) {
  const float *v = triangle->vertex[corner];
  if (!triangle->place) {
    exact_set_float(value, v[axis]);
    return;
  }
  const float *row = triangle->place->matrix[axis];
  exact_set_float(value, row[3]);
  for (int i = 0; i < 3; i++) {
    set_number(pair->factor, (double)row[i] * (double)v[i], EXACT_BITS); /* a product of 48 bits */
    mpz_add(value, value, pair->factor);
  }
}

double exact_corner(triple out, const struct exact_triangle *triangle, int corner) {
  const float *v = triangle->vertex[corner];
  double greatest = 0;
  for (int axis = 0; axis < 3; axis++) {
    out[axis] = (double)v[axis];
    if (!triangle->place)
      continue;
    const float *row = triangle->place->matrix[axis];
    out[axis] = (double)row[3];
    greatest = fmax(greatest, fabs(out[axis]));
    for (int i = 0; i < 3; i++) {
      const double product = (double)row[i] * (double)v[i];
      out[axis] += product;
      greatest = fmax(greatest, fabs(product));
    }
  }
  return greatest;
}

static void add_product(struct exact_pair *pair, mpz_t sum, const mpz_t a, const mpz_t b, const mpz_t c, bool minus) {
  mpz_mul(pair->product, a, b);
  if (minus)
    mpz_submul(sum, pair->product, c);
  else
    mpz_addmul(sum, pair->product, c);
}

/* sum = det(a, b, c) */
static void set_determinant(struct exact_pair *pair, mpz_t sum, mpz_t a[3], mpz_t b[3], mpz_t c[3]) {
  mpz_set_ui(sum, 0);
  for (int i = 0; i < 3; i++) {
    add_product(pair, sum, a[i], b[(i + 1) % 3], c[(i + 2) % 3], false);
    add_product(pair, sum, a[i], b[(i + 2) % 3], c[(i + 1) % 3], true);
  }
}

enum side exact_evaluate(struct exact_pair *pair) {
  mpz_set_ui(pair->determinant, 0);
  bool positive = false, negative = false;
  for (int i = 0; i < 3; i++) {
    set_determinant(pair, pair->volume[i], pair->direction, pair->vertex[(i + 2) % 3], pair->vertex[(i + 1) % 3]);
    mpz_add(pair->determinant, pair->determinant, pair->volume[i]);
    positive |= mpz_sgn(pair->volume[i]) > 0;
    negative |= mpz_sgn(pair->volume[i]) < 0;
  }
  if (mpz_sgn(pair->determinant) == 0)
    return NO_AREA;
  int axis = 0;
  for (int i = 1; i < 3; i++)
    if (mpz_cmpabs(pair->direction[i], pair->direction[axis]) > 0)
      axis = i;
  mpz_set_ui(pair->sum, 0);
  for (int i = 0; i < 3; i++)
    mpz_addmul(pair->sum, pair->volume[i], pair->vertex[i][axis]);
  mpz_set(mpq_numref(pair->distance), pair->sum);
  mpz_mul(mpq_denref(pair->distance), pair->determinant, pair->direction[axis]);
  mpq_canonicalize(pair->distance);
  if (positive && negative)
    return OUTSIDE;
  return mpq_sgn(pair->distance) > 0 ? HIT : BEHIND_ORIGIN;
}

enum side exact_evaluate_ray(struct exact_pair *pair, const struct query_ray *ray,
                             const struct exact_triangle *triangle) {
  for (int axis = 0; axis < 3; axis++) {
    exact_set_float(pair->sum, ray->origin[axis]);
    for (int i = 0; i < 3; i++) {
      exact_set_corner(pair, pair->vertex[i][axis], triangle, i, axis);
      mpz_sub(pair->vertex[i][axis], pair->vertex[i][axis], pair->sum);
    }
    exact_set_float(pair->direction[axis], ray->direction[axis]);
  }
  return exact_evaluate(pair);
}

/* --- in binary64 --- */

/* The determinant. Components of b and c are off by `off` besides some rounding. */
static double determinant(const triple a, const triple b, const triple c, double off, double *error) {
  double sum = 0, size = 0, far = 0;
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    double first = b[j] * c[k], second = b[k] * c[j];
    sum += a[i] * (first - second);
    size += fabs(a[i]) * (fabs(first) + fabs(second));
    far += fabs(a[i]) * (fabs(b[j]) + fabs(b[k]) + fabs(c[j]) + fabs(c[k]) + 2 * off);
  }
  *error = size * 0x1p-48 + 2 * off * far;
  return sum;
}

bool surely_outside(const triple origin, const triple direction, double off, const struct exact_triangle *triangle) {
  triple vertex[3];
  for (int i = 0; i < 3; i++) {
    off += 0x1p-50 * exact_corner(vertex[i], triangle, i);
    for (int axis = 0; axis < 3; axis++)
      vertex[i][axis] -= origin[axis];
  }
  bool positive = false, negative = false;
  for (int i = 0; i < 3; i++) {
    double error, volume = determinant(direction, vertex[(i + 2) % 3], vertex[(i + 1) % 3], off, &error);
    positive |= volume > error;
    negative |= volume < -error;
  }
  return positive && negative;
}
