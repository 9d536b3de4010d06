#include "exact.h"

#include "pair.h"
#include "reach.h"

#include <math.h>

#define UNIT 0x1p-24 /* of binary32's rounding */

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

/* The ray where a triangle's vertices are. In an instance's mesh each component is a sum of three products, of an
   inverse that was rounded, and of a difference from the instance's origin: docs/instances.md has the bounds. */
struct ray_at {
  triple origin, direction;
  double origin_error, direction_error;
};

static void ray_of(struct ray_at *out, const struct exact_scene *scene, const struct query_ray *ray,
                   int direction_exponent, const struct exact_place *place) {
  triple origin, direction;
  for (int axis = 0; axis < 3; axis++) {
    origin[axis] = ldexp((double)ray->origin[axis] - (place ? (double)place->matrix[axis][3] : 0), scene->exponent);
    direction[axis] = ldexp((double)ray->direction[axis], direction_exponent);
  }
  *out = (struct ray_at){.origin_error = 0};
  for (int axis = 0; axis < 3; axis++) {
    double origin_size = 0, direction_size = 0;
    for (int i = 0; i < 3; i++) {
      const double factor = place ? place->inverse[axis][i] : axis == i;
      out->origin[axis] += factor * origin[i], origin_size += fabs(factor * origin[i]);
      out->direction[axis] += factor * direction[i], direction_size += fabs(factor * direction[i]);
    }
    out->origin_error = fmax(out->origin_error, place ? 5 * UNIT * origin_size : 0);
    out->direction_error = fmax(out->direction_error, place ? 4 * UNIT * direction_size : 0);
  }
}

static void bound(struct bounds *bounds, const struct exact_scene *scene, const struct query_ray *ray,
                  int direction_exponent, const struct exact_triangle *triangle, double hit) {
  triple vertex[3];
  double error[3], size = 0;
  int w = 0;
  struct ray_at at;
  ray_of(&at, scene, ray, direction_exponent, triangle->place);
  const double *direction = at.direction;
  for (int axis = 0; axis < 3; axis++)
    if (fabs(direction[axis]) > fabs(direction[w]))
      w = axis;
  int u = (w + 1) % 3, v = (w + 2) % 3;
  for (int i = 0; i < 3; i++) {
    double farthest = 0;
    for (int axis = 0; axis < 3; axis++) {
      vertex[i][axis] = ldexp((double)triangle->vertex[i][axis], scene->exponent) - at.origin[axis];
      farthest = fmax(farthest, fabs(vertex[i][axis]));
    }
    vertex[i][u] -= direction[u] / direction[w] * vertex[i][w];
    vertex[i][v] -= direction[v] / direction[w] * vertex[i][w];
    farthest = fmin(farthest, TRAX_REACH * hit * fabs(direction[w]));
    error[i] = 14 * UNIT * farthest + 0x1p-147 + 2 * at.origin_error +
               2 * fabs(vertex[i][w]) * at.direction_error / fabs(direction[w]);
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
  bounds->distance_error = (fmin(amplified, widest) + 16 * UNIT * size + 2 * at.origin_error +
                            2 * fabs(mean) * at.direction_error / fabs(direction[w])) /
                           fabs(direction[w]);
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

/* A test within the bounds may find a hit at this distance. */
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
  const enum side side = exact_evaluate_ray(pair, ray, triangle);
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
    const bool sees = exact_sees_light(pair, scene, ray, (uint32_t)answer->triangle, nearest);
    tally->lit += sees;
    tally->leaks += !sees && answer->light == QUERY_LIT;
    tally->acne += sees && answer->light != QUERY_LIT;
    if (sees != (answer->light == QUERY_LIT))
      tally->unexplained_lights += !exact_light_explained(pair, scene, ray, answer, nearest);
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
  exact_pair_init(&pair);
  mpq_init(nearest);
  for (int axis = 0; axis < 3; axis++)
    origin[axis] = (double)ray->origin[axis], direction[axis] = (double)ray->direction[axis];

  for (uint32_t i = 0; i < scene->count; i++) {
    const struct exact_triangle *triangle = &scene->triangles[i];
    if (surely_outside(origin, direction, 0, triangle) || exact_evaluate_ray(&pair, ray, triangle) != HIT)
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
  exact_pair_clear(&pair);
}
