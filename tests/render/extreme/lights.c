/* Which points see the light, and how far rounding moves where that is asked. */
#include "pair.h"

#include <math.h>

typedef mpz_t vector[3];

static void vector_init(vector a) {
  mpz_inits(a[0], a[1], a[2], NULL);
}

static void vector_clear(vector a) {
  mpz_clears(a[0], a[1], a[2], NULL);
}

static void subtract(vector result, vector a, vector b) {
  for (int i = 0; i < 3; i++)
    mpz_sub(result[i], a[i], b[i]);
}

static void cross(vector result, vector a, vector b) {
  for (int i = 0; i < 3; i++) {
    mpz_mul(result[i], a[(i + 1) % 3], b[(i + 2) % 3]);
    mpz_submul(result[i], a[(i + 2) % 3], b[(i + 1) % 3]);
  }
}

static int dot_of(mpz_t sum, vector a, vector b) {
  mpz_set_ui(sum, 0);
  for (int i = 0; i < 3; i++)
    mpz_addmul(sum, a[i], b[i]);
  return mpz_sgn(sum);
}

/* The point, which is 0, lies on the triangle, as on an edge that it shares with the point's own. Does the triangle
   hide the light from the points of the own triangle near by? Those are in the direction `inward`. */
static bool hides_nearby(struct exact_pair *pair, vector inward) {
  vector edge[2], normal, place;
  mpz_t rise, fall;
  vector_init(edge[0]), vector_init(edge[1]), vector_init(normal), vector_init(place);
  mpz_inits(rise, fall, NULL);
  subtract(edge[0], pair->vertex[1], pair->vertex[0]);
  subtract(edge[1], pair->vertex[2], pair->vertex[0]);
  cross(normal, edge[0], edge[1]);
  bool hides = dot_of(rise, normal, inward) * dot_of(fall, normal, pair->direction) < 0;
  /* The place where the segment comes through the triangle's plane. */
  for (int i = 0; i < 3; i++) {
    mpz_mul(place[i], inward[i], fall);
    mpz_submul(place[i], pair->direction[i], rise);
    if (mpz_sgn(fall) < 0)
      mpz_neg(place[i], place[i]);
  }
  /* The segment is within all edges that the point lies on. */
  for (int i = 0; i < 3 && hides; i++) {
    mpz_t *a = pair->vertex[(i + 1) % 3], *b = pair->vertex[(i + 2) % 3];
    cross(edge[0], a, b);
    if (dot_of(rise, normal, edge[0]) != 0)
      continue;
    subtract(edge[0], b, a);
    cross(edge[1], edge[0], place);
    hides = dot_of(rise, normal, edge[1]) >= 0;
  }
  mpz_clears(rise, fall, NULL);
  vector_clear(edge[0]), vector_clear(edge[1]), vector_clear(normal), vector_clear(place);
  return hides;
}

bool exact_sees_light(struct exact_pair *pair, const struct exact_scene *scene, const struct query_ray *ray,
                      uint32_t own, const mpq_t distance) {
  /* All in units of 2^-EXACT_BITS / the distance's denominator, so that the point is whole. */
  const mpz_srcptr unit = mpq_denref(distance), steps = mpq_numref(distance);
  mpz_t point[3], way[3], origin[3];
  triple point_about, way_about;
  double off = 0;
  for (int axis = 0; axis < 3; axis++) {
    mpz_inits(point[axis], way[axis], origin[axis], NULL);
    exact_set_float(origin[axis], ray->origin[axis]);
    mpz_mul(origin[axis], origin[axis], unit);
    exact_set_float(point[axis], ray->direction[axis]);
    mpz_mul(point[axis], point[axis], steps);
    mpz_add(point[axis], point[axis], origin[axis]);
    exact_set_float(way[axis], scene->light[axis]);
    mpz_mul(way[axis], way[axis], unit);
    mpz_sub(way[axis], way[axis], point[axis]);
    mpz_sub(origin[axis], origin[axis], point[axis]);
    mpq_t value;
    mpq_init(value);
    for (int which = 0; which < 2; which++) {
      mpz_set(mpq_numref(value), which ? way[axis] : point[axis]);
      mpz_set(mpq_denref(value), unit);
      mpq_canonicalize(value);
      mpq_div_2exp(value, value, EXACT_BITS);
      (which ? way_about : point_about)[axis] = mpq_get_d(value);
    }
    mpq_clear(value);
    off = fmax(off, 0x1p-52 * fabs(point_about[axis]));
  }

  vector inward;
  vector_init(inward);
  for (int axis = 0; axis < 3 && own != NO_TRIANGLE; axis++) { /* to the centre, three times as far */
    for (int corner = 0; corner < 3; corner++) {
      exact_set_corner(pair, pair->sum, &scene->triangles[own], corner, axis);
      mpz_addmul(inward[axis], pair->sum, unit);
    }
    mpz_submul_ui(inward[axis], point[axis], 3);
  }

  bool sees = true;
  for (uint32_t i = 0; i < scene->count && sees; i++) {
    const struct exact_triangle *triangle = &scene->triangles[i];
    if (i != own && surely_outside(point_about, way_about, off, triangle))
      continue;
    for (int axis = 0; axis < 3; axis++) {
      for (int corner = 0; corner < 3; corner++) {
        exact_set_corner(pair, pair->vertex[corner][axis], triangle, corner, axis);
        mpz_mul(pair->vertex[corner][axis], pair->vertex[corner][axis], unit);
        mpz_sub(pair->vertex[corner][axis], pair->vertex[corner][axis], point[axis]);
      }
      mpz_set(pair->direction[axis], way[axis]);
    }
    enum side side = exact_evaluate(pair);
    if (i == own) { /* the light is on the other side, or in the plane */
      int light_side = mpz_sgn(pair->determinant);
      for (int axis = 0; axis < 3; axis++)
        mpz_set(pair->direction[axis], origin[axis]);
      exact_evaluate(pair);
      sees = light_side * mpz_sgn(pair->determinant) > 0;
    } else if (side == HIT) {
      sees = mpq_cmp_ui(pair->distance, 1, 1) >= 0;
    } else if (side == BEHIND_ORIGIN && mpq_sgn(pair->distance) == 0) {
      sees = own == NO_TRIANGLE || !hides_nearby(pair, inward);
    }
  }
  for (int axis = 0; axis < 3; axis++)
    mpz_clears(point[axis], way[axis], origin[axis], NULL);
  vector_clear(inward);
  return sees;
}

