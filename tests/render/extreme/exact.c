/* Every sign is certain: binary64 with an error bound decides where it can, integers of GMP where it cannot. */
#include "exact.h"

#include "reach.h"

#include <gmp.h>
#include <math.h>
#include <stdlib.h>

#define UNIT 0x1p-24 /* of binary32's rounding */

/* --- exactly --- */

/* Of a ray and a triangle, relative to the ray's origin: volume[i] is det(direction, next, previous vertex), which is
   the edge value opposite to vertex i times a common factor; their sum is the determinant. */
struct exact_pair {
  mpz_t vertex[3][3], direction[3], volume[3], determinant, product, sum;
  mpq_t distance; /* along the direction; set if the determinant is not zero */
};

static void pair_init(struct exact_pair *pair) {
  for (int i = 0; i < 3; i++) {
    for (int axis = 0; axis < 3; axis++)
      mpz_init(pair->vertex[i][axis]);
    mpz_init(pair->direction[i]);
    mpz_init(pair->volume[i]);
  }
  mpz_inits(pair->determinant, pair->product, pair->sum, NULL);
  mpq_init(pair->distance);
}

static void pair_clear(struct exact_pair *pair) {
  for (int i = 0; i < 3; i++) {
    for (int axis = 0; axis < 3; axis++)
      mpz_clear(pair->vertex[i][axis]);
    mpz_clear(pair->direction[i]);
    mpz_clear(pair->volume[i]);
  }
  mpz_clears(pair->determinant, pair->product, pair->sum, NULL);
  mpq_clear(pair->distance);
}