/* --- what rounding explains --- */

static double dot(const triple a, const triple b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double greatest(const triple a) {
  return fmax(fmax(fabs(a[0]), fabs(a[1])), fabs(a[2]));
}

/* The device's own bound on the error of a point on a triangle (raytracer/device/shade.h). */
static double offset_of(const struct exact_triangle *triangle, const triple eye, const triple way, bool exact) {
  double place = 0, edge = 0, away = 0;
  triple corner[3];
  for (int i = 0; i < 3; i++)
    exact_corner(corner[i], triangle, i);
  for (int axis = 0; axis < 3; axis++) {
    const double v0 = corner[0][axis];
    place = fmax(place, fabs(v0));
    away = fmax(away, triangle->place ? fabs(v0 - (double)triangle->place->matrix[axis][3]) : 0);
    for (int i = 1; i < 3; i++)
      edge = fmax(edge, fabs(corner[i][axis] - v0));
  }
  const double further = triangle->place ? triangle->place->spread * (away + edge) : 0;
  const double bound = place * 0x1p-22 + edge * 0x1p-17 + further;
  return exact ? fmin(bound, greatest(eye) * 0x1p-22 + greatest(way) * 0x1p-19) : bound;
}

/* The shadow ray must start at most three times the bound from the point, along the normal and back along the sight,
   without passing through a surface, and the answer must be right of where it starts. A light behind the surface is
   one that is lower above it than that. */
bool exact_light_explained(struct exact_pair *pair, const struct exact_scene *scene, const struct query_ray *ray,
                           const struct exact_answer *answer, const mpq_t distance) {
  const struct exact_triangle *own = &scene->triangles[answer->triangle];
  struct exact_scene there = *scene;
  struct query_ray shadow = {{0}, {0}};
  triple eye, way, step, light, edge[2], corner[3];
  for (int i = 0; i < 3; i++)
    exact_corner(corner[i], own, i);
  for (int axis = 0; axis < 3; axis++) {
    const float start = ldexpf(answer->origin[axis], -scene->exponent);
    if (ldexpf(start, scene->exponent) != answer->origin[axis])
      return false;
    there.light[axis] = shadow.origin[axis] = start;
    eye[axis] = (double)ray->origin[axis];
    way[axis] = (double)ray->direction[axis] * mpq_get_d(distance);
    step[axis] = (double)start - eye[axis] - way[axis];
    light[axis] = (double)scene->light[axis] - (double)start;
    for (int i = 0; i < 2; i++)
      edge[i][axis] = corner[i + 1][axis] - corner[0][axis];
  }
  if (sqrt(dot(step, step)) > 3 * offset_of(own, eye, way, answer->exact) ||
      !exact_sees_light(pair, &there, ray, (uint32_t)answer->triangle, distance))
    return false;
  if (answer->light != QUERY_BEHIND) {
    mpq_t nothing;
    mpq_init(nothing);
    const bool sees = exact_sees_light(pair, scene, &shadow, NO_TRIANGLE, nothing);
    mpq_clear(nothing);
    return sees == (answer->light == QUERY_LIT);
  }
  triple normal;
  for (int axis = 0; axis < 3; axis++) {
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    normal[axis] = edge[0][j] * edge[1][k] - edge[0][k] * edge[1][j];
  }
  const double rounding = 0x1p-20 * sqrt(dot(light, light) * dot(normal, normal));
  return (dot(normal, way) < 0 ? 1 : -1) * dot(normal, light) <= rounding;
}