/* value = number * 2^149: exact for every finite binary32 number. */
static void set_float(mpz_t value, float number) {
  int exponent;
  double fraction = frexp((double)number, &exponent);
  mpz_set_d(value, ldexp(fraction, 24));
  exponent += 149 - 24;
  if (exponent >= 0)
    mpz_mul_2exp(value, value, (mp_bitcnt_t)exponent);
  else
    mpz_tdiv_q_2exp(value, value, (mp_bitcnt_t)-exponent); /* a subnormal: the bits that go are zero */
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

enum side { OUTSIDE, HIT, BEHIND_ORIGIN, NO_AREA };

/* From pair->direction and pair->vertex. The distance is that of the triangle's plane, inside or not. */
static enum side evaluate(struct exact_pair *pair) {
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

static enum side evaluate_ray(struct exact_pair *pair, const struct query_ray *ray,
                              const struct exact_triangle *triangle) {
  for (int axis = 0; axis < 3; axis++) {
    set_float(pair->sum, ray->origin[axis]);
    for (int i = 0; i < 3; i++) {
      set_float(pair->vertex[i][axis], triangle->vertex[i][axis]);
      mpz_sub(pair->vertex[i][axis], pair->vertex[i][axis], pair->sum);
    }
    set_float(pair->direction[axis], ray->direction[axis]);
  }
  return evaluate(pair);
}

/* --- in binary64 --- */

typedef double triple[3];

/* With components of b and c that are off by `off` besides some rounding. */
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

/* A ray from origin, of which each coordinate is off by at most `off`, cannot hit the triangle. */
static bool surely_outside(const triple origin, const triple direction, double off,
                           const struct exact_triangle *triangle) {
  triple vertex[3];
  for (int i = 0; i < 3; i++)
    for (int axis = 0; axis < 3; axis++)
      vertex[i][axis] = (double)triangle->vertex[i][axis] - origin[axis];
  bool positive = false, negative = false;
  for (int i = 0; i < 3; i++) {
    double error, volume = determinant(direction, vertex[(i + 2) % 3], vertex[(i + 1) % 3], off, &error);
    positive |= volume > error;
    negative |= volume < -error;
  }
  return positive && negative;
}

/* --- what rounding explains --- */

/* The watertight test's own quantities, with bounds on the errors that it makes: every coordinate of a vertex across
   the ray is off by 14 units of 2^-24 of the vertex's distance at most (frame.c adds them up), and so are products. In
   the scaled scene, along the scaled direction. Of vertices more than TRAX_REACH times as far away as what is hit, so
   much is taken for their distance: where scenes have them hits are exact (render/reach.h). */
struct bounds {
  double edge[3], edge_error[3];
  double determinant, determinant_error;
  double distance, distance_error; /* of the plane, as long as the answer is a mean of the vertices' distances */
};

static void bound(struct bounds *bounds, const struct exact_scene *scene, const struct query_ray *ray,
                  int direction_exponent, const struct exact_triangle *triangle, double hit) {
  triple vertex[3], direction;
  double error[3], size = 0;
  int w = 0;
  for (int axis = 0; axis < 3; axis++) {
    direction[axis] = ldexp((double)ray->direction[axis], direction_exponent);
    if (fabs(direction[axis]) > fabs(direction[w]))
      w = axis;
  }
  int u = (w + 1) % 3, v = (w + 2) % 3;
  for (int i = 0; i < 3; i++) {
    double farthest = 0;
    for (int axis = 0; axis < 3; axis++) {
      double place = (double)triangle->vertex[i][axis] - (double)ray->origin[axis];
      vertex[i][axis] = ldexp(place, scene->exponent);
      farthest = fmax(farthest, fabs(vertex[i][axis]));
    }
    vertex[i][u] -= direction[u] / direction[w] * vertex[i][w];
    vertex[i][v] -= direction[v] / direction[w] * vertex[i][w];
    farthest = fmin(farthest, TRAX_REACH * hit * fabs(direction[w]));
    error[i] = 14 * UNIT * farthest + 0x1p-147;
    size = fmax(size, farthest);
  }
  bounds->determinant = bounds->determinant_error = 0;
  double mean = 0, spread = 0, widest = 0;
  for (int i = 0; i < 3; i++) {
    int a = (i + 2) % 3, b = (i + 1) % 3;
    bounds->edge[i] = vertex[a][u] * vertex[b][v] - vertex[a][v] * vertex[b][u];
    bounds->edge_error[i] = error[b] * (fabs(vertex[a][u]) + fabs(vertex[a][v])) +
                            error[a] * (fabs(vertex[b][u]) + fabs(vertex[b][v])) + 2 * error[a] * error[b] + 0x1p-147;
    bounds->determinant += bounds->edge[i];
    bounds->determinant_error += bounds->edge_error[i];
    mean += bounds->edge[i] * vertex[i][w];
  }
  double certain = fabs(bounds->determinant) - bounds->determinant_error;
  mean = bounds->determinant == 0 ? (vertex[0][w] + vertex[1][w] + vertex[2][w]) / 3 : mean / bounds->determinant;
  for (int i = 0; i < 3; i++) {
    widest = fmax(widest, fabs(vertex[i][w] - mean));
    spread += bounds->edge_error[i] * fabs(vertex[i][w] - mean);
  }
  double amplified = certain > 0 ? spread / certain : INFINITY;
  bounds->distance = mean / direction[w];
  bounds->distance_error = (fmin(amplified, widest) + 16 * UNIT * size) / fabs(direction[w]);
  if (certain > 0) /* the sum of products may be subnormal */
    bounds->distance_error += 0x1p-146 / certain;
}

/* A test within the bounds must find the hit. */
static bool must_be_found(const struct bounds *bounds) {
  if (fabs(bounds->determinant) <= bounds->determinant_error + 0x1p-126 || bounds->distance <= bounds->distance_error)
    return false;
  for (int i = 0; i < 3; i++)
    if (copysign(1, bounds->determinant) * bounds->edge[i] <= bounds->edge_error[i])
      return false;
  return true;
}

/* It may find one. */
static bool may_be_found(const struct bounds *bounds, double distance) {
  bool above = true, below = true;
  for (int i = 0; i < 3; i++) {
    above &= bounds->edge[i] >= -bounds->edge_error[i];
    below &= bounds->edge[i] <= bounds->edge_error[i];
  }
  return (above || below) && fabs(distance - bounds->distance) <= bounds->distance_error;
}

/* --- judgements --- */

/* |answered - exact| in units of the answer's last place. */
static double error_in_ulp(float answered, const mpq_t exact) {
  mpq_t difference;
  mpq_init(difference);
  mpq_set_d(difference, (double)answered);
  mpq_sub(difference, difference, exact);
  double ulp = fabs((double)nextafterf(answered, INFINITY) - (double)answered);
  double result = fabs(mpq_get_d(difference)) / ulp;
  mpq_clear(difference);
  return result;
}

static void scale_distance(mpq_t distance, int exponent) {
  if (exponent >= 0)
    mpq_mul_2exp(distance, distance, (mp_bitcnt_t)exponent);
  else
    mpq_div_2exp(distance, distance, (mp_bitcnt_t)-exponent);
}

/* Exactly: does the point at `distance` along the ray, on `own`, see the light from the side of the ray's origin? */
static bool sees_light(struct exact_pair *pair, const struct exact_scene *scene, const struct query_ray *ray,
                       uint32_t own, const mpq_t distance) {
  /* All in units of 2^-149 / the distance's denominator, so that the point is whole. */
  const mpz_srcptr unit = mpq_denref(distance), steps = mpq_numref(distance);
  mpz_t point[3], way[3], origin[3];
  triple point_about, way_about;
  double off = 0;
  for (int axis = 0; axis < 3; axis++) {
    mpz_inits(point[axis], way[axis], origin[axis], NULL);
    set_float(origin[axis], ray->origin[axis]);
    mpz_mul(origin[axis], origin[axis], unit);
    set_float(point[axis], ray->direction[axis]);
    mpz_mul(point[axis], point[axis], steps);
    mpz_add(point[axis], point[axis], origin[axis]);
    set_float(way[axis], scene->light[axis]);
    mpz_mul(way[axis], way[axis], unit);
    mpz_sub(way[axis], way[axis], point[axis]);
    mpz_sub(origin[axis], origin[axis], point[axis]);
    mpq_t value;
    mpq_init(value);
    for (int which = 0; which < 2; which++) {
      mpz_set(mpq_numref(value), which ? way[axis] : point[axis]);
      mpz_set(mpq_denref(value), unit);
      mpq_canonicalize(value);
      mpq_div_2exp(value, value, 149);
      (which ? way_about : point_about)[axis] = mpq_get_d(value);
    }
    mpq_clear(value);
    off = fmax(off, 0x1p-52 * fabs(point_about[axis]));
  }

  bool sees = true;
  for (uint32_t i = 0; i < scene->count && sees; i++) {
    const struct exact_triangle *triangle = &scene->triangles[i];
    if (i != own && surely_outside(point_about, way_about, off, triangle))
      continue;
    for (int axis = 0; axis < 3; axis++) {
      for (int corner = 0; corner < 3; corner++) {
        set_float(pair->vertex[corner][axis], triangle->vertex[corner][axis]);
        mpz_mul(pair->vertex[corner][axis], pair->vertex[corner][axis], unit);
        mpz_sub(pair->vertex[corner][axis], pair->vertex[corner][axis], point[axis]);
      }
      mpz_set(pair->direction[axis], way[axis]);
    }
    enum side side = evaluate(pair);
    if (i == own) { /* the light is on the other side, or in the plane */
      int light_side = mpz_sgn(pair->determinant);
      for (int axis = 0; axis < 3; axis++)
        mpz_set(pair->direction[axis], origin[axis]);
      evaluate(pair);
      sees = light_side * mpz_sgn(pair->determinant) > 0;
    } else if (side == HIT) {
      sees = mpq_cmp_ui(pair->distance, 1, 1) >= 0;
    } else if (side == BEHIND_ORIGIN && mpq_sgn(pair->distance) == 0) {
      /* The point lies on both triangles, as on an edge between them: is this one between viewer and light? */
      int light_side = mpz_sgn(pair->determinant);
      for (int axis = 0; axis < 3; axis++)
        mpz_set(pair->direction[axis], origin[axis]);
      evaluate(pair);
      sees = light_side * mpz_sgn(pair->determinant) >= 0;
    }
  }
  for (int axis = 0; axis < 3; axis++)
    mpz_clears(point[axis], way[axis], origin[axis], NULL);
  return sees;
}

/* Exactly, along the ray as the program scaled it. */
static double program_distance(const struct exact_scene *scene, int direction_exponent, const mpq_t distance) {
  mpq_t scaled;
  mpq_init(scaled);
  mpq_set(scaled, distance);
  scale_distance(scaled, scene->exponent - direction_exponent);
  const double result = mpq_get_d(scaled);
  mpq_clear(scaled);
  return result;
}

#define TIED_DISTANCES 0x1p-21

/* An answer that names a triangle. nearest: exactly, of what the ray hits; meaningless if that is nothing. */
static void judge_hit(struct exact_tally *tally, struct exact_pair *pair, const struct exact_scene *scene,
                      const struct query_ray *ray, const struct exact_answer *answer, bool hit, const mpq_t nearest) {
  const struct exact_triangle *triangle = &scene->triangles[answer->triangle];
  const enum side side = evaluate_ray(pair, ray, triangle);
  const double right = hit ? program_distance(scene, answer->direction_exponent, nearest) : INFINITY;
  if (answer->exact) {
    const double own = side == HIT ? program_distance(scene, answer->direction_exponent, pair->distance) : INFINITY;
    tally->unexplained += !(own <= right * (1 + TIED_DISTANCES)) ||
                          fabs((double)answer->distance - own) > TIED_DISTANCES * own + 0x1p-149;
  } else {
    struct bounds bounds;
    bound(&bounds, scene, ray, answer->direction_exponent, triangle, right);
    tally->unexplained += !may_be_found(&bounds, (double)answer->distance);
  }
  if (side != HIT || !hit || !mpq_equal(pair->distance, nearest)) {
    tally->wrong++;
    return;
  }
  if (answer->light != QUERY_NOT_ASKED) {
    bool sees = sees_light(pair, scene, ray, (uint32_t)answer->triangle, nearest);
    tally->lit += sees;
    tally->leaks += !sees && answer->light == QUERY_LIT;
    tally->acne += sees && answer->light != QUERY_LIT;
  }
  mpq_t distance;
  mpq_init(distance);
  mpq_set(distance, nearest);
  scale_distance(distance, scene->exponent - answer->direction_exponent);
  tally->worst_ulp = fmax(tally->worst_ulp, error_in_ulp(answer->distance, distance));
  mpq_clear(distance);
}

/* Is there a triangle that a test within the bounds must find before the answer? */
static bool overlooks(const struct exact_scene *scene, const struct query_ray *ray, const struct exact_answer *answer,
                      const struct exact_triangle *triangle, double distance) {
  if (answer->exact)
    return answer->triangle < 0; /* else judge_hit compares with the nearest */
  struct bounds bounds;
  bound(&bounds, scene, ray, answer->direction_exponent, triangle, distance);
  return must_be_found(&bounds) &&
         (answer->triangle < 0 || bounds.distance + bounds.distance_error < (double)answer->distance);
}

void exact_judge(struct exact_tally *tallies, const struct exact_scene *scene, const struct query_ray *ray,
                 const struct exact_answer *answers, unsigned count) {
  struct exact_pair pair;
  triple origin, direction;
  mpq_t nearest;
  bool hit = false, overlooked[8] = {false};
  pair_init(&pair);
  mpq_init(nearest);
  for (int axis = 0; axis < 3; axis++)
    origin[axis] = (double)ray->origin[axis], direction[axis] = (double)ray->direction[axis];

  for (uint32_t i = 0; i < scene->count; i++) {
    const struct exact_triangle *triangle = &scene->triangles[i];
    if (surely_outside(origin, direction, 0, triangle) || evaluate_ray(&pair, ray, triangle) != HIT)
      continue;
    if (!hit || mpq_cmp(pair.distance, nearest) < 0)
      mpq_set(nearest, pair.distance);
    hit = true;
    const double distance = program_distance(scene, answers[0].direction_exponent, pair.distance);
    for (unsigned a = 0; a < count; a++)
      overlooked[a] = overlooked[a] || overlooks(scene, ray, &answers[a], triangle, distance);
  }
  for (unsigned a = 0; a < count; a++) {
    tallies[a].judged++;
    tallies[a].hits += hit;
    tallies[a].unexplained += overlooked[a];
    if (answers[a].triangle >= 0)
      judge_hit(&tallies[a], &pair, scene, ray, &answers[a], hit, nearest);
    else
      tallies[a].missed += hit;
  }
  mpq_clear(nearest);
  pair_clear(&pair);
}
